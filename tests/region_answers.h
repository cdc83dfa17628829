/// What every structure answers about a region, against brute force, which is held to an oracle.
#pragma once

#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>

#include "every_structure.h"
#include "exact.h"
#include "rational_triangles.h"

namespace hedgerow {

/// What an oracle says. Where the library's answer may err by its documented tolerance, the oracle says
/// either.
enum class Said { no, either, yes };
inline Said exactly(bool b) {
    return b ? Said::yes : Said::no;
}

/// Holds the tests of the set's primitives to the oracle: `oracle(i, finds)`.
template <class P, class R, class Oracle>
void expect_right(const P& set, const R& region, Oracle oracle) {
    const auto view = set.view();
    for (std::size_t i = 0; i < set.size(); ++i) {
        const bool overlaps = view.overlaps(i, region), lies_in = view.lies_within(i, region);
        EXPECT_TRUE(overlaps || !lies_in) << "primitive " << i;
        const Said overlap = oracle(i, Finds::overlapping), inside = oracle(i, Finds::contained);
        if (overlap != Said::either) {
            EXPECT_EQ(overlaps, overlap == Said::yes) << "overlap of primitive " << i;
        }
        if (inside != Said::either) {
            EXPECT_EQ(lies_in, inside == Said::yes) << "primitive " << i << " in the region";
        }
    }
}

/// The primitives that overlap a region and those that lie in it, one by one.
template <class P, class R>
struct Answers {
    std::vector<PrimitiveId> overlapping, contained;

    Answers(const P& set, const R& region) {
        for (PrimitiveId i = 0; i < set.size() && !is_empty(region); ++i) {
            if (set.view().overlaps(i, region)) overlapping.push_back(i);
            if (set.view().lies_within(i, region)) contained.push_back(i);
        }
    }
};

/// Compares an index's answers about regions, alone and in batches, with those found one by one.
template <class I, class P, class R>
void expect_answers_of(const I& index, const std::vector<R>& regions,
                       const std::vector<Answers<P, R>>& want) {
    const auto lists = overlapping(index, regions, {.threads = serial_executor()});
    const auto inner = contained(index, regions, {.threads = serial_executor()});
    std::vector<std::size_t> counts(regions.size());
    const auto any = std::make_unique<bool[]>(regions.size());
    overlap_counts(index, regions, counts, {.threads = serial_executor()});
    any_overlaps(index, regions, {any.get(), regions.size()}, {.threads = serial_executor()});
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const auto list = [](std::span<const PrimitiveId> s) {
            return std::vector<PrimitiveId>(s.begin(), s.end());
        };
        ASSERT_EQ(list(lists[i]), want[i].overlapping) << "overlapping region " << i;
        ASSERT_EQ(list(inner[i]), want[i].contained) << "in region " << i;
        ASSERT_EQ(counts[i], want[i].overlapping.size()) << "region " << i;
        ASSERT_EQ(any[i], !want[i].overlapping.empty()) << "region " << i;
    }
}
template <std::floating_point T, int D, class P, class R>
void expect_answers_of_any(const AnyIndex<T, D>& index, const std::vector<R>& regions,
                           const std::vector<Answers<P, R>>& want) {
    std::vector<PrimitiveId> found;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        overlapping(index, regions[i], found);
        ASSERT_EQ(found, want[i].overlapping) << "overlapping region " << i;
        contained(index, regions[i], found);
        ASSERT_EQ(found, want[i].contained) << "in region " << i;
        ASSERT_EQ(overlap_count(index, regions[i]), want[i].overlapping.size()) << "region " << i;
        ASSERT_EQ(any_overlap(index, regions[i]), !want[i].overlapping.empty()) << "region " << i;
    }
}
/// Compares every structure's answers with those found one by one: by its own type an index for each way to
/// walk, the others through an AnyIndex. Returns how many answers there are, of both kinds.
template <class P, class R>
std::array<std::size_t, 2> expect_answers(const P& set, const std::vector<R>& regions) {
    std::vector<Answers<P, R>> want;
    std::array<std::size_t, 2> all{};
    for (const R& region : regions) {
        want.emplace_back(set, region);
        all[0] += want.back().overlapping.size(), all[1] += want.back().contained.size();
    }
    const auto of = [&](const char* name, const auto& index) {
        SCOPED_TRACE(name);
        expect_answers_of(index, regions, want);
    };
    if constexpr (P::dimension == 2 && requires { set.spheres; }) {  // of which there is no AnyIndex
        for_each_index(set, of);
    } else {
        of("wide", build<WideBvh>(set));
        BvhOptions splits;
        splits.builder = BvhBuilder::spatial_splits;
        of("spatial splits", build<Bvh>(set, splits));
        of("kd-tree", build<KdTree>(set));
        of("octree", build<Orthtree>(set));
        of("grid", build<Grid>(set));
        std::vector<const char*> others = {"brute-force",
                                           "wide:builder=fast,width=4",
                                           "bvh",
                                           "bvh:builder=lbvh,max_leaf_size=1",
                                           "bvh:volume=sphere",
                                           "bsp",
                                           "two-level-grid"};
        if constexpr (PointSet<ViewOf<P>>) {
            others.insert(others.end(), {"point-kdtree", "hash-grid"});
            others.push_back(P::dimension == 3 ? "point-octree" : "point-quadtree");
        }
        for (const char* name : others) {
            SCOPED_TRACE(name);
            expect_answers_of_any(*build_any(name, set), regions, want);
        }
    }
    return all;
}

}  // namespace hedgerow
