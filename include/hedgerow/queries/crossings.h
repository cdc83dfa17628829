/// The pairs of triangles that meet: of two sets, or within one beyond what neighbours share.
#pragma once

#include <bit>
#include <compare>
#include <memory>
#include <utility>

#include <hedgerow/geometry/lanes.h>
#include <hedgerow/geometry/meet_beyond_shared.h>
#include <hedgerow/walks/pairs.h>

namespace hedgerow {

/// A pair of primitives, by their positions in their sets.
struct ElementPair {
    PrimitiveId a, b;
    friend auto operator<=>(const ElementPair&, const ElementPair&) = default;
};

/// A set of triangles in space.
template <class P>
concept TriangleSet = PrimitiveSet<P> && requires(const P& set, std::size_t i) {
    { set.triangle(i) } -> std::convertible_to<Triangle<typename P::Scalar, 3>>;
};

namespace detail {

/// A triangle of a leaf, its corners' coordinates by axis, and its box. Each row is four numbers, so that all
/// corners and all planes of a box are compared at once.
template <std::floating_point T>
struct RowsOfTriangle {
    Triangle<T, 3> triangle;
    T row[3][4];
    T low[4], high[4];
    PrimitiveId id;

    RowsOfTriangle(const Triangle<T, 3>& t, PrimitiveId i) : triangle(t), id(i) {
        using L = Lanes<T>;
        const L a = L::of(t.a), b = L::of(t.b), c = L::of(t.c);
        min(min(a, b), c).store(low);
        max(max(a, b), c).store(high);
        // Whole rows are stored, since they are read as such soon after.
        for (int k = 0; k < 3; ++k) L::of(Vec<T, 3>(t.a[k], t.b[k], t.c[k])).store(row[k]);
    }
    Triangle<double, 3> in_double() const {
        return {Vec3d(triangle.a), Vec3d(triangle.b), Vec3d(triangle.c)};
    }
    SideFilter<T> plane() const { return {triangle.a, triangle.b, triangle.c}; }
};

/// Whether two boxes overlap, given by their low and high corners in lanes.
template <std::floating_point T>
bool overlap(Lanes<T> low_a, Lanes<T> high_a, Lanes<T> low_b, Lanes<T> high_b) {
    return (less_equal(low_a, high_b) & less_equal(low_b, high_a) & 7u) == 7u;
}

/// Up to 16 triangles of a leaf that overlap a region.
template <std::floating_point T>
class SomeTriangles {
public:
    using L = Lanes<T>;
    static constexpr int most = 16;

    /// Reads triangles from number `i` of the leaf on, until there are `most`. Returns the number after the
    /// last that was read. A packed leaf has no more than that.
    template <class P>
    std::uint32_t read(const P& set, const Leaf& leaf, std::uint32_t i, const Box<T, 3>& region) {
        count_ = 0;
        if constexpr (requires { set.for_each_overlapping(leaf, region, [](const auto&, PrimitiveId) {}); }) {
            set.for_each_overlapping(leaf, region, [&](const Triangle<T, 3>& t, PrimitiveId id) {
                std::construct_at(&slots_.triangle[count_++], t, id);
            });
            return leaf.count;
        } else {
            const L low = L::of(region.low), high = L::of(region.high);
            for (; i < leaf.count && count_ < most; ++i) {
                const PrimitiveId id = leaf.ids[leaf.first + i];
                const auto& t = *std::construct_at(&slots_.triangle[count_], set.triangle(id), id);
                count_ += overlap(L::load(t.low), L::load(t.high), low, high);
            }
            return i;
        }
    }
    /// Calls f(s, plane, t) for the pairs of a triangle s here, with its plane, and t there whose boxes
    /// overlap. Of a list and itself each unordered pair once.
    template <class F>
    Flow for_each_overlap(const SomeTriangles& others, F f) const {
        for (int i = 0; i < count_; ++i) {
            const auto& s = slots_.triangle[i];
            const L low = L::load(s.low), high = L::load(s.high);
            // Compare all boxes first, since few branches on single boxes are foreseen.
            unsigned left = 0;
            for (int j = this == &others ? i + 1 : 0; j < others.count_; ++j) {
                const auto& t = others.slots_.triangle[j];
                left |= static_cast<unsigned>(overlap(low, high, L::load(t.low), L::load(t.high))) << j;
            }
            if (left == 0) continue;
            const auto plane = s.plane();
            for (; left != 0; left &= left - 1)
                if (f(s, plane, others.slots_.triangle[std::countr_zero(left)]) == Flow::stop)
                    return Flow::stop;
        }
        return Flow::go_on;
    }

private:
    union Slots {
        Slots() {}  // NOLINT(modernize-use-equals-default): not cleared
        RowsOfTriangle<T> triangle[most];
    } slots_;
    int count_ = 0;
};

/// Calls f(s, plane, t) for the pairs of triangles of two leaves whose boxes overlap. Only triangles that
/// reach into the leaves' common region are compared.
template <class A, class B, class T, class F>
Flow for_each_close_pair(const A& set_a, const BoxedLeaf<T, 3>& a, const B& set_b, const BoxedLeaf<T, 3>& b,
                         F f) {
    const Box<T, 3> common = intersection(a.box, b.box);
    SomeTriangles<T> some_a, some_b;
    for (std::uint32_t i = 0; i < a.items.count;) {
        i = some_a.read(set_a, a.items, i, common);
        for (std::uint32_t j = 0; j < b.items.count;) {
            j = some_b.read(set_b, b.items, j, common);
            if (some_a.for_each_overlap(some_b, f) == Flow::stop) return Flow::stop;
        }
    }
    return Flow::go_on;
}
/// Calls f(s, plane, t) for the pairs of triangles inside of a leaf whose boxes overlap.
template <class P, class T, class F>
Flow for_each_close_pair(const P& set, const BoxedLeaf<T, 3>& leaf, F f) {
    SomeTriangles<T> some, others;
    for (std::uint32_t i = 0; i < leaf.items.count;) {
        i = some.read(set, leaf.items, i, leaf.box);
        if (some.for_each_overlap(some, f) == Flow::stop) return Flow::stop;
        for (std::uint32_t j = i; j < leaf.items.count;) {
            j = others.read(set, leaf.items, j, leaf.box);
            if (some.for_each_overlap(others, f) == Flow::stop) return Flow::stop;
        }
    }
    return Flow::go_on;
}

/// Whether the corners of t are surely on one side of a plane.
template <class T>
bool plainly_apart(const SideFilter<T>& plane, const T (&t)[3][4]) {
    unsigned in_front, behind;
    plane.sure_sides(t, in_front, behind);
    return in_front == 7u || behind == 7u;
}

/// What queries of overlapping boxes have in common.
template <class P>
struct OverlapQuery {
    using Scalar = typename P::Scalar;
    using BoxType = Box<Scalar, P::dimension>;
    static constexpr Order order = Order::none;

