/// Cones in place of many rays (Amanatides, Ray tracing with cones, SIGGRAPH 1984): what a whole pixel sees,
/// so that edges are smooth, and how much of a light that is a disc a point sees, so that shadows have soft
/// edges.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <hedgerow/ask/families.h>
#include <hedgerow/render/visibility/samples.h>

namespace hedgerow {

/// A triangle that a cone sees, the share of the cone that it takes, and a ray of the cone that hits it in
/// the middle of that share, where it is to be shaded.
template <std::floating_point T>
struct SeenFragment {
    Ray<T, 3> ray;  ///< its direction has length 1
    Hit<T> hit;
    float share;
};

/// What cones see, behind one type. Const use is thread-safe.
template <std::floating_point T>
class Cones {
public:
    virtual ~Cones() = default;
    /// Writes what a cone sees to `found`, which is cleared, from front to back. Shares sum up to 1 at most;
    /// the rest is empty. Memory of the last call is used again.
    virtual void look(const ConeRays<T, 3>& cone, std::vector<SeenFragment<T>>& found) const = 0;
    /// The share of a cone that nothing covers.
    virtual float open(const ConeRays<T, 3>& cone) const = 0;
};

/// The Cones of an index of triangles. Borrows the index.
template <class I>
class IndexCones final : public Cones<typename I::Scalar> {
public:
    using T = typename I::Scalar;

    explicit IndexCones(const I& index) : index_(index) {}
    void look(const ConeRays<T, 3>& cone, std::vector<SeenFragment<T>>& found) const override {
        const Scratch<std::vector<ConeFragment<T>>> fragments;
        cone_fragments(index_, cone, *fragments);
        found.clear();
        const ConeFrame frame(cone);
        for (const ConeFragment<T>& f : *fragments) found.push_back(seen(cone, frame, f));
    }
    float open(const ConeRays<T, 3>& cone) const override {
        std::uint64_t covered = 0;
        const Scratch<std::vector<ConeFragment<T>>> fragments;
        cone_fragments(index_, cone, *fragments);
        for (const ConeFragment<T>& f : *fragments) covered |= f.samples;
        return static_cast<float>(std::popcount(~covered)) / ConeSamples::count;
    }

private:
    /// The ray is that of the mean of the fragment's samples, which is in the triangle as they are.
    SeenFragment<T> seen(const ConeRays<T, 3>& cone, const ConeFrame& frame,
                         const ConeFragment<T>& fragment) const {
        const auto& samples = ConeSamples::all();
        double x = 0, y = 0;
        for (std::uint64_t left = fragment.samples; left != 0; left &= left - 1)
            x += samples.x[std::size_t(std::countr_zero(left))],
                y += samples.y[std::size_t(std::countr_zero(left))];
        const int count = std::popcount(fragment.samples);
        x /= count, y /= count;
        const auto triangle = index_.primitives().triangle(fragment.element);
        const Vec3d o = cone.origin();
        const auto f = frame.triangle(Vec3d(triangle.a) - o, Vec3d(triangle.b) - o, Vec3d(triangle.c) - o);
        const double sum = f.u.at(x, y) + f.v.at(x, y) + f.w.at(x, y);
        const Ray3d ray = frame.ray(o, x, y);
        SeenFragment<T> seen;
        seen.ray.origin = Vec<T, 3>(ray.origin);
        seen.ray.direction = Vec<T, 3>(normalized(ray.direction));
        seen.hit.t = static_cast<T>(f.height.at(x, y) / sum * length(ray.direction));
        seen.hit.u = static_cast<T>(f.v.at(x, y) / sum), seen.hit.v = static_cast<T>(f.w.at(x, y) / sum);
        seen.hit.primitive = index_.primitives().id(fragment.element);
        seen.hit.element = fragment.element;
        seen.share = static_cast<float>(count) / ConeSamples::count;
        return seen;
    }

    const I& index_;
};

/// The radius of the cone about a ray of a picture, at a distance along the ray, whose cross section has the
/// area that a pixel has there. `direction` has length 1.
inline float pixel_radius(const PicturePlane& plane, const Vec3f& direction, float distance) {
    const float radius = plane.scale * std::sqrt(std::numbers::inv_pi_v<float>);
    if (plane.parallel) return radius;
    // A pixel that is seen at an angle to the plane has the solid angle scale²·cos³.
    const float cosine = std::max(0.0f, dot(direction, plane.forward));
    return radius * cosine * std::sqrt(cosine) * distance;
}

/// The cone about the ray through the middle of a pixel whose cross section has the pixel's area. Throws
/// InputError for a lens and for a panorama, whose pixels have none.
template <std::floating_point T>
ConeRays<T, 3> cone_of_pixel(const PictureSamples<T>& samples, int x, int y) {
    if (!samples.has_plane())
        throw InputError(
            "cones see by perspective and by parallel rays, not through a lens or in a panorama");
    const PicturePlane plane = samples.plane();
    const Ray<T, 3> ray = samples.ray(x, y);
    const auto radius = static_cast<T>(pixel_radius(plane, Vec3f(ray.direction), 1));
    return plane.parallel ? ConeRays<T, 3>{ray, radius, T(0)} : ConeRays<T, 3>{ray, T(0), radius};
}

}  // namespace hedgerow
