/// Frames of directions around a normal, and shading normals that leave no black rims.
#pragma once

#include <algorithm>
#include <cmath>

#include <hedgerow/geometry/number_lanes.h>

namespace hedgerow {

/// Three orthogonal directions of length 1, the third of which is a given normal. F is float or FloatLanes.
template <class F>
class Frame {
public:
    /// The frame of a normal of length 1 (Duff et al., Building an orthonormal basis, revisited, JCGT 2017).
    explicit Frame(const Vec<F, 3>& normal) : normal_(normal) {
        const F sign = select(normal[2] < 0, F(-1), F(1));
        const F a = -1 / (sign + normal[2]), b = product(product(normal[0], normal[1]), a);
        tangent_ = {1 + sign * product(product(normal[0], normal[0]), a), sign * b, -sign * normal[0]};
        bitangent_ = {b, sign + product(product(normal[1], normal[1]), a), -normal[1]};
    }

    const Vec<F, 3>& normal() const { return normal_; }
    /// The components of a direction along the frame. The third is along the normal.
    Vec<F, 3> to_local(const Vec<F, 3>& world) const {
        return {dot(tangent_, world), dot(bitangent_, world), dot(normal_, world)};
    }
    Vec<F, 3> to_world(const Vec<F, 3>& local) const {
        return tangent_ * local[0] + bitangent_ * local[1] + normal_ * local[2];
    }

private:
    Vec<F, 3> tangent_, bitangent_, normal_;
};

/// The shading normal itself, if the mirror reflection of `o` about it stays above the surface. Otherwise
/// that normal is turned towards the geometric one until the reflection has the height
/// min(0.9·(geometric·o), 0.01). The result r has dot(r, o) of at least half of dot(geometric, o), less
/// rounding. All three have length 1, and the geometric normal lies on the side of o; if it does not, it is
/// returned. Without this, reflections go below the surface and leave black rims (Chiang, Li and Burley,
/// Taming the shadow terminator, SIGGRAPH Talks 2019; Hanika, Hacking the shadow terminator, Ray Tracing
/// Gems II, 2021).
inline Vec3f usable_normal(const Vec3f& shading, const Vec3f& geometric, const Vec3f& o) {
    const float height = dot(geometric, o);
    if (!(height > 0)) return geometric;
    const float least = std::min(0.9f * height, 0.01f), slope = dot(shading, geometric);
    if (slope > 0 && product(2 * dot(shading, o), slope) - height >= least) return shading;
    const Vec3f across = shading - geometric * slope;
    if (!(length2(across) > 1e-12f)) return geometric;

    // In the plane of both normals let the result be at the angle θ from the geometric normal, and o's
    // projection (sideways, height) at the angle ψ with length ρ. The reflection of o has the height
    // ρ cos(2θ − ψ). So the largest θ is (ψ + arccos(least / ρ)) / 2, which is below 90°.
    const Vec3f axis = normalized(across);
    const float sideways = dot(axis, o);
    const float rho2 = product(sideways, sideways) + product(height, height);
    const float root = std::sqrt(std::max(rho2 - product(least, least), 0.0f));
    const float cosine = std::clamp((product(height, least) - product(sideways, root)) / rho2, -1.0f, 1.0f);
    return normalized(geometric * std::sqrt((1 + cosine) / 2) + axis * std::sqrt((1 - cosine) / 2));
}

/// The share of the light from direction i that a surface shows whose shading normal differs from the
/// geometric one: 1 where i is high above the surface, smoothly down to 0 at its horizon. Without this, a
/// shading normal that leans to the light shows it up to that horizon, and faces end in bright edges (Chiang,
/// Li and Burley, Taming the shadow terminator, SIGGRAPH Talks 2019). All have length 1, and i lies on the
/// side of both normals.
template <class F>
F share_at_terminator(const Vec<F, 3>& shading, const Vec<F, 3>& geometric, const Vec<F, 3>& i) {
    const auto differ = !equal(shading, geometric);
    if (!any(differ)) return 1;
    const F g = dot(geometric, i) / product(dot(shading, i), dot(shading, geometric));
    return select(differ && g < 1, product(g, 1 + product(g, 1 - g)), 1);
}

}  // namespace hedgerow
