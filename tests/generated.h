/// Scenes and queries that RapidCheck draws, and shrinks when a property fails. Most numbers are small
/// integers, so that primitives coincide, share corners, and lie in one plane or along axes. In wild scenes
/// they may be any numbers within 2^60.
#pragma once

#include <iomanip>

#include <rapidcheck.h>
#include <rapidcheck/detail/TestListenerAdapter.h>

#include <hedgerow/hedgerow.h>

#include "matrix.h"

namespace hedgerow {

template <class T, int D>
void showValue(const Vec<T, D>& v, std::ostream& out) {
    out << std::setprecision(std::numeric_limits<T>::max_digits10);
    for (int k = 0; k < D; ++k) out << (k == 0 ? "(" : ", ") << v[k];
    out << ')';
}
template <class T, int D>
void showValue(const Box<T, D>& b, std::ostream& out) {
    out << rc::toString(b.low) << '-' << rc::toString(b.high);
}
template <class T, int D>
void showValue(const Ray<T, D>& r, std::ostream& out) {
    out << rc::toString(r.origin) << " + t " << rc::toString(r.direction) << ", t in [" << r.t_min << ", "
        << r.t_max << ']';
}
template <class T, int D>
void showValue(const Sphere<T, D>& s, std::ostream& out) {
    out << rc::toString(s.center) << " radius " << s.radius;
}
template <class T, int D>
void showValue(const Segment<T, D>& s, std::ostream& out) {
    out << rc::toString(s.a) << '-' << rc::toString(s.b);
}

}  // namespace hedgerow

