/// The point of the primitives farthest from a given point.
#pragma once

#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The farthest point among primitives that lie within the limits wholly. With a factor of more than 1 the
/// answer is at least the farthest distance over the factor away.
template <class Set, class Filter = KeepAll>
class FarthestPoint : public PointQuery<Set, Filter, FarProbe<typename Set::Scalar, Set::dimension>> {
public:
    using Base = PointQuery<Set, Filter, FarProbe<typename Set::Scalar, Set::dimension>>;
    using typename Base::Candidate, typename Base::Found, typename Base::Scalar;
    static constexpr Order order = Order::nearest;
    static_assert(!Instanced<Set>, "farthest points are asked of the index that is placed, not of instances");

    template <class Index>
    FarthestPoint(const Index& index, const Vec<Scalar, Base::dimension>& p, const NearLimits<Scalar>& limits,
                  const Filter& filter = {})
        : Base(index, p, limits, filter) {}

    Scalar limit() const { return limit_; }
    Flow offer(const Candidate& c) {
        if (!(c.distance2 <= this->limits().distance2) || !farther(c) || !this->counts(c)) return Flow::go_on;
        best_ = c;
        limit_ = limit_of(product(c.distance2, product(this->limits().factor, this->limits().factor)));
        return Flow::go_on;
    }
    /// False if no primitive lies within the distance.
    Found answer() const { return best_.element == no_primitive ? Found{} : this->found(best_); }

private:
    bool farther(const Candidate& c) const {
        if (best_.element == no_primitive) return true;
        return c.distance2 != best_.distance2 ? c.distance2 > best_.distance2 : comes_before(c, best_);
    }
    /// The limit of a walk for what is at `distance2` or farther. Boxes are measured with more roundings than
    /// primitives.
    static Scalar limit_of(Scalar distance2) {
        constexpr Scalar less = std::is_same_v<Scalar, float> ? Scalar(1 - 0x1p-20) : Scalar(1 - 0x1p-48);
        return 4 * std::numeric_limits<Scalar>::denorm_min() - product(distance2, less);
    }

    Candidate best_{Scalar(0), no_primitive, {}, no_primitive};
    Scalar limit_ = std::numeric_limits<Scalar>::infinity();
};

}  // namespace hedgerow
