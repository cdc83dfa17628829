/// Frusta: what a camera sees.
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/half_space.h>
#include <hedgerow/geometry/region.h>

namespace hedgerow {

/// What six planes enclose (in the plane, four lines): for each pair of faces that are opposite each other,
/// the two half-spaces, whose normals point outward. Faces may have any normals and offsets.
template <std::floating_point T, int D>
class Frustum {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using Faces = std::array<HalfSpace<T, D>, std::size_t(2 * D)>;

    /// All of space.
    Frustum() = default;
    /// O(1). Opposite faces are faces 2i and 2i + 1.
    explicit Frustum(const Faces& faces) : faces_(faces), bounded_(true) {
        for (unsigned c = 0; c < corners_.size(); ++c) bounded_ = find_corner(c) && bounded_;
    }
    /// The view from `eye` along `forward`, between the distances `near` and `far` along it. `slope_x` and
    /// `slope_y` are the tangents of half the angles of view, to the sides and up and down. `up` may be any
    /// vector that is not along `forward`. Normals are computed in double and rounded to T. Throws InputError
    /// for numbers that are not finite, slopes that are not > 0, distances with far < near, and an `up` along
    /// `forward`.
    static Frustum perspective(const Vec<T, 3>& eye, const Vec<T, 3>& forward, const Vec<T, 3>& up,
                               double slope_x, double slope_y, double near, double far) requires(D == 3) {
        const Vec3d z = normalized(Vec3d(forward)), x = normalized(cross(z, normalized(Vec3d(up))));
        const Vec3d y = cross(x, z), from(eye);
        if (!finite(from) || !finite(x) || !(length2(x) > 0) || !(slope_x > 0 && slope_y > 0) ||
            !(near <= far) || !finite(Vec3d(slope_x + slope_y, near, far)))
            throw InputError(
                "a frustum needs finite vectors, an up that is not along forward, slopes of more than 0 and "
                "near <= far: give it a forward that is not 0 and angles of less than a right angle");
        const auto face = [&](const Vec3d& normal, double beyond) {
            const Vec<T, 3> n(normal);  // rounded first, so that the plane goes through the eye all the same
            return HalfSpace<T, 3>{n, rounded_to<T>(dot(Vec3d(n), from) + beyond)};
        };
        return Frustum({face(normalized(-x - z * slope_x), 0), face(normalized(x - z * slope_x), 0),
                        face(normalized(-y - z * slope_y), 0), face(normalized(y - z * slope_y), 0),
                        face(-z, -near), face(z, far)});
    }

    const Faces& faces() const { return faces_; }

    static constexpr int orthonormal = 0;
    static constexpr int slab_count() { return 2 * D; }
    Slab<D> slab(int i) const { return faces_[static_cast<std::size_t>(i)].slab(0); }

    /// The heights of the corners along a normal, with a margin for their errors. All heights if the faces
    /// enclose nothing, or nearly.
    Extent extent(const Vec<double, D>& normal) const {
        if (!bounded_) return {};
        Extent e{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        double size = 0;
        for (const auto& c : corners_) {
            const double h = dot(normal, c);
            e.low = std::min(e.low, h), e.high = std::max(e.high, h);
            size = std::max(size, dot(abs(normal), abs(c)));
        }
        const double error = product(0x1p-20, size) + 0x1p-500;
        return {e.low - error, e.high + error};
    }

private:
    /// Finds corner c by Cramer's rule, the common point of one face of each pair. False if it is not clearly
    /// one point, or not within the other faces.
    bool find_corner(unsigned c) {
        std::array<Slab<D>, std::size_t(D)> s;
        for (unsigned k = 0; k < D; ++k) s[k] = slab(static_cast<int>(2 * k + (c >> k & 1u)));
        Vec<double, D>& x = corners_[c];
        double det, sizes = 1;
        for (const auto& face : s) sizes *= length(face.normal);
        if constexpr (D == 2) {
            const auto &a = s[0].normal, &b = s[1].normal;
            det = product(a[0], b[1]) - product(a[1], b[0]);
            x = {(product(s[0].high, b[1]) - product(s[1].high, a[1])) / det,
                 (product(a[0], s[1].high) - product(b[0], s[0].high)) / det};
        } else {
            const Vec3d bc = cross(s[1].normal, s[2].normal);
            det = dot(s[0].normal, bc);
            x = (bc * s[0].high + cross(s[2].normal, s[0].normal) * s[1].high +
                 cross(s[0].normal, s[1].normal) * s[2].high) /
                det;
        }
        if (!(std::abs(det) > 0x1p-20 * sizes) || !finite(x)) return false;
        for (int i = 0; i < slab_count(); ++i) {
            const auto face = slab(i);
            const double size = dot(abs(face.normal), abs(x)) + std::abs(face.high);
            if (!(dot(face.normal, x) - face.high <= 0x1p-24 * size)) return false;
        }
        return true;
    }

    Faces faces_{};
    std::array<Vec<double, D>, std::size_t(1) << D> corners_{};
    bool bounded_ = false;
};

}  // namespace hedgerow
