/// Normals of corners and edges by which the closest point alone tells the side of a closed surface.
#pragma once

#include <hedgerow/geometry/closest_feature.h>
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
        const auto [number, foot] = closest_feature<T>(p, corners);
        if (number < 0) {  // the plane's or the line's side, exactly
            if constexpr (D == 3)
                return hedgerow::side(corners[0], corners[1], corners[2], p);
            else
                return -turn(corners[0], corners[1], p, 0, 1);
        }
        const Vec<double, D> normal(of_element_[element].normals[static_cast<std::size_t>(number)]);
        const Vec<double, D> away = p - foot;
        const double height = dot(away * detail::safe_scale<T>(away), normal);
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
