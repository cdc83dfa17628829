/// An index placed by a transform, and bounds on the errors of its answers in the world.
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/instances/placed.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A borrowed index and the transform from the index's space to the world. Options and filters may refuse the
/// instance by its `mask`. Hits report its `geometry` beside its number.
template <class I>
struct Instance {
    const I* index;
    Transform<I::dimension> transform;
    std::uint32_t mask = 0xFFFFFFFFu, geometry = 0;

    Instance(const I& borrowed, const Transform<I::dimension>& placed = {}, std::uint32_t with_mask = ~0u,
             std::uint32_t as_geometry = 0)
        : index(&borrowed), transform(placed), mask(with_mask), geometry(as_geometry) {}
    Instance(const I&& gone, const Transform<I::dimension>& = {}, std::uint32_t = ~0u,
             std::uint32_t = 0) = delete;  // an index must outlive its instance
};

/// The least that the largest component of a ray's direction may be in an object's space. A shorter direction
/// hits nothing there. T drops components below its normal numbers; at this length or more that turns the
/// direction by 1/16 unit roundoff at most.
template <std::floating_point T>
inline constexpr T shortest_direction = std::numeric_limits<T>::min() * (16 / unit_roundoff<T>);

/// The ray in the space of an object, to which `back` leads: each component is computed in double and rounded
/// once. The direction is 0 if it is shorter than `shortest_direction`.
template <class T, int D>
Ray<T, D> ray_inside(const Affine<D>& back, const Ray<T, D>& ray) {
    const Vec<T, D> direction(back.vector(Vec<double, D>(ray.direction)));
    const bool usable = max_component(abs(direction)) >= shortest_direction<T>;
    return {Vec<T, D>(back.point(Vec<double, D>(ray.origin))), usable ? direction : Vec<T, D>(), ray.t_min,
            ray.t_max};
}

/// An instance prepared for queries, and bounds on the errors of its answers.
///
/// Let A x + a be the map to the world and N x + n the map back, ‖·‖ the greatest sum of a row's magnitudes,
/// R a bound of ‖A N − 1‖, L the largest coordinate of the object's box, W that of its world box, u the unit
/// roundoff of T.
///
/// *Regions.* A corner of a primitive in the world is computed in double and rounded to T. It errs by u·W and
/// by 8 roundings (of doubles) of ‖A‖L + |a|. A shape's closest point adds 8u·W, its overlap test nothing
/// (cells.h), and what is fitted around the object's own box, like a ball, u‖A‖L. The sum of these errors is
/// covered by `margin` = u(64W + 32(‖A‖L + |a|)), and the world box is enlarged by it. The world corners of a
/// triangle are in the world box anyway (Affine::box).
///
/// *Rays.* The origin o is mapped to o' = N o + n, with an error of 2u|o'| + 8u(‖N‖|o| + |n|). The direction
/// is mapped with an error of the same form, if it is not shorter than `shortest_direction`. At a place in
/// the object's box the two errors sum to 3u(L + |o'|), plus 8u‖N‖ times the distance travelled. A hit lies
/// within e' of its primitive's box there, with e' = 16u(L + |o'|) + 4u|o'| (RayProbe). Since |o'| <= ‖N‖|o|
/// + |n|, all these errors together are less than 32u(L + |n|) + 64u‖N‖|o|. In the world they are ‖A‖ times
/// as large, and R(W + |a|) more, since N is rounded. This sum is added to the error of the world's ray,
/// whose bound then holds for instances as for any other primitive: t is the same number in both spaces,
/// since the direction is not normalised.
template <class I>
class PlacedIndex {
public:
    using T = typename I::Scalar;
    static constexpr int D = I::dimension;

    PlacedIndex(const Instance<I>& instance)
        : index_(instance.index),
          transform_(instance.transform),
          mask_(instance.mask),
          geometry_(instance.geometry) {
        const Box<double, D> own{Vec<double, D>(index_->bounds().low), Vec<double, D>(index_->bounds().high)};
        const auto box = transform_.there().box(own);
        const double object = largest(own), world = largest(box),
                     moved = max_component(abs(transform_.there().shift));
        const double u = static_cast<double>(unit_roundoff<T>), reach = transform_.there().reach();
        const auto& back = transform_.back();
        // The world box, enlarged by the margin of region queries.
        margin_ = u * (64 * world + 32 * (reach * object + moved)) +
                  64 * static_cast<double>(std::numeric_limits<T>::denorm_min());
        for (int k = 0; k < D; ++k) {
            bounds_.low[k] = rounded_down<T>(box.low[k] - margin_);
            bounds_.high[k] = rounded_up<T>(box.high[k] + margin_);
        }
        // The errors of rays: a constant part, and a factor of the origin's largest coordinate.
        missed_ = transform_.residual() * (world + moved);
        ray_error_ = missed_ + u * reach * 32 * (object + max_component(abs(back.shift)));
        ray_error_by_origin_ = 64 * u * reach * back.reach();
        // The stretches of both maps. Equal stretches to the world, up to roundings, make a similarity.
        shrinks_ = max_component(back.stretches()) * (1 + 0x1p-18);
        const Vec<double, D> stretches = transform_.there().stretches();
        const double most = max_component(stretches), least = -max_component(-stretches);
        if (most - least <= 32 * u * most) scale_ = most;
    }

