/// Where a path meets a surface.
#pragma once

#include <cstdint>
#include <vector>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/model_scene.h>
#include <hedgerow/render/sampling/path_samples.h>
#include <hedgerow/render/scattering/point_scattering.h>
#include <hedgerow/surface.h>

namespace hedgerow {

/// Where a ray meets a triangle, as far as the origins of rays from there depend on it. F is float, double,
/// or lanes of these.
template <class F>
struct Landing {
    Vec<F, 3> normal;     ///< of the triangle, on the side of the ray's origin
    Vec<F, 3> low, high;  ///< the corners of the box of the triangle, or of its instance
    F distance;           ///< along the ray
    F smooth;             ///< that of the smooth surface

    /// Where rays begin that leave the surface on this side, and on the other side.
    Vec<F, 3> before(const Vec<F, 3>& origin, const Vec<F, 3>& direction, F begin) const {
        return offset_origin(origin, direction, begin, smooth, hit_error(origin, low, high), normal, normal);
    }
    Vec<F, 3> beyond(const Vec<F, 3>& origin, const Vec<F, 3>& direction, F begin) const {
        return offset_origin(origin, direction, begin, distance, hit_error(origin, low, high), -normal,
                             -normal);
    }
};

/// A point of a surface as a path sees it.
template <std::floating_point T>
struct PathVertex : SurfacePoint<float> {
    bool unlit = false;  ///< shows its colour, and ends the path
    Vec3f emission;      ///< toward the ray's origin
    /// What light loses in the body beyond the front: exp(−absorption · distance) is left. 0 of none.
    Vec3f absorption;
    Landing<T> landing;
    Vec<T, 3> before;  ///< where rays begin that leave the surface on this side
    Vec<T, 3> beyond;  ///< and on the other side, if the surface lets light through

    /// Computes both for the ray that came here.
    void set_origins(const Ray<T, 3>& ray) {
        before = landing.before(ray.origin, ray.direction, ray.t_min);
        if (material.transmission > 0) beyond = landing.beyond(ray.origin, ray.direction, ray.t_min);
    }
};

/// Finds the vertices of paths through a model. Borrows all.
template <std::floating_point T>
class PathSurfaces {
public:
    explicit PathSurfaces(const ModelScene<T>& scene) : scene_(scene) {
        for (const Material& m : scene.lookups().model().materials) {
            absorptions_.push_back(absorption_of(m));
            has_holes_ |= m.alpha_mode != AlphaMode::opaque;
            has_facets_ |= m.roughness > 0 && (m.metallic > 0 || m.specular > 0 || m.transmission > 0);
        }
    }

    /// Whether light may be lost between the facets of rough surfaces. Otherwise Compensation changes
    /// nothing.
    bool has_facets() const { return has_facets_; }
    /// Whether rays may go through parts of surfaces that are masked or blended; and whether a ray meets the
    /// surface at a hit. A surface of opacity α is there for that share of the keys.
    bool has_holes() const { return has_holes_; }
    bool is_there(const Hit<T>& hit, std::uint32_t key) const {
        const float alpha = scene_.lookups().alpha(hit, {});
        const std::uint32_t own = scattered32(scattered32(key + hit.element) + hit.instance);
        return alpha >= 1 || PixelSequence::unit(own) < alpha;
    }

