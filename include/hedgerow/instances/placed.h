/// Primitives under a transform, as shapes of the world.
#pragma once

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/primitives/concepts.h>

namespace hedgerow {

/// A view of primitives through a transform. Points and the corners of triangles and segments are transformed
/// and rounded to T, and queries test the shapes between the transformed corners. Only under a similarity is
/// a transformed ball still a ball, and the closest point of a primitive of your own type still the closest;
/// under other transforms both throw InputError.
template <class P>
class Placed {
public:
    using Scalar = typename P::Scalar;
    static constexpr int dimension = P::dimension;
    using T = Scalar;
    static constexpr int D = dimension;

    /// `scale` is the factor of all lengths if the transform is a similarity, else 0.
    Placed(const P& set, const Affine<D>& there, const Affine<D>& back, double scale)
        : set_(set), there_(there), back_(back), scale_(scale) {}

    std::size_t size() const { return set_.size(); }
    Box<T, D> bounds(std::size_t i) const {
        const Box<T, D> own = set_.bounds(i);
        const auto box = there_.box({Vec<double, D>(own.low), Vec<double, D>(own.high)});
        return {Vec<T, D>(box.low), Vec<T, D>(box.high)};
    }

    /// Tests the shapes of a leaf against the query of the world. The leaf was found by a walk in the
    /// object's space.
    template <class Query>
    Flow test_leaf(const PointProbe<T, D>&, const Leaf& leaf, Query& query) const {
        const Vec<T, D>& p = query.world().point();
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const Foot<T, D> foot = closest_point(leaf.ids[i], p);
            if (query.offer(PointCandidate<T, D>{foot.distance2, leaf.ids[i], foot.point}) == Flow::stop)
                return Flow::stop;
        }
        return Flow::go_on;
    }
    template <class Query>
    Flow test_leaf(const BoxProbe<T, D>&, const Leaf& leaf, Query& query) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i)
            if (query.world().takes(*this, leaf.ids[i]) &&
                query.offer(OverlapCandidate{leaf.ids[i]}) == Flow::stop)
                return Flow::stop;
        return Flow::go_on;
    }
    template <Region R>
    bool overlaps(std::size_t i, const R& region) const {
        if constexpr (PointSet<P>)
            return lies_in(shape(i), region);
        else
            return overlap(shape(i), region);
    }
    template <Region R>
    bool lies_within(std::size_t i, const R& region) const {
        return lies_in(shape(i), region);
    }

private:
    static constexpr bool has_shape = requires(const P& s) { s.triangle(0); }
    || requires(const P& s) { s.segment(0); }
    || requires(const P& s) { s.sphere(0); }
    || requires(const P& s) { s.point(0); };

    auto shape(std::size_t i) const requires has_shape {
        if constexpr (requires { set_.triangle(i); }) {
            return transformed(there_, set_.triangle(i));
        } else if constexpr (requires { set_.segment(i); }) {
            return transformed(there_, set_.segment(i));
        } else if constexpr (requires { set_.sphere(i); }) {
            const auto ball = set_.sphere(i);
            return Sphere<T, D>{transformed(there_, ball.center),
                                rounded_to<T>(static_cast<double>(ball.radius) * similarity())};
        } else {
            return transformed(there_, set_.point(i));
        }
    }
    Foot<T, D> closest_point(PrimitiveId i, const Vec<T, D>& p) const {
        if constexpr (has_shape) {
            return hedgerow::closest_point(p, shape(i));
        } else {
            static_cast<void>(similarity());
            const Vec<T, D> inside = transformed(back_, p);
            const Vec<T, D> closest = foot_of(inside, set_.closest_point(i, inside)).point;
            return foot_of(p, clamped(transformed(there_, closest), bounds(i)));
        }
    }
    /// The factor of all lengths. Throws InputError if the transform is no similarity.
    double similarity() const {
        if (!(scale_ > 0))
            throw InputError(
                "an instance is stretched unevenly, and its primitives have no shape then that "
                "distances and overlaps are known of: ask it rays only, or scale it evenly");
        return scale_;
    }

    const P& set_;
    const Affine<D>& there_;
    const Affine<D>& back_;
    double scale_;
};

}  // namespace hedgerow
