/// What winding numbers are summed from: triangles, or dipoles.
#pragma once

#include <algorithm>

#include <hedgerow/base/strided.h>
#include <hedgerow/primitives/concepts.h>
#include <hedgerow/queries/half_angles.h>
#include <hedgerow/queries/winding_moments.h>

namespace hedgerow {

/// The area of a primitive, and its middle.
struct WindingMass {
    double area;
    Vec3d middle;
};

/// Triangles as parts of a winding number. Positions are multiplied by `scale`, a power of two.
template <class Set>
class WindingTriangles {
public:
    WindingTriangles(const Set& set, double scale) : set_(&set), scale_(scale) {}

    WindingMass mass(PrimitiveId id) const {
        const auto t = corners(id);
        return {length(normal(t)), (t[0] + t[1] + t[2]) / 3.0};
    }
    /// The distance of the farthest place from a center.
    double reach(PrimitiveId id, const Vec3d& center) const {
        const auto t = corners(id);
        return std::sqrt(std::max({length2(t[0] - center), length2(t[1] - center), length2(t[2] - center)}));
    }
    /// ∫(|y|/reach)⁸
    double eighth(PrimitiveId id, const Vec3d& center, double reach) const {
        const auto t = corners(id);
        return product(length(normal(t)), WindingMoments::mean_of_eighth_power(offsets(t, center, reach)));
    }
    void add_moments(PrimitiveId id, const Vec3d& center, double reach, WindingMoments& moments) const {
        const auto t = corners(id);
        moments.add_triangle(offsets(t, center, reach), normal(t));
    }

    /// The exact terms of triangles about a point.
    class Sum {
    public:
        Sum(const WindingTriangles& all, const Vec3d& point, double scale)
            : set_(all.set_), point_(point), scale_(scale) {}

        /// Adds the term of the triangle at a place of its leaf. Returns a bound of its roundings.
        double add(int place, PrimitiveId id) {
            const auto t = set_->corners(id);
            angles_.add(place, {Vec3d(t[0]), Vec3d(t[1]), Vec3d(t[2])}, point_, scale_);
            return HalfAngles::rounding;
        }
        double turns() const { return angles_.turns(); }

    private:
        const Set* set_;
        Vec3d point_;
        double scale_;
        HalfAngles angles_;
    };

private:
    using Corners = std::array<Vec3d, 3>;

    Corners corners(PrimitiveId id) const {
        const auto t = set_->corners(id);
        return {Vec3d(t[0]) * scale_, Vec3d(t[1]) * scale_, Vec3d(t[2]) * scale_};
    }
    static Vec3d normal(const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]) * 0.5; }
    static Corners offsets(const Corners& t, const Vec3d& center, double reach) {
        return {(t[0] - center) / reach, (t[1] - center) / reach, (t[2] - center) / reach};
    }

    const Set* set_;
    double scale_;
};

/// Dipoles as parts of a winding number: points whose normals have areas as their lengths.
template <class Set>
class WindingDipoles {
public:
    using Scalar = typename Set::Scalar;

    WindingDipoles(const Set& set, const Strided<Vec<Scalar, 3>>& normals, double scale)
        : set_(&set), normals_(normals), scale_(scale) {}

    WindingMass mass(PrimitiveId id) const { return {length(normal(id)), position(id)}; }
    double reach(PrimitiveId id, const Vec3d& center) const { return length(position(id) - center); }
    double eighth(PrimitiveId id, const Vec3d& center, double reach) const {
        const double r2 = length2((position(id) - center) / reach), r4 = product(r2, r2);
        return product(length(normal(id)), product(r4, r4));
    }
    void add_moments(PrimitiveId id, const Vec3d& center, double reach, WindingMoments& moments) const {
        moments.add_dipole((position(id) - center) / reach, normal(id));
    }

    /// The sum of n·(p − x)/(4π|p − x|³). A dipole at x adds nothing.
    class Sum {
    public:
        Sum(const WindingDipoles& all, const Vec3d& point, double scale)
            : all_(&all), point_(point), scale_(scale) {}

        double add(int, PrimitiveId id) {
            const Vec3d d = (Vec3d(all_->set_->point(id)) - point_) * scale_;
            const Vec3d n = Vec3d(all_->normals_[id]) * scale_ * scale_;
            const double r2 = length2(d), r = std::sqrt(r2);
            const double per_cube = 1 / product(product(r2, r), 4 * std::numbers::pi);
            if (!(per_cube <= std::numeric_limits<double>::max())) return 0;
            sum_ += product(dot(n, d), per_cube);
            return product(product(length(n), r), product(per_cube, 0x1p-48));
        }
        double turns() const { return sum_; }

    private:
        const WindingDipoles* all_;
        Vec3d point_;
        double scale_, sum_ = 0;
    };

private:
    Vec3d position(PrimitiveId id) const { return Vec3d(set_->point(id)) * scale_; }
    Vec3d normal(PrimitiveId id) const { return Vec3d(normals_[id]) * scale_ * scale_; }

    const Set* set_;
    Strided<Vec<Scalar, 3>> normals_;
    double scale_;
};

}  // namespace hedgerow
