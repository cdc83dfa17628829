/// Bytes a primitive of every structure, measured over generated scenes.
#include <hedgerow/predicted_memory.h>

#include <algorithm>
#include <string>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

#include "structures.h"

namespace hedgerow {

namespace {

/// Bytes a primitive: of the index in float and in double, and at the build's peak in float and in double.
struct Bytes {
    double index, index_in_double, peak, peak_in_double;
};
constexpr Bytes never{};  // a kind that the structure does not hold

/// The figures of a structure. `builder` is that of a `wide`, else empty.
struct Row {
    std::string_view structure, builder;
    Bytes triangles, points, spheres, segments;
};

/// The geometric mean of the smallest and the largest figure among the generated scenes of each kind, of
/// 3,000 to 200,000 primitives. What is the same for all scenes follows from the arrays of the build: that of
/// a `wide` over triangles of float has a reference of 32 bytes and two nodes of 40.
constexpr Row rows[] = {
    {"brute-force", "", {44.4, 84.4, 44.4, 84.4}, {4.4, 4.4, 39, 71}, {4.4, 4.4, 39, 71}, {4.4, 4.4, 39, 71}},
    {"grid", "", {65, 106, 140, 165}, {7.7, 7.7, 38, 38}, {49, 49, 260, 260}, {19.4, 19.4, 83, 83}},
    {"two-level-grid", "", {99, 148, 104, 150}, {25, 28, 43, 47}, {70, 73, 122, 125}, {34, 37, 66, 69}},
    {"hash-grid", "", never, {11.5, 11.5, 19, 19}, never, never},
    {"kdtree", "", {118, 225, 220, 410}, {6.2, 8.1, 180, 330}, {10.5, 13.8, 205, 395}, {6.1, 8, 170, 335}},
    {"point-kdtree", "", never, {8, 12, 40, 76}, never, never},
    {"point-octree", "", never, {13, 13, 30, 30}, never, never},
    {"octree",
     "",
     {80, 121, 92, 135},
     {7.5, 7.5, 14.5, 14.5},
     {33.5, 33.5, 65, 65},
     {10.1, 10.1, 19.5, 19.5}},
    {"bsp", "", {104, 201, 297, 327}, {9.8, 13.4, 370, 400}, {16.6, 23.1, 515, 537}, {9, 12, 190, 215}},
    {"bvh", "", {68, 127, 118, 200}, {37, 59, 110, 180}, {30, 49.5, 118, 200}, {20, 30.4, 102, 166}},
    {"wide", "medium", {58, 108, 120, 202}, {24, 38, 24, 48}, {15.8, 23, 120, 200}, {12.4, 17.1, 104, 168}},
    {"wide", "fast", {74, 137, 128, 210}, {43, 68, 120, 195}, {15.8, 23.2, 128, 208}, {12.7, 17.5, 112, 176}},
    {"wide", "high", {58, 108, 120, 202}, {70, 112, 135, 210}, {15.8, 23, 120, 200}, {12.4, 17.1, 104, 168}},
};

/// The builder that the options of a `wide` name: "medium" if none.
std::string_view builder_in(std::string_view options) {
    constexpr std::string_view key = "builder=";
    const auto at = options.find(key);
    if (at == options.npos) return "medium";
    options.remove_prefix(at + key.size());
    return options.substr(0, options.find(','));
}

/// Throws UsageError if no structure has the name, with the nearest that there is.
void expect_known(std::string_view name) {
    std::vector<std::string_view> names;
    std::string list;
    for (const StructureInfo& s : structure_list()) {
        if (s.name == name) return;
        names.push_back(s.name);
        list += (list.empty() ? "" : ", ") + std::string(s.name);
    }
    throw UsageError("no structure is called '" + std::string(name) + "'" + suggestion(name, names) +
                     "; there are " + list);
}

}  // namespace

PredictedMemory predicted_memory(std::string_view structure, std::string_view kind, std::uint64_t count,
                                 bool in_double) {
    // Find the structure's row.
    const auto colon = structure.find(':');
    const std::string_view name = structure.substr(0, colon);
    expect_known(name);
    const std::string_view options = colon == structure.npos ? "" : structure.substr(colon + 1);
    const std::string_view builder = name == "wide" ? builder_in(options) : "";
    const std::string_view in_space = detail::name_in<3>(name);  // a structure has one row
    const auto row = std::find_if(std::begin(rows), std::end(rows), [&](const Row& r) {
        return r.structure == in_space && r.builder == builder;
    });
    if (row == std::end(rows))
        throw UsageError("the memory of '" + std::string(structure) + "' is not known: name a builder that " +
                         std::string(name) + " has");
    // Multiply its figures.
    const Bytes& bytes = kind == "triangles" ? row->triangles
                         : kind == "points"  ? row->points
                         : kind == "spheres" ? row->spheres
                                             : row->segments;
    if (bytes.index == 0)
        throw UsageError("'" + std::string(name) + "' holds points alone, not " + std::string(kind));
    const auto n = static_cast<double>(count);
    if (in_double) return {n * bytes.index_in_double, n * bytes.peak_in_double};
    return {n * bytes.index, n * bytes.peak};
}

}  // namespace hedgerow
