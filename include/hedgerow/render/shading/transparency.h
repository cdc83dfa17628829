/// Transparent surfaces along rays: layers of colour and opacity, composited front to back or back to front;
/// masks of opacity; and how much light gets through to a point.
///
/// Porter and Duff, "Compositing Digital Images", SIGGRAPH 1984: a layer of colour c and opacity a over what
/// is behind it. Front to back, C += T·a·c and T *= 1 − a, where T is what gets through the layers so far; so
/// a ray may end where hardly anything does. Hits come in batches by first_hits (Gribble, Naveros and
/// Kerzner, JCGT 3(1), 2014). Sums are in double, so both orders agree to 10⁻⁵ for thousands of layers.
/// Refraction and absorption between surfaces are left out: a layer has no thickness. A ray through the
/// common edge of two triangles hits both, and both count.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/render/shading/layer_walk.h>

namespace hedgerow {

/// What a surface does to a ray at a hit: it shows its colour, linear light that is not multiplied by the
/// opacity, and lets 1 − opacity through. The opacity is 0 to 1.
struct Layer {
    Vec3f colour;
    float opacity = 1;
};
/// Layers that were composited: their light, and the share of what is behind them that gets through.
struct Composite {
    Vec3f colour;
    float through = 1;

    /// The light with something behind the layers.
    Vec3f over(const Vec3f& background) const { return colour + background * through; }
};

/// A function of a ray and a hit of it, such as the layer of the surface there. It is called by several
/// threads at once if the executor has them, so it must be callable as const.
template <class F, class I>
concept OfRayAndHit = detail::Asks<F, RayOf<I>, HitOf<I>>;

namespace detail {

/// The opacity of a layer. Throws InputError unless it is 0 to 1.
template <class T>
double checked_opacity(float opacity, const Hit<T>& hit) {
    if (opacity >= 0 && opacity <= 1) return static_cast<double>(opacity);
    throw InputError("the opacity of primitive " + std::to_string(hit.primitive) + " (instance " +
                     std::to_string(hit.instance) + ") is " + std::to_string(opacity) +
                     ": opacities are 0 to 1");
}

/// Light in double, while layers are added to it.
inline Vec3d weighted(const Vec3f& colour, double weight) {
    return {product(static_cast<double>(colour[0]), weight), product(static_cast<double>(colour[1]), weight),
            product(static_cast<double>(colour[2]), weight)};
}

}  // namespace detail

/// Writes the layers of each ray, composited front to back: `layer(ray, hit)` is the Layer of a hit. Hits are
/// those of `all_hits`, in the order of (t, instance, element), so coplanar surfaces have an order too. An
/// opaque surface gives its colour exactly. A ray costs its closest hits up to its end, in batches that
/// shrink while rays end. Threads and filters are those of `closest_hits`. Throws InputError for opacities
/// that are not 0 to 1, and if there is less room than rays; where a function throws, some answers are
/// written.
template <class I, OfRayAndHit<I> LayerOf, class Filter = KeepAll>
TransparencyCounts composite_front_to_back(const I& index,
                                           const RayArray<typename I::Scalar, I::dimension>& rays,
                                           const LayerOf& layer, std::span<Composite> composites,
                                           const TransparencyOptions& options = {},
                                           const Filter& filter = {}) {
    detail::expect_room("rays", rays.size(), composites.size());
    std::vector<Vec3d> colours(rays.size());
    std::vector<double> through(rays.size(), 1.0);
    const auto opacity_of = [&](std::size_t i, const RayOf<I>& ray, const HitOf<I>& hit, double before) {
        const Layer here = layer(ray, hit);
        const double opacity = detail::checked_opacity(here.opacity, hit);
        colours[i] = colours[i] + detail::weighted(here.colour, before * opacity);
        through[i] = before * (1 - opacity);
        return opacity;
    };
    const auto counts = detail::follow_layers(index, rays, options, filter, opacity_of);
    for (std::size_t i = 0; i < rays.size(); ++i)
        composites[i] = {Vec3f(colours[i]), static_cast<float>(through[i])};
    return counts;
}

/// The layers of a list of hits of one ray, front to back as `all_hits` and lists of fragments
/// (visibility/fragments.h) have them, composited from the last to the first.
template <std::floating_point T, int D, class LayerOf>
Composite composite_list(const Ray<T, D>& ray, std::span<const Hit<T>> hits, const LayerOf& layer) {
    Vec3d colour;
    double through = 1;
    for (std::size_t j = hits.size(); j-- > 0;) {
        const Layer here = layer(ray, hits[j]);
        const double opacity = detail::checked_opacity(here.opacity, hits[j]);
        for (int c = 0; c < 3; ++c) colour[c] = product(colour[c], 1 - opacity);
        colour = colour + detail::weighted(here.colour, opacity);
        through *= 1 - opacity;
    }
    return {Vec3f(colour), static_cast<float>(through)};
}
/// Writes the layers of each ray, composited back to front, by the list of all its hits: the painter's order,
/// which shades every layer. Returns how many layers there are. Errors, threads and filters are those of
/// `composite_front_to_back`.
template <class I, OfRayAndHit<I> LayerOf, class Filter = KeepAll>
std::uint64_t composite_back_to_front(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays,
                                      const LayerOf& layer, std::span<Composite> composites,
                                      const RayOptions& options = {}, const Filter& filter = {}) {
    detail::expect_room("rays", rays.size(), composites.size());
    std::atomic<std::uint64_t> layers{0};
    detail::ask_rays(index, rays, options, filter, {}, [&](const auto& batch) {
        batch.executor.for_each_piece(rays.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::vector<HitOf<I>> hits;
            for (std::size_t i = begin; i < end; ++i) {
                const RayOf<I> ray = rays[i];
                layers += all_hits(index, ray, hits, filter_of_ray(batch.filter, i));
                composites[i] = composite_list(ray, std::span<const HitOf<I>>(hits), layer);
            }
        });
    });
    return layers;
}

