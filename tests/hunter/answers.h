/// The answers of a structure to one query, to be compared with those of brute force. Tests that the hunter
/// writes include this file.
#pragma once

#include <string>
#include <vector>

#include "shapes.h"

namespace hedgerow::hunter {

/// The answers to all queries of a ray. The overloads of `answer` make all queries of a ray, a point or a
/// box.
template <class T, int D>
struct RayAnswer {
    Hit<T> closest;
    bool any = false;
    std::vector<Hit<T>> all;

    friend bool operator==(const RayAnswer&, const RayAnswer&) = default;
};
template <class T, int D>
RayAnswer<T, D> answer(const AnyIndex<T, D>& index, const Ray<T, D>& ray) {
    RayAnswer<T, D> said;
    index.closest_hits(std::span(&ray, 1), {&said.closest, 1});
    index.any_hits(std::span(&ray, 1), {&said.any, 1});
    index.all_hits(ray, said.all);
    return said;
}
template <class T, int D>
std::vector<Near<T, D>> answer(const AnyIndex<T, D>& index, const Vec<T, D>& point) {
    std::vector<Near<T, D>> said, closest(1), all;
    index.nearest(point, 4, said);
    index.closest_points({&point, 1}, closest);
    // Search within the distance of the last of the four nearest, inclusive.
    if (!said.empty()) within(index, point, {.radius2 = said.back().distance2}, all);
    said.push_back(closest[0]);
    said.insert(said.end(), all.begin(), all.end());
    return said;
}
template <class T, int D>
std::vector<PrimitiveId> answer(const AnyIndex<T, D>& index, const Box<T, D>& box) {
    std::vector<PrimitiveId> said;
    index.overlapping(box, said);
    return said;
}
/// The number of queries that each `answer` makes.
inline constexpr std::size_t answers_to_a_ray = 3, answers_to_a_point = 3, answers_to_a_box = 1;

/// A change to an index between its build and the query. It leaves the primitives the same.
enum class Then { nothing, erased_and_inserted, refitted };

/// Makes a change. Returns false if the structure cannot make it.
template <class T, int D>
bool carry_out(Then then, AnyIndex<T, D>& index) {
    if (then == Then::refitted && index.refittable()) return index.refit(), true;
    if (then != Then::erased_and_inserted || !index.changes_one_by_one()) return then == Then::nothing;
    const auto count = static_cast<PrimitiveId>(index.size());
    for (PrimitiveId id = 0; id < count; id += 2) index.erase(id);
    for (PrimitiveId id = 0; id < count; id += 2) index.insert(id);
    return true;
}

/// Whether an index over some shapes, built and changed, is valid and answers a query like brute force.
template <class Shape, class Question>
bool as_brute_force(const std::string& spec, const std::vector<Shape>& shapes, const Question& question,
                    Then then = Then::nothing) {
    const auto set = set_of(shapes);
    const auto index = build_any(spec, set);
    carry_out(then, *index);
    return index->validate().empty() &&
           answer(*index, question) == answer(*build_any("brute-force", set), question);
}

}  // namespace hedgerow::hunter