    static Scalar bound(const BoxType& a, const BoxType& b) {
        return overlap(a, b) ? Scalar(0) : std::numeric_limits<Scalar>::infinity();
    }
    static Scalar limit() { return 0; }
};

}  // namespace detail

/// The triangles of an index, as queries of pairs read them fastest: a packed copy whose leaves are compared
/// with a region at once, or the set. Both queries below take either.
template <class I>
const auto& triangles_of(const I& index) {
    using T = typename I::Scalar;
    if constexpr (requires(const Leaf& leaf, const Box<T, 3>& box) {
                      index.packed().for_each_overlapping(leaf, box, [](const auto&, PrimitiveId) {});
                  })
        return index.packed();
    else
        return index.primitives();
}

/// Triangles of one set that share a point with triangles of another. Calls `found(i, j)`, which returns
/// whether to go on; structures that hold a triangle in several leaves may call it several times for a pair.
template <class A, class B, class Found>
class Crossings : public detail::OverlapQuery<A> {
public:
    using Boxed = BoxedLeaf<typename A::Scalar, 3>;

    Crossings(const A& a, const B& b, Found found) : a_(a), b_(b), found_(std::move(found)) {}
    Flow offer(const Boxed& a, const Boxed& b) {
        return detail::for_each_close_pair(
            a_, a, b_, b, [&](const auto& s, const auto& plane, const auto& t) {
                if (detail::plainly_apart(plane, t.row) || detail::plainly_apart(t.plane(), s.row) ||
                    !triangles_meet(s.in_double(), t.in_double()))
                    return Flow::go_on;
                return found_(s.id, t.id);
            });
    }

private:
    const A& a_;
    const B& b_;
    Found found_;
};

/// Pairs of triangles of one set that meet beyond the corners that they share. Calls `found(i, j)` with i < j
/// as Crossings does.
template <class P, class Found>
class SelfCrossings : public detail::OverlapQuery<P> {
public:
    using Boxed = BoxedLeaf<typename P::Scalar, 3>;

    SelfCrossings(const P& set, Found found) : set_(set), found_(std::move(found)) {}
    Flow offer(const Boxed& a, const Boxed& b) {
        return detail::for_each_close_pair(set_, a, set_, b, tested());
    }
    Flow offer(const Boxed& leaf) { return detail::for_each_close_pair(set_, leaf, tested()); }

private:
    auto tested() {
        return [this](const auto& s, const auto& plane, const auto& t) {
            if (plainly_beside(s.triangle, plane, t.row) || s.id == t.id ||
                plainly_beside(t.triangle, t.plane(), s.row) ||
                !meet_beyond_shared(s.in_double(), t.in_double()))
                return Flow::go_on;
            return found_(std::min(s.id, t.id), std::max(s.id, t.id));
        };
    }

    const P& set_;
    Found found_;
};

}  // namespace hedgerow