namespace hedgerow::generated {

namespace gen = rc::gen;

/// 0, 1, −1, 2, −2 ... : small numbers shrink to smaller ones.
inline rc::Gen<int> integers(int reach) {
    return gen::map(gen::inRange(0, 2 * reach + 1), [](int k) { return k % 2 == 0 ? -k / 2 : (k + 1) / 2; });
}
template <class T>
rc::Gen<T> numbers(bool wild) {
    auto small = gen::map(integers(4), [](int k) { return T(k); });
    auto any = gen::map(gen::pair(integers(4095), integers(47)),
                        [](const auto& p) { return std::ldexp(T(p.first), p.second); });
    return wild ? gen::oneOf(small, any, any) : small;
}
template <class T, int D>
rc::Gen<Vec<T, D>> vectors(bool wild) {
    return gen::map(gen::container<std::array<T, D>>(numbers<T>(wild)), [](const auto& a) {
        Vec<T, D> v;
        for (int k = 0; k < D; ++k) v[k] = a[static_cast<std::size_t>(k)];
        return v;
    });
}
template <class T, int D>
rc::Gen<Box<T, D>> boxes(bool wild) {
    return gen::map(gen::pair(vectors<T, D>(wild), vectors<T, D>(wild)),
                    [](const auto& p) { return Box<T, D>().expand(p.first).expand(p.second); });
}
/// A ray of any kind: towards a corner, towards the middle of two corners, anywhere, or along an axis with −0
/// or subnormal components. Some directions are long or short, and some intervals begin or end on the way.
template <class T, int D>
Ray<T, D> any_ray(const std::vector<Vec<T, D>>& corners, bool wild) {
    const auto corner = [&] { return corners[*gen::inRange<std::size_t>(0, corners.size())]; };
    Ray<T, D> ray{*vectors<T, D>(wild), *vectors<T, D>(wild)};
    // Aim at a corner, at the middle of two, or along an axis.
    switch (*gen::inRange(0, 5)) {
        case 1:
            ray.direction = corner() - ray.origin;
            break;
        case 2:
            ray.direction = corner() * T(0.5) + corner() * T(0.5) - ray.origin;
            break;
        case 3:
            ray.origin = corner() - ray.direction;
            break;
        case 4: {
            using limits = std::numeric_limits<T>;
            const T x = *gen::element(T(0), T(-0.0), limits::denorm_min(), limits::min(), -limits::min());
            const int axis = *gen::inRange(0, D);
            for (int k = 0; k < D; ++k)
                if (k != axis) ray.direction[k] = x;
            if (*gen::arbitrary<bool>()) ray.origin = corner() - ray.direction * T(0.5);
        }
    }
    // Change the length of the direction and the interval.
    if (*gen::inRange(0, 4) == 3) ray.direction = ray.direction * std::exp2(T(*integers(30)));
    if (*gen::inRange(0, 4) == 3) ray.t_min = T(*gen::inRange(0, 4)) / 2;
    if (*gen::inRange(0, 4) == 3) ray.t_max = T(*gen::inRange(0, 8)) / 2;
    return ray;
}

/// The primitives of a set, which may be changed: of a mesh, its triangles.
template <class T>
auto& items(TriangleMesh<T>& set) {
    return set.triangles;
}
template <class T>
auto& items(SphereSet<T, 3>& set) {
    return set.spheres;
}
template <class T>
auto& items(SegmentSet<T>& set) {
    return set.segments;
}
template <class T, int D>
auto& items(PointCloud<T, D>& set) {
    return set.points;
}

/// Points to aim at, at least one.
template <class T>
auto corners_of(const TriangleMesh<T>& set) {
    return set.vertices;
}
template <class P>
auto corners_of(const P& set) {
    std::vector<Vec<typename P::Scalar, P::dimension>> corners(1);
    for (std::size_t i = 0; i < set.size(); ++i) corners.push_back(set.view().bounds(i).high);
    return corners;
}

/// One primitive. A triangle has its corners among 10 vertices.
template <class P>
auto any_item(bool wild) {
    using T = typename P::Scalar;
    constexpr int D = P::dimension;
    const auto vector = gen::resize(rc::kNominalSize, vectors<T, D>(wild));
    if constexpr (std::is_same_v<P, TriangleMesh<T>>)
        return gen::container<TriangleIndices>(gen::resize(rc::kNominalSize, gen::inRange(0u, 10u)));
    else if constexpr (std::is_same_v<P, SphereSet<T, 3>>)
        return gen::map(gen::pair(vector, vector), [](const auto& p) {
            return Sphere<T, 3>{p.first, std::abs(p.second[0])};
        });
    else if constexpr (std::is_same_v<P, SegmentSet<T>>)
        return gen::map(gen::pair(vector, vector), [](const auto& p) {
            return Segment<T, 2>{p.first, p.second};
        });
    else
        return vector;
}
/// Up to 40 primitives.
template <class P>
P any_set(bool wild) {
    using T = typename P::Scalar;
    P set;
    if constexpr (std::is_same_v<P, TriangleMesh<T>>) {
        const auto vector = gen::resize(rc::kNominalSize, vectors<T, 3>(wild));
        set.vertices = *gen::container<std::vector<Vec<T, 3>>>(10, vector).as("vertices");
    }
    using Items = std::remove_cvref_t<decltype(items(set))>;
    items(set) = *gen::resize(40, gen::container<Items>(any_item<P>(wild))).as("primitives");
    return set;
}

/// Checks a property on 300 generated cases, or on 20,000 with HEDGEROW_LONG=1. `times` multiplies this where
/// a case is little work. The cases are the same in every run.
template <int times = 1, class Property>
void expect_always(Property property) {
    rc::detail::TestParams params;
    params.seed = 11;
    params.maxSuccess = static_cast<int>(in_long_runs(20000, 300)) * times;
    rc::detail::TestListenerAdapter silent;
    const auto cases =
        gen::resize(rc::kNominalSize, rc::detail::toProperty(property));  // full variety in all cases
    const auto result = rc::detail::checkProperty(cases, rc::detail::TestMetadata(), params, silent, {});
    std::ostringstream message;
    rc::detail::printResultMessage(result, message);
    EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << message.str();
}

template <class P>
struct AnyCase {
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    bool wild = *gen::arbitrary<bool>().as("wild");
    P set = any_set<P>(wild);

    Ray<T, D> ray() const {
        return *gen::exec([corners = corners_of(set), wild = wild] {
                    return any_ray(corners, wild);
                }).as("ray");
    }
    Vec<T, D> point() const { return *vectors<T, D>(wild).as("point"); }
    Box<T, D> box() const { return *boxes<T, D>(wild).as("box"); }
};

}  // namespace hedgerow::generated