    const I& index() const { return *index_; }
    const Transform<D>& transform() const { return transform_; }
    std::uint32_t mask() const { return mask_; }
    std::uint32_t geometry() const { return geometry_; }
    const Box<T, D>& bounds() const { return bounds_; }
    double ray_error() const { return ray_error_; }
    double ray_error_by_origin() const { return ray_error_by_origin_; }
    /// The object's primitives, as shapes of the world.
    auto primitives() const {
        return Placed<typename I::Primitives>(index_->primitives(), transform_.there(), transform_.back(),
                                              scale_);
    }

    Ray<T, D> inside(const Ray<T, D>& ray) const { return ray_inside(transform_.back(), ray); }

    /// `center` is a point of the world, mapped to the object's space. Everything within squared distance d
    /// of the point in the world is within squared distance `radius2(d)` of `center` in the object's space.
    class Ball {
    public:
        Ball(const PlacedIndex& placed, const Vec<T, D>& p) {
            const auto& back = placed.transform_.back();
            const double u = static_cast<double>(unit_roundoff<T>), wide = 2;  // > √D
            const double at = max_component(abs(Vec<double, D>(p)));
            const Vec<double, D> inside = back.point(Vec<double, D>(p));
            const double there = max_component(abs(inside));
            // Beyond `largest_coordinate` squares may overflow T, and distances prune nothing: the ball is
            // everything.
            known_ = there < static_cast<double>(largest_coordinate<T>);
            center_ = known_ ? Vec<T, D>(inside) : placed.index_->bounds().low;
            shrinks_ = placed.shrinks_;
            world_error_ =
                wide * (2 * placed.margin_ + 2 * (placed.missed_ + placed.transform_.residual() * at));
            error_ = wide * u * (2 * there + 8 * (back.reach() * at + max_component(abs(back.shift)))) +
                     64 * static_cast<double>(std::numeric_limits<T>::denorm_min());
        }
        const Vec<T, D>& center() const { return center_; }
        T radius2(T world_distance2) const {
            constexpr double most = static_cast<double>(std::numeric_limits<T>::max());
            if (!known_) return std::numeric_limits<T>::max();
            const double far = std::sqrt(static_cast<double>(world_distance2)) * (1 + 0x1p-20) + world_error_;
            const double here = far * shrinks_ + error_;
            return rounded_up<T>(std::min(most, product(here, here) * (1 + 0x1p-18)));
        }

    private:
        Vec<T, D> center_;
        double shrinks_, world_error_, error_;
        bool known_;
    };

    /// A box in the object's space around everything that may overlap a region of the world. Empty if nothing
    /// does.
    template <Region R>
    Box<T, D> inside(const R& region) const {
        if (containment(region, bounds_) == Containment::outside) return {};
        const Box<double, D> own{Vec<double, D>(bounds_.low), Vec<double, D>(bounds_.high)};
        const Box<double, D> wide = bounds_in(region, own, scene_margin * largest(own));
        if (wide.empty()) return {};
        const auto& back = transform_.back();
        const auto box = back.box(wide);
        const double u = static_cast<double>(unit_roundoff<T>);
        const double error = back.reach() * (4 * margin_ + 2 * missed_) +
                             16 * u * (back.reach() * largest(wide) + max_component(abs(back.shift)));
        Box<T, D> object;
        for (int k = 0; k < D; ++k) {
            object.low[k] = rounded_down<T>(box.low[k] - error);
            object.high[k] = rounded_up<T>(box.high[k] + error);
        }
        return object;
    }

private:
    static double largest(const Box<double, D>& b) {
        return std::max(max_component(abs(b.low)), max_component(abs(b.high)));
    }

    const I* index_;
    Transform<D> transform_;
    std::uint32_t mask_, geometry_;
    Box<T, D> bounds_;
    double margin_ = 0, missed_ = 0, ray_error_ = 0, ray_error_by_origin_ = 0;
    double shrinks_ = 0;  // the greatest stretch of a vector by the map back
    double scale_ = 0;    // the stretch of all vectors by the map to the world, in a similarity; else 0
};

}  // namespace hedgerow
