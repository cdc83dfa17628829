/// The boundary of a set of triangles in space, or of segments in the plane: whether the set is closed and
/// oriented, and what edges (in the plane: ends) are left open.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <vector>

#include <hedgerow/parallel/radix_sort.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A set of triangles in space, or of segments in the plane: D corners in D dimensions.
template <class P>
concept FacetSet = PrimitiveSet<P> && requires(const P& set, std::size_t i) {
    {
        set.corners(i)
        } -> std::same_as<
            std::array<Vec<typename P::Scalar, P::dimension>, static_cast<std::size_t>(P::dimension)>>;
};

/// An edge of triangles, from its first end to its second; in the plane the end of a segment. `times` is how
/// often triangles run along it more than they run against it, and more than 0. An end of segments at which
/// more of them begin than end has times < 0.
template <std::floating_point T, int D>
struct OpenFacet {
    std::array<Vec<T, D>, static_cast<std::size_t>(D - 1)> corners;
    std::int64_t times;
};

/// The boundary of a set, by positions: vertices with equal coordinates are one (−0 equals 0), however they
/// are indexed. Sides without length are left out.
template <std::floating_point T, int D>
struct Boundary {
    /// The edges along which as many triangles run one way as the other cancel; these are all others.
    std::vector<OpenFacet<T, D>> open;
    /// The number of edges that belong to an odd number of triangles.
    std::size_t unpaired = 0;
    /// The number of edges along which triangles run one way at least twice more often than the other.
    std::size_t turned = 0;

    /// Whether each edge belongs to an even number of triangles.
    bool closed() const { return unpaired == 0; }
    /// Whether neighbours run along their common edge in opposite directions.
    bool oriented() const { return turned == 0; }
};

namespace detail {

template <class T, int D>
bool comes_before(const Vec<T, D>& a, const Vec<T, D>& b) {
    return std::lexicographical_compare(std::begin(a.data), std::end(a.data), std::begin(b.data),
                                        std::end(b.data));
}
template <class T, int D, std::size_t N>
std::uint64_t hash_of(const std::array<Vec<T, D>, N>& points) {
    std::uint64_t h = 0;
    for (const auto& p : points)
        for (int k = 0; k < D; ++k) {
            h = (h ^ std::bit_cast<BitsOf<T>>(p[k] + T(0))) * 0x9E3779B97F4A7C15u;  // −0 as 0
            h ^= h >> 29;
        }
    return h;
}

/// A part of a primitive: its corner or side with number `local`. `direction` is −1 for a side whose points
/// were exchanged, so that they are in ascending order.
template <class T, int D, std::size_t N>
struct Part {
    std::array<Vec<T, D>, N> points;
    int direction;
    PrimitiveId element = 0;
    std::uint32_t local = 0;
};

/// Calls f(span of Part) for each place at which parts of primitives lie: once for all parts whose points are
/// equal. `part_of(element, local)` gives a Part, for `locals` parts of each element. Parts are sorted by a
/// hash of their points, and where hashes are equal by the points themselves: O(n), but for points that were
/// made to collide. 32 bytes a part while it runs.
template <class PartOf, class F>
void for_each_place(std::size_t elements, std::uint32_t locals, Executor& executor, PartOf part_of, F f) {
    using Found = decltype(part_of(0, 0));
    struct Hashed {
        std::uint64_t hash;
        PrimitiveId element;
        std::uint32_t local;
    };
    BareVector<Hashed> all(locals * elements);
    executor.for_each_piece(elements, worth_a_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            for (std::uint32_t k = 0; k < locals; ++k) {
                const auto id = static_cast<PrimitiveId>(i);
                all[locals * i + k] = {hash_of(part_of(id, k).points) >> 20, id, k};
            }
    });
    radix_sort(
        all, [](const Hashed& h) { return h.hash; }, 0, 44, executor);
    std::vector<Found> alike;
    for (std::size_t i = 0; i < all.size();) {
        alike.clear();
        const std::uint64_t hash = all[i].hash;
        for (; i < all.size() && all[i].hash == hash; ++i) {
            alike.push_back(part_of(all[i].element, all[i].local));
            alike.back().element = all[i].element, alike.back().local = all[i].local;
        }
        std::stable_sort(alike.begin(), alike.end(), [](const Found& a, const Found& b) {
            return std::lexicographical_compare(
                a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                [](const auto& v, const auto& w) { return comes_before(v, w); });
        });
        for (std::size_t j = 0; j < alike.size();) {
            std::size_t k = j + 1;
            while (k < alike.size() && alike[k].points == alike[j].points) ++k;
            f(std::span<const Found>(alike).subspan(j, k - j));
            j = k;
        }
    }
}

}  // namespace detail

/// Calls f(parts) for each corner of a set, with all corners of primitives that have its position.
template <FacetSet P, class F>
void for_each_vertex(const P& set, Executor& executor, F f) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    const auto corner = [&](PrimitiveId element, std::uint32_t local) {
        return detail::Part<T, D, 1>{{set.corners(element)[local]}, 1};
    };
    detail::for_each_place(set.size(), D, executor, corner, f);
}
/// Calls f(parts) for each edge of a set of triangles, with all sides of triangles that have its ends.
template <FacetSet P, class F>
void for_each_edge(const P& set, Executor& executor, F f) requires(P::dimension == 3) {
    using T = typename P::Scalar;
    const auto side = [&](PrimitiveId element, std::uint32_t local) {
        const auto corners = set.corners(element);
        const auto &a = corners[local], &b = corners[(local + 1) % 3];
        return detail::comes_before(b, a) ? detail::Part<T, 3, 2>{{b, a}, -1}
                                          : detail::Part<T, 3, 2>{{a, b}, 1};
    };
    detail::for_each_place(set.size(), 3, executor, side, f);
}

/// The boundary of a set. O(n) time, and 32 bytes for each side of a primitive while it runs.
template <FacetSet P>
auto boundary_of(const P& set, Executor& executor) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    struct Found {
        OpenFacet<T, D> facet;
        PrimitiveId element;
        std::uint32_t local;
    };
    Boundary<T, D> boundary;
    std::vector<Found> open;
    const auto add = [&](const auto& parts, std::int64_t along) {
        boundary.unpaired += parts.size() % 2;
        boundary.turned += along < -1 || along > 1;
        if (along != 0) open.push_back({{parts[0].points, along}, parts[0].element, parts[0].local});
    };
    if constexpr (D == 2) {
        for_each_vertex(set, executor, [&](const auto& ends) {
            std::int64_t along = 0;
            for (const auto& end : ends) along += end.local == 1 ? 1 : -1;
            add(ends, along);
        });
    } else {
        for_each_edge(set, executor, [&](const auto& sides) {
            if (sides[0].points[0] == sides[0].points[1]) return;
            std::int64_t along = 0;
            for (const auto& side : sides) along += side.direction;
            add(sides, along);
        });
        for (Found& f : open)
            if (f.facet.times < 0) f.facet = {{f.facet.corners[1], f.facet.corners[0]}, -f.facet.times};
    }
    // In the order of the primitives, whatever the hash.
    std::sort(open.begin(), open.end(), [](const Found& a, const Found& b) {
        return a.element != b.element ? a.element < b.element : a.local < b.local;
    });
    boundary.open.reserve(open.size());
    for (const Found& f : open) boundary.open.push_back(f.facet);
    return boundary;
}

}  // namespace hedgerow
