/// Answers to the questions of pairs by a structure, and by all pairs.
#pragma once

#include <vector>

#include <hedgerow/hedgerow.h>

#include "shapes.h"

namespace hedgerow::hunter {

template <class T>
Triangle<double, 3> in_double(const Triangle<T, 3>& t) {
    return {Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)};
}

/// All that is asked of a set, and of a set and another.
template <class T, int D>
struct PairAnswers {
    std::vector<ElementPair> crossings, self;
    std::vector<PairWithin<T>> within_one, within_two;
    Apart<T, D> apart, apart_within;

    friend bool operator==(const PairAnswers&, const PairAnswers&) = default;
};

/// Asks indexes of structures SA and SB.
template <template <class, int> class SA, template <class, int> class SB, class Shape>
auto pair_answers(const std::vector<Shape>& one, const std::vector<Shape>& two, double radius) {
    const auto a = set_of(one), b = set_of(two);
    using T = typename std::decay_t<decltype(a)>::Scalar;
    constexpr int D = std::decay_t<decltype(a)>::dimension;
    const auto in_a = build<SA>(a);
    const auto in_b = build<SB>(b);
    PairAnswers<T, D> said;
    const double near = static_cast<double>(static_cast<T>(radius));
    said.apart = minimum_distance(in_a, in_b);
    said.apart_within = minimum_distance(in_a, in_b, {.radius = near});
    if constexpr (std::is_same_v<Shape, Triangle<T, 3>>) {
        crossing_pairs(in_a, in_b, said.crossings);
        self_intersections(in_a, said.self);
    } else {
        pairs_within(in_a, near, said.within_one);
        pairs_within(in_a, in_b, near, said.within_two);
    }
    return said;
}

/// Asks all pairs, one after the other.
template <class Shape>
auto all_pair_answers(const std::vector<Shape>& one, const std::vector<Shape>& two, double radius) {
    const auto a = set_of(one), b = set_of(two);
    using T = typename std::decay_t<decltype(a)>::Scalar;
    constexpr int D = std::decay_t<decltype(a)>::dimension;
    constexpr bool triangles = std::is_same_v<Shape, Triangle<T, 3>>;
    const T radius2 = largest_square_within(static_cast<T>(radius));
    PairAnswers<T, D> said;
    for (PrimitiveId i = 0; i < one.size(); ++i)
        for (PrimitiveId j = 0; j < two.size(); ++j) {
            const auto gap = gap_between(a.view(), i, b.view(), j);
            if (gap.distance2 < said.apart.distance2) said.apart = {gap.distance2, i, j, gap.a, gap.b};
            if constexpr (triangles) {
                if (triangles_meet(hunter::in_double(one[i]), hunter::in_double(two[j])))
                    said.crossings.push_back({i, j});
            } else if (gap.distance2 <= radius2) {
                said.within_two.push_back({i, j, gap.distance2});
            }
        }
    if (said.apart.distance2 <= radius2) said.apart_within = said.apart;
    for (PrimitiveId i = 0; i < one.size(); ++i)
        for (PrimitiveId j = i + 1; j < one.size(); ++j) {
            if constexpr (triangles) {
                if (meet_beyond_shared(hunter::in_double(one[i]), hunter::in_double(one[j])))
                    said.self.push_back({i, j});
            } else if (const auto gap = gap_between(a.view(), i, a.view(), j); gap.distance2 <= radius2) {
                said.within_one.push_back({i, j, gap.distance2});
            }
        }
    return said;
}

/// Whether two structures answer what all pairs do.
template <template <class, int> class SA, template <class, int> class SB, class Shape>
bool pairs_as_all_pairs(const std::vector<Shape>& one, const std::vector<Shape>& two, double radius) {
    return pair_answers<SA, SB>(one, two, radius) == all_pair_answers(one, two, radius);
}

}  // namespace hedgerow::hunter