/// Writes the share of light that gets through all surfaces on each ray, in [t_min, t_max]: shadows of
/// transparent things, where t_max is that of the light (1, for a direction from the point to the light).
/// `opacity(ray, hit)` is 0 to 1. A ray that ends early has what got through until then, less than
/// `ends_below`. Errors, threads and filters as in `composite_front_to_back`.
template <class I, OfRayAndHit<I> OpacityOf, class Filter = KeepAll>
TransparencyCounts transmittances(const I& index, const RayArray<typename I::Scalar, I::dimension>& rays,
                                  const OpacityOf& opacity, std::span<float> through,
                                  const TransparencyOptions& options = {}, const Filter& filter = {}) {
    detail::expect_room("rays", rays.size(), through.size());
    std::fill_n(through.begin(), rays.size(), 1.0f);
    const auto opacity_of = [&](std::size_t i, const RayOf<I>& ray, const HitOf<I>& hit, double before) {
        const double a = detail::checked_opacity(opacity(ray, hit), hit);
        through[i] = static_cast<float>(before * (1 - a));
        return a;
    };
    return detail::follow_layers(index, rays, options, filter, opacity_of);
}

/// The opacity that a mask makes of an opacity: nothing below the cutoff, everything else opaque.
constexpr float masked(float opacity, float cutoff) {
    return opacity >= cutoff ? 1.0f : 0.0f;
}
/// A filter for closest and any hits (queries/hit.h) that keeps hits where a mask is opaque: leaves and
/// fences that are drawn on a few triangles. It is made for one ray, of which it has a copy, or for the rays
/// of a batch, of which it has a view: a RayArray, a span, or that of a vector.
///
///   closest_hits(index, rays, hits, AlphaMask(opacity, rays));
///   any_hit(index, ray, AlphaMask(opacity, ray));
template <class OpacityOf, class Rays>
class AlphaMask {
public:
    /// 0.5 is the cutoff of glTF where a file gives none.
    AlphaMask(OpacityOf opacity, Rays rays, float cutoff = 0.5f)
        : opacity_(std::move(opacity)), rays_(std::move(rays)), cutoff_(cutoff) {}

    template <class H>
    bool operator()(std::size_t number, const H& hit) const {
        if constexpr (requires { rays_[number]; })
            return opacity_(rays_[number], hit) >= cutoff_;
        else
            return opacity_(rays_, hit) >= cutoff_;
    }

private:
    OpacityOf opacity_;
    Rays rays_;
    float cutoff_;
};
template <class OpacityOf, std::floating_point T, int D>
AlphaMask(OpacityOf, const std::vector<Ray<T, D>>&, float = 0.5f)
    -> AlphaMask<OpacityOf, std::span<const Ray<T, D>>>;

}  // namespace hedgerow
