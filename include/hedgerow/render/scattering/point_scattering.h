/// What a point of a surface does to light, in directions of the world.
#pragma once

#include <hedgerow/render/scattering/frame.h>
#include <hedgerow/render/scattering/scattering.h>

namespace hedgerow {

/// A point of a surface, as far as its scattering depends on it; or four points, of F = FloatLanes.
/// Directions have length 1.
template <class F>
struct SurfacePoint {
    using Direction = Vec<F, 3>;

    Direction toward_origin;  ///< back along the ray
    /// The normal of the surface, on the side of the ray's origin: that of the triangle, or of the smooth
    /// surface over it that normals of its corners mean.
    Direction geometric;
    /// No ray begins on the side of the origin below the plane of this normal: that of the triangle, where
    /// the smooth surface lies behind it.
    Direction horizon;
    Direction shading;      ///< the normal by which it scatters, on the same side
    MaskOf<F> front{true};  ///< whether the ray came to the front
    SurfaceMaterialOf<F> material;

    /// Whether a direction lies above the smooth surface, and below the triangle that is before it. A ray
    /// would meet the surface anew, at once.
    MaskOf<F> is_below_horizon(const Direction& direction) const {
        return dot(direction, geometric) > 0 && !(dot(direction, horizon) > 0);
    }
    /// The mirror image of a direction in the plane of the horizon.
    Direction mirrored(const Direction& direction) const { return -reflected(direction, horizon); }
    /// The normal on whose side the light is that the surface scatters; 0: on both.
    Direction side_of_light() const { return only(!(material.transmission > 0), geometric); }
};

/// Materials and points side by side: of(k) is that of lane k.
template <class Of>
SurfaceMaterialOf<FloatLanes> materials_in_lanes(const Of& of) {
    using S = SurfaceMaterial;
    return {in_lanes(of, &S::base_colour),  in_lanes(of, &S::metallic), in_lanes(of, &S::roughness),
            in_lanes(of, &S::ior),          in_lanes(of, &S::specular), in_lanes(of, &S::specular_colour),
            in_lanes(of, &S::transmission), in_lanes(of, &S::thin)};
}
template <class Of>
SurfacePoint<FloatLanes> points_in_lanes(const Of& of) {
    using S = SurfacePoint<float>;
    return {in_lanes(of, &S::toward_origin),
            in_lanes(of, &S::geometric),
            in_lanes(of, &S::horizon),
            in_lanes(of, &S::shading),
            in_lanes(of, &S::front),
            materials_in_lanes([&](int k) -> const SurfaceMaterial& { return of(k).material; })};
}
/// A direction in which a path goes on.
template <class F>
struct Departure {
    MaskOf<F> exists{false};  ///< otherwise the path ends
    Vec<F, 3> direction;
    /// What the path's throughput is multiplied by, one after the other.
    Vec<F, 3> weight;
    F shown = 1;
    F density = 0;                 ///< per solid angle; 0 of a direction that is the only one of its lobe
    MaskOf<F> transmitted{false};  ///< to the other side of the surface
};

/// The departure of a lane.
inline Departure<float> lane(const Departure<FloatLanes>& d, int k) {
    return {d.exists[k], lane(d.direction, k), lane(d.weight, k), d.shown[k], d.density[k], d.transmitted[k]};
}

/// The scattering of a point. Directions between the smooth surface and the triangle before it are mirrored
/// in the triangle, as if it were the surface next to the point: rays that begin below a triangle could get
/// through a wall at its edge, and without their light a closed room would be too dark. Surfaces that light
/// goes through keep their triangles. What they reflect below the triangle is mirrored to above it, and what
/// they let through to above it is mirrored to below it, so that glass loses no light.
template <class F>
class PointScattering {
    using Mask = MaskOf<F>;
    using Direction = Vec<F, 3>;

public:
    /// Borrows the point, and the tables as Scattering does.
    PointScattering(const SurfacePoint<F>& at, const Compensation* tables)
        : at_(at),
          frame_(at.shading),
          local_(at.material, frame_.to_local(at.toward_origin), !at.front, tables) {}

    /// Whether light cannot be sampled in place of the surface.
    Mask only_specular() const { return local_.only_specular(); }
    /// What the surface does with light that a ray of this direction meets, apart from single directions.
    ScatteredLightOf<F> at(const Direction& direction) const {
        const Mask above = !is_mirrored(direction);
        const ScatteredLightOf<F> s = with_image(direction, by_lobes(direction), above);
        return {only(above, s.value), only(above, s.density)};
    }
    /// Chooses where a path goes on by three numbers in [0, 1).
    Departure<F> sample(F choose_lobe, F u, F v) const {
        const ScatteredDirectionOf<F> local = local_.sample(choose_lobe, u, v);
        Departure<F> next;
        next.direction = normalized(frame_.to_world(local.direction));
        next.exists = local.exists && may_scatter(next.direction, local.direction);
        next.weight = local.weight, next.transmitted = local.transmitted;
        next.shown = select(local.specular, 1, shown_share(next.direction));
        next.density = only(!local.specular, local.density);
        next.density = with_image(next.direction, {{}, next.density}, next.density > 0).density;
        const Mask below = is_mirrored(next.direction);
        if (any(below)) next.direction = select(below, at_.mirrored(next.direction), next.direction);
        return next;
    }

private:
    /// What the lobes do with light of a direction, and where it counts, with that of its mirror image, if
    /// one of the two is below the horizon: the same ray brings both.
    ScatteredLightOf<F> with_image(const Direction& direction, const ScatteredLightOf<F>& s,
                                   Mask counts) const {
        const Direction image = at_.mirrored(direction);
        const Mask twice = counts && (is_mirrored(direction) || is_mirrored(image));
        if (!any(twice)) return s;
        const ScatteredLightOf<F> more = by_lobes(image);
        return {select(twice, s.value + more.value, s.value),
                select(twice, s.density + more.density, s.density)};
    }
    /// What the lobes do with light of a direction; nothing where they must not.
    ScatteredLightOf<F> by_lobes(const Direction& direction) const {
        const Direction i = frame_.to_local(direction);
        const Mask on_side = may_scatter(direction, i);
        const ScatteredLightOf<F> s = local_.at(i);
        return {only(on_side, s.value * shown_share(direction)), only(on_side, s.density)};
    }
    Mask lets_light_through() const { return at_.material.transmission > 0; }
    /// Whether a ray of the mirror image goes in place of one that is scattered in this direction.
    Mask is_mirrored(const Direction& direction) const {
        const Mask below = at_.is_below_horizon(direction), through = lets_light_through();
        if (!any(through)) return below;
        return select(through, !is_on_one_side(direction, frame_.to_local(direction)), below);
    }
    /// Whether a direction lies on the same side of the surface as of the plane across the shading normal.
    Mask is_on_one_side(const Direction& direction, const Direction& local) const {
        const Mask up = local[2] > 0;
        return select(dot(direction, at_.geometric) > 0, up, !up);
    }
    /// Whether lobes scatter in a direction. Where the surface is opaque those of two sides would let light
    /// through walls, or are reflections into the surface.
    Mask may_scatter(const Direction& direction, const Direction& local) const {
        return !equal(local[2], 0) && (lets_light_through() || is_on_one_side(direction, local));
    }
    /// The share of light from a direction that an opaque surface shows.
    F shown_share(const Direction& direction) const {
        return select(at_.material.transmission > 0, 1,
                      share_at_terminator(frame_.normal(), at_.geometric, direction));
    }

    const SurfacePoint<F>& at_;
    Frame<F> frame_;
    ScatteringOf<F> local_;
};

}  // namespace hedgerow
