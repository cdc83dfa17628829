/// Answers of a structure over instances, compared with those of brute force over brute force.
#pragma once

#include <array>
#include <vector>

#include <hedgerow/hedgerow.h>

#include "../placements.h"
#include "shapes.h"

namespace hedgerow::hunter {

template <class T>
struct PlacedRayAnswer {
    Hit<T> closest;
    bool any = false;
    std::vector<Hit<T>> all, in_pieces;

    friend bool operator==(const PlacedRayAnswer&, const PlacedRayAnswer&) = default;
};
template <class Index, class T>
PlacedRayAnswer<T> placed_answer(const Index& index, const Ray<T, 3>& ray) {
    PlacedRayAnswer<T> said{closest_hit(index, ray), any_hit(index, ray), {}, {}};
    all_hits(index, ray, said.all);
    // The first hits, and those after them.
    std::array<Hit<T>, 3> piece;
    AfterHit after;
    std::size_t n = piece.size();
    while (n == piece.size()) {
        n = first_hits(index, ray, piece, {.after = after});
        said.in_pieces.insert(said.in_pieces.end(), piece.begin(),
                              piece.begin() + static_cast<std::ptrdiff_t>(n));
        after = piece.back();
    }
    return said;
}
template <class Index, class T>
std::vector<Near<T, 3>> placed_answer(const Index& index, const Vec<T, 3>& point) {
    std::vector<Near<T, 3>> said;
    nearest(index, point, 4, said);
    if (const auto closest = closest_point(index, point)) said.push_back(closest);
    return said;
}
template <class Index, class T>
std::vector<PlacedId> placed_answer(const Index& index, const Box<T, 3>& box) {
    std::vector<PlacedId> said;
    overlapping(index, box, said);
    return said;
}

/// A mesh in an index of structure `Inner`, and instances of it in an index of structure `Outer`.
template <template <class, int> class Outer, template <class, int> class Inner, class T>
class TwoLevels {
public:
    TwoLevels(const std::vector<Triangle<T, 3>>& shapes, const std::vector<Transform<3>>& places)
        : mesh_(set_of(shapes)),
          inner_(build<Inner>(mesh_)),
          set_(placed(inner_, places)),
          outer_(build<Outer>(set_)) {}

    template <class Question>
    auto answer(const Question& question) const {
        return placed_answer(outer_, question);
    }
    std::string validate() const { return outer_.validate(); }

private:
    using InnerIndex = IndexOf<Inner, TriangleMesh<T>>;
    using Set = InstanceSet<InnerIndex>;

    static Set placed(const InnerIndex& inner, const std::vector<Transform<3>>& places) {
        std::vector<Instance<InnerIndex>> instances;
        for (const auto& place : places) instances.emplace_back(inner, place);
        return Set(instances);
    }

    TriangleMesh<T> mesh_;
    InnerIndex inner_;
    Set set_;
    IndexOf<Outer, Set> outer_;
};

/// Whether an index of instances is valid and answers a query like brute force over brute force.
template <template <class, int> class Outer, template <class, int> class Inner, class T, class Question>
bool placed_as_brute_force(const std::vector<Triangle<T, 3>>& shapes, const std::vector<Transform<3>>& places,
                           const Question& question) {
    const TwoLevels<Outer, Inner, T> levels(shapes, places);
    return levels.validate().empty() &&
           levels.answer(question) == TwoLevels<BruteForce, BruteForce, T>(shapes, places).answer(question);
}

}  // namespace hedgerow::hunter
