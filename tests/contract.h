/// Queries of every kind, and the answers of an index to compare with those of another index.
#pragma once

#include <hedgerow/any_structure.h>
#include <hedgerow/hedgerow.h>

#include "matrix.h"

namespace hedgerow::contract {

/// Rays, points and boxes in and around a box. Some rays aim exactly at the given points, and some start from
/// them.
template <class T, int D>
struct Questions {
    std::vector<Ray<T, D>> rays;
    std::vector<Vec<T, D>> points;
    std::vector<Box<T, D>> boxes;

    Questions(const Box<T, D>& box, const std::vector<Vec<T, D>>& targets, std::size_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            rays.push_back(matrix::ray_of(box, targets, i));
            Random random(8, i);
            if (i % 4 != 0) continue;
            points.push_back(matrix::point_in(box, 0.5, random));
            const auto corner = matrix::point_in(box, 0.1, random);
            boxes.push_back(Box<T, D>().expand(corner).expand(matrix::point_in(box, 0.1, random)));
        }
    }
    template <class I>
    Questions(const I& index, std::size_t count)
        : Questions(index.bounds(), {index.bounds().low, index.bounds().center()}, count) {}
};

template <class I>
Questions(const I&, std::size_t) -> Questions<typename I::Scalar, I::dimension>;

/// The answers of an index to `Questions`.
template <class T, int D>
struct Answers {
    std::vector<Hit<T>> closest;
    std::vector<std::vector<Hit<T>>> all;
    std::vector<std::size_t> counts;  // 2 · hit count + any hit
    std::vector<Near<T, D>> near;
    std::vector<std::vector<Near<T, D>>> nearest;
    std::vector<std::vector<PrimitiveId>> overlapping;

    friend bool operator==(const Answers&, const Answers&) = default;
};

template <class I, class T = typename I::Scalar, int D = I::dimension>
Answers<T, D> answers(const I& index, const Questions<T, D>& questions) {
    Answers<T, D> said;
    for (const auto& ray : questions.rays) {
        said.closest.push_back(closest_hit(index, ray));
        said.counts.push_back(hit_count(index, ray) * 2 + any_hit(index, ray));
        all_hits(index, ray, said.all.emplace_back());
    }
    for (const auto& p : questions.points) {
        said.near.push_back(closest_point(index, p));
        nearest(index, p, 5, said.nearest.emplace_back());
    }
    for (const auto& box : questions.boxes) overlapping(index, box, said.overlapping.emplace_back());
    return said;
}

/// Calls f with an index of each kind: by its own type, and behind one.
template <class P, class F>
void with_each_structure(const P& set, F f) {
    f(build<Bvh>(set));
    f(build<WideBvh>(set));
    for (const std::string& spec : structures_for<P>()) f(build<AnyStructure>(set, {spec}));
}

}  // namespace hedgerow::contract
