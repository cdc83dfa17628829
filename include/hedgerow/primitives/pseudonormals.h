/// Normals of corners and edges by which the closest point alone tells the side of a closed surface.
#pragma once

#include <hedgerow/geometry/orientation.h>
#include <hedgerow/primitives/boundary.h>

namespace hedgerow {

namespace detail {
/// The unit normal of a primitive, in double; 0 if it has none. A counterclockwise loop in the plane has its
/// normals outward.
inline Vec3d facet_normal(const std::array<Vec3d, 3>& t) {
    const Vec3d e = t[1] - t[0], f = t[2] - t[0];
    const double scale = scale_to_one(std::max(max_component(abs(e)), max_component(abs(f))));
    return normalized(cross(e * scale, f * scale));
}
inline Vec2d facet_normal(const std::array<Vec2d, 2>& s) {
    const Vec2d e = s[1] - s[0];
    const Vec2d scaled = e * scale_to_one(max_component(abs(e)));
    return normalized(Vec2d(scaled[1], -scaled[0]));
}
template <class T, int D, std::size_t N>
std::array<Vec<double, D>, N> in_double(const std::array<Vec<T, D>, N>& corners) {
    std::array<Vec<double, D>, N> wide;
    for (std::size_t i = 0; i < N; ++i) wide[i] = Vec<double, D>(corners[i]);
    return wide;
}
/// The angle of a triangle at a corner.
inline double angle_at(const std::array<Vec3d, 3>& t, std::size_t corner) {
    const Vec3d e = t[(corner + 1) % 3] - t[corner], f = t[(corner + 2) % 3] - t[corner];
    const Vec3d p = normalized(e * scale_to_one(max_component(abs(e))));
    const Vec3d q = normalized(f * scale_to_one(max_component(abs(f))));
    return std::atan2(length(cross(p, q)), dot(p, q));
}
}  // namespace detail

/// The part of a primitive that is closest to a point: corner 0, 1 or 2; for triangles the side from corner
/// 0, 1 or 2 to the next (3, 4, 5); or the primitive's inside (−1). `foot` is the
/// closest point, if it is on a corner or a side.
template <int D>
struct ClosestFeature {
    int number;
    Vec<double, D> foot;
};

inline ClosestFeature<2> closest_feature(const Vec2d& p, const std::array<Vec2d, 2>& s) {
    const double scale = detail::safe_scale<double>(s[1] - s[0], p - s[0]);
    const Vec2d foot = detail::foot_on_segment(p, s[0], s[1], scale).point;
    return {foot == s[0] ? 0 : (foot == s[1] ? 1 : -1), foot};
}
inline ClosestFeature<3> closest_feature(const Vec3d& p, const std::array<Vec3d, 3>& t) {
    const double scale = detail::safe_scale<double>(t[1] - t[0], t[2] - t[0], p - t[0]);
    const Vec3d normal = cross((t[1] - t[0]) * scale, (t[2] - t[0]) * scale);
    const auto beside = [&](std::size_t i) {
        return dot(cross(normal, (t[(i + 1) % 3] - t[i]) * scale), (p - t[i]) * scale);
    };
    if (beside(0) > 0 && beside(1) > 0 && beside(2) > 0) return {-1, p};
    ClosestFeature<3> closest{-1, t[0]};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        const auto foot = detail::foot_on_segment(p, t[i], t[next], scale);
        if (!(foot.distance2 < least)) continue;
        least = foot.distance2;
        const std::size_t number = foot.point == t[i] ? i : (foot.point == t[next] ? next : 3 + i);
        closest = {static_cast<int>(number), foot.point};
    }
    return closest;
}

/// The pseudonormals of a set's corners and, in space, of its sides. That of a side is the sum of the unit
/// normals of its triangles; that of a corner is the sum of its triangles' unit normals by their angles there
/// (Bærentzen and Aanæs 2005). A point outside of a closed and oriented surface without self-intersections
/// has a positive product with the pseudonormal of whatever is closest. Equal positions are one corner.
template <std::floating_point T, int D>
class Pseudonormals {
public:
    Pseudonormals() = default;
    /// O(n), 108 bytes a triangle of floats (32 a segment), its corners included.
    template <FacetSet P>
    Pseudonormals(const P& set, Executor& executor) : of_element_(set.size()) {
        for (std::size_t i = 0; i < set.size(); ++i) of_element_[i].corners = set.corners(i);
        const auto spread = [&](const auto& parts, int first, auto weight) {
            Vec<double, D> sum;
            for (const auto& part : parts) {
                const auto corners = detail::in_double(set.corners(part.element));
                sum += detail::facet_normal(corners) * weight(corners, part.local);
            }
            for (const auto& part : parts)
                of_element_[part.element].normals[static_cast<std::size_t>(first) + part.local] =
                    Vec<T, D>(sum);
        };
        for_each_vertex(set, executor, [&](const auto& parts) {
            spread(parts, 0, [](const auto& corners, std::uint32_t k) {
                if constexpr (D == 3)
                    return detail::angle_at(corners, k);
                else
                    return static_cast<void>(corners), static_cast<void>(k), 1.0;
            });
        });
        if constexpr (D == 3)
            for_each_edge(set, executor, [&](const auto& parts) {
                spread(parts, 3, [](const auto&, std::uint32_t) { return 1.0; });
            });
    }

    /// The side of the surface on which a point is, whose closest primitive is given: 1 in front, −1 behind,
    /// 0 where that cannot be told.
    int side(PrimitiveId element, const Vec<T, D>& point) const {
        const auto corners = detail::in_double(of_element_[element].corners);
        const Vec<double, D> p(point);
        const auto [number, foot] = closest_feature(p, corners);
        if (number < 0) {  // the plane's or the line's side, exactly
            if constexpr (D == 3)
                return hedgerow::side(corners[0], corners[1], corners[2], p);
            else
                return -turn(corners[0], corners[1], p, 0, 1);
        }
        const Vec<double, D> normal(of_element_[element].normals[static_cast<std::size_t>(number)]);
        const Vec<double, D> away = p - foot;
        const double height = dot(away * scale_to_one(max_component(abs(away))), normal);
        return height > 0 ? 1 : (height < 0 ? -1 : 0);
    }
    /// Reads ahead what `side` needs.
    void prefetch(PrimitiveId element) const {
        const auto* const first = reinterpret_cast<const char*>(of_element_.data() + element);
        for (std::size_t i = 0; i < sizeof(OfElement); i += 64) __builtin_prefetch(first + i);
    }
    std::size_t bytes() const { return of_element_.capacity() * sizeof(of_element_[0]); }

private:
    /// One place in memory for all that a side needs.
    struct OfElement {
        std::array<Vec<T, D>, static_cast<std::size_t>(D)> corners;
        std::array<Vec<T, D>, D == 3 ? 6 : 2> normals;
    };

    std::vector<OfElement> of_element_;
};

}  // namespace hedgerow
