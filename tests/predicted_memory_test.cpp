/// Holds predictions of memory against what builds take. This is a program of its own because it counts all
/// its allocations.
#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/predicted_memory.h>
#include <hedgerow/scenes/generate.h>

#include "counted_memory.h"

using namespace hedgerow;

namespace {

std::string_view kind_of(const std::string& scene) {
    for (const SceneInfo& info : scene_list())
        if (scene.starts_with("gen:" + std::string(info.name) + ":")) return info.yields;
    return "";
}

void expect_within(double factor, double predicted, double measured, const std::string& what) {
    EXPECT_LE(predicted, factor * measured) << what;
    EXPECT_GE(predicted * factor, measured) << what;
}

/// Builds a structure over a scene, and compares what it takes with what was predicted.
template <class P>
void expect_predicted(const std::string& scene, const P& set, const std::string& structure) {
    constexpr bool in_double = std::is_same_v<typename P::Scalar, double>;
    const bool as_usual = structure == "wide";
    const std::string what = scene + " " + structure + (in_double ? " double" : " float");
    const PredictedMemory predicted = predicted_memory(structure, kind_of(scene), set.size(), in_double);
    double bytes = 0, peak = 0;
#ifdef HEDGEROW_SANITIZED
    bytes = static_cast<double>(build_any(structure, set, serial_executor())->bytes());
    peak = predicted.build_peak;
#else
    const std::size_t most = most_bytes_of(
        [&] { bytes = static_cast<double>(build_any(structure, set, serial_executor())->bytes()); });
    peak = static_cast<double>(most);
#endif
    expect_within(as_usual ? 1.3 : 2, predicted.index, bytes, what + ": index");
    expect_within(as_usual ? 1.3 : 2.5, predicted.build_peak, peak, what + ": peak");
}

template <class T>
void expect_all_predicted(const std::string& name) {
    const Scene<T> scene = generate<T>(parse_scene_spec(name));
    std::visit(
        [&]<class P>(const P& set) {
            for (const StructureInfo& s : structure_list()) {
                if (!s.holds(P::dimension, PointSet<ViewOf<P>>)) continue;
                expect_predicted(name, set, std::string(s.name));
            }
            expect_predicted(name, set, "wide:builder=fast");
            expect_predicted(name, set, "wide:builder=high,width=8");
        },
        scene);
}

TEST(PredictedMemory, IsWithinTheStatedFactorOfTheMeasured) {
    for (const char* const scene :
         {"gen:soup:5000", "gen:interior:30000", "gen:boulder:5000", "gen:hairball:30000", "gen:grass:5000",
          "gen:points:5000", "gen:points:100000", "gen:clusters2d:5000", "gen:spheres:5000",
          "gen:segments2d:5000", "gen:segments2d:50000"}) {
        expect_all_predicted<float>(scene);
        expect_all_predicted<double>(scene);
    }
}

TEST(PredictedMemory, GrowsWithTheNumberAndWithThePrecision) {
    for (const StructureInfo& s : structure_list())
        for (const char* const kind : {"triangles", "points", "spheres", "segments"}) {
            if (!s.holds(s.name == "quadtree" ? 2 : 3, std::string_view(kind) == "points")) continue;
            const auto one = predicted_memory(s.name, kind, 1000, false);
            const auto ten = predicted_memory(s.name, kind, 10000, false);
            EXPECT_DOUBLE_EQ(ten.index, 10 * one.index);
            EXPECT_DOUBLE_EQ(ten.build_peak, 10 * one.build_peak);
            EXPECT_GE(one.build_peak, one.index) << s.name;
            EXPECT_GE(predicted_memory(s.name, kind, 1000, true).index, one.index) << s.name;
            EXPECT_EQ(predicted_memory(s.name, kind, 0, true).index, 0) << s.name;
        }
}

TEST(PredictedMemory, RefusesWhatCannotBeBuilt) {
    EXPECT_THROW(predicted_memory("wid", "points", 1, false), UsageError);
    EXPECT_THROW(predicted_memory("", "points", 1, false), UsageError);
    EXPECT_THROW(predicted_memory("wide:builder=best", "points", 1, false), UsageError);
    EXPECT_THROW(predicted_memory("point-kdtree", "triangles", 1, false), UsageError);
    EXPECT_THROW(predicted_memory("hash-grid", "spheres", 1, false), UsageError);
}

}  // namespace
