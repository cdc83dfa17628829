/// Triangles of A that B has too: their distance is 0, whatever is near.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include <hedgerow/ask/hausdorff/corners.h>
#include <hedgerow/base/bare_vector.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow::detail {

/// Keys of triangles that are equal if their corners are, in whatever order.
template <class S>
class TriangleKeys {
public:
    TriangleKeys(const S& set, Executor& executor) : corners_{set} {
        if constexpr (Corners<S>::shared) {
            of_corner_ = BareVector<std::uint64_t>(corners_.size());
            executor.for_each_piece(corners_.size(), 4096, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) of_corner_[i] = key_of(corners_[i]);
            });
        }
    }
    std::uint64_t operator[](std::size_t i) const {
        return mixed(corner(i, 0) + corner(i, 1) + corner(i, 2));
    }

private:
    using T = typename S::Scalar;
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

    static std::uint64_t mixed(std::uint64_t x) {
        x *= 0x9E3779B97F4A7C15u;
        return x ^ x >> 32;
    }
    static std::uint64_t key_of(const Vec<T, 3>& p) {
        std::uint64_t key = 0;
        for (int k = 0; k < 3; ++k) key = mixed(key + std::bit_cast<Bits>(p[k] + T(0)));  // −0 is 0
        return key;
    }
    std::uint64_t corner(std::size_t i, std::size_t k) const {
        if constexpr (Corners<S>::shared) return of_corner_[corners_.number(i, k)];
        return key_of(corners_[corners_.number(i, k)]);
    }

    Corners<S> corners_;
    BareVector<std::uint64_t> of_corner_;
};

/// A table of numbers by their keys.
class KeyTable {
public:
    /// A table of `room` places or more for each of up to `most` numbers: the more, the fewer that are
    /// looked at in vain.
    KeyTable(std::size_t most, std::size_t room) : places_(std::bit_ceil(room * most), empty) {}
    void insert(std::uint64_t key, PrimitiveId id) {
        std::size_t at = key & mask();
        while (places_[at] != empty) at = (at + 1) & mask();
        places_[at] = id;
    }
    /// Calls f(id) for what may have a key, until f returns true. Returns whether it did.
    template <class F>
    bool any(std::uint64_t key, F f) const {
        for (std::size_t at = key & mask(); places_[at] != empty; at = (at + 1) & mask())
            if (f(places_[at])) return true;
        return false;
    }

private:
    static constexpr PrimitiveId empty = no_primitive;
    std::size_t mask() const { return places_.size() - 1; }

    std::vector<PrimitiveId> places_;
};

template <class T>
bool same_corners(const Triangle<T, 3>& s, const Triangle<T, 3>& t) {
    const auto others = [](const Vec<T, 3>& p, const Vec<T, 3>& q, const Vec<T, 3>& x, const Vec<T, 3>& y) {
        return (p == x && q == y) || (p == y && q == x);
    };
    return (s.a == t.a && others(s.b, s.c, t.b, t.c)) || (s.a == t.b && others(s.b, s.c, t.a, t.c)) ||
           (s.a == t.c && others(s.b, s.c, t.a, t.b));
}

/// Drops the elements of A that are triangles of B too: those of B for which `holds_b`. Calls found(a, b) for
/// the first. A sample of A is looked up first: O(1) for each triangle of B. Nothing is done where that costs
/// more than asking for A's corners would.
template <class A, class B, class Holds, class Found>
void drop_shared_triangles(const A& a, std::vector<PrimitiveId>& elements, const B& b, Holds holds_b,
                           Executor& executor, Found found) {
    if (b.size() / 16 > elements.size()) return;
    const TriangleKeys<A> keys_a(a, executor);
    const TriangleKeys<B> keys_b(b, executor);
    const auto equal = [&](PrimitiveId i, PrimitiveId j) {
        return keys_a[i] == keys_b[j] && same_corners(a.triangle(i), b.triangle(j));
    };
    constexpr std::size_t one_in = 16;
    KeyTable sample(elements.size() / one_in + 1, 8);
    for (std::size_t i = 0; i < elements.size(); i += one_in) sample.insert(keys_a[elements[i]], elements[i]);
    bool any = false;
    for (std::size_t j = 0; j < b.size() && !any; ++j) {
        const auto id = static_cast<PrimitiveId>(j);
        any = sample.any(keys_b[j], [&](PrimitiveId i) { return equal(i, id) && holds_b(id); });
    }
    if (!any) return;

    KeyTable all(b.size(), 2);
    for (std::size_t j = 0; j < b.size(); ++j)
        if (const auto id = static_cast<PrimitiveId>(j); holds_b(id)) all.insert(keys_b[j], id);
    bool first = true;
    std::erase_if(elements, [&](PrimitiveId i) {
        return all.any(keys_a[i], [&](PrimitiveId j) {
            if (!equal(i, j)) return false;
            if (std::exchange(first, false)) found(i, j);
            return true;
        });
    });
}

}  // namespace hedgerow::detail