    /// The texture coordinates at a hit; 0 of surfaces without.
    Vec2f texture_coordinates(const Hit<T>& hit) const {
        return scene_.lookups().texture_coordinates(hit).value_or(Vec2f());
    }
    /// The normal of the front at a hit, of length 1. O(1).
    Vec<T, 3> front(const Hit<T>& hit) const { return normal(scene_.instances(), hit); }
    /// The vertex at a hit of a ray whose direction has length 1. O(1).
    PathVertex<T> at(const Ray<T, 3>& ray, const Hit<T>& hit) const {
        PathVertex<T> v;
        find(ray, hit, front(hit), v);
        v.set_origins(ray);
        return v;
    }
    /// Sets the vertex at a hit where the normal of the front is known, but for where rays begin.
    void find(const Ray<T, 3>& ray, const Hit<T>& hit, const Vec<T, 3>& front, PathVertex<T>& v) const {
        const ModelLookups<T>& looks = scene_.lookups();
        const Material& m = looks.material(hit);
        const Vec3f direction(ray.direction);
        v.toward_origin = -direction;
        v.front = !(dot(front, ray.direction) > 0);
        const Vec<T, 3> geometric = v.front ? front : -front;
        v.geometric = Vec3f(geometric);
        v.unlit = m.unlit;
        v.material.base_colour = min(looks.base_colour(hit, {}), Vec3f::all(1));
        v.material.metallic = m.metallic * looks.number(m.metallic_texture, hit, {});
        v.material.roughness = m.roughness * looks.number(m.roughness_texture, hit, {});
        v.material.ior = m.ior, v.material.specular = m.specular;
        v.material.specular_colour = m.specular_colour;
        v.material.transmission = m.transmission * looks.number(m.transmission_texture, hit, {});
        v.material.thin = m.thin;
        v.emission = v.front || m.double_sided ? looks.emission(hit, {}) : Vec3f();
        v.absorption = absorptions_[looks.object(hit).material_of(hit.element)];
        const Vec3f smooth = looks.smooth_normal(hit);
        const T nearer = static_cast<T>(meet_smooth(hit, smooth, v));
        const Box<T, 3> bounds = scene_.surfaces().bounds(hit);
        v.landing = {geometric, bounds.low, bounds.high, hit.t, hit.t - nearer};
        v.shading = shading_normal(m.normal_texture ? looks.own_normal(hit, {}) : smooth, v);
    }

private:
    /// Takes the smooth surface that normals of corners mean for the surface, if that lets no light through.
    /// Returns how much nearer to the ray's origin it is than the triangle. So faces do not end in steps
    /// where light goes past them; and rays begin where this one came, so as not to get through walls.
    float meet_smooth(const Hit<T>& hit, const Vec3f& smooth, PathVertex<T>& v) const {
        const Vec3f facet = v.geometric;
        v.horizon = facet;
        if (v.material.transmission > 0 || length2(smooth) == 0) return 0;
        const float side = dot(smooth, facet) < 0 ? -1.0f : 1.0f;
        v.geometric = usable_normal(smooth * side, facet, v.toward_origin);
        const float height = dot(scene_.lookups().way_to_smooth(hit, static_cast<double>(side)), facet);
        if (!(height > 0)) return 0;
        v.horizon = v.geometric;
        return height / std::max(dot(facet, v.toward_origin), least_cosine);
    }
    /// Rays that come in flat are not followed back beyond this, since the smooth surface is known over the
    /// hit alone.
    static constexpr float least_cosine = 0.25f;

    static Vec3f shading_normal(Vec3f own, const PathVertex<T>& v) {
        if (length2(own) == 0) return v.geometric;
        if (!v.front) own = -own;
        return usable_normal(dot(own, v.geometric) < 0 ? v.geometric : own, v.geometric, v.toward_origin);
    }
    /// Light has the colour of attenuation after its distance (KHR_materials_volume).
    static Vec3f absorption_of(const Material& m) {
        Vec3f absorption;
        if (m.thin || !(m.attenuation_distance > 0) ||
            !(m.attenuation_distance < std::numeric_limits<float>::max()))
            return absorption;
        for (int k = 0; k < 3; ++k) {
            const double colour = std::clamp(static_cast<double>(m.attenuation_colour[k]), 1e-30, 1.0);
            absorption[k] =
                static_cast<float>(-logarithm(colour) / static_cast<double>(m.attenuation_distance));
        }
        return absorption;
    }

    const ModelScene<T>& scene_;
    std::vector<Vec3f> absorptions_;  // by material
    bool has_holes_ = false, has_facets_ = false;
};

}  // namespace hedgerow
