/// hedgerow info: the contents of a scene, and its faults.
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>
#include <hedgerow/io/scene_size.h>
#include <hedgerow/parallel/sort.h>
#include <hedgerow/predicted_memory.h>
#include <hedgerow/primitives/boundary.h>

#include "check.h"
#include "verbs.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

/// Calls f(i) for each element in order, and reports progress to `executor`, which may throw Cancelled.
template <class F>
void for_each_element(std::size_t count, Executor& executor, F f) {
    executor.expect(count);
    for (std::size_t i = 0; i < count; ++i) {
        if (i % worth_a_task == worth_a_task - 1) executor.advance(worth_a_task);
        f(i);
    }
}

template <class P>
ordered_json extent_of(const P& set, Executor& executor) {
    Box<typename P::Scalar, P::dimension> box;
    for_each_element(set.size(), executor, [&](std::size_t i) { box.expand(view_of(set).bounds(i)); });
    ordered_json low, high;
    for (int k = 0; k < P::dimension; ++k)
        low.push_back(shortest(box.low[k])), high.push_back(shortest(box.high[k]));
    return {{"low", low}, {"high", high}};
}

/// Counts the edges of an odd number of triangles (`open`) and of more than two (`crowded`), by positions as
/// --check and insides do. Sides without length are left out.
struct EdgeFaults {
    std::size_t open = 0, crowded = 0;

    template <class T>
    EdgeFaults(const TriangleMeshView<T>& mesh, Executor& executor) {
        for_each_edge(mesh, executor, [&](const auto& sides) {
            if (sides[0].points[0] == sides[0].points[1]) return;
            open += sides.size() % 2, crowded += sides.size() > 2;
        });
    }
};

template <class T>
ordered_json facts(const TriangleMesh<T>& mesh, Executor& executor) {
    std::vector<bool> used(mesh.vertices.size());
    std::size_t flat = 0;
    for_each_element(mesh.size(), executor, [&](std::size_t i) {
        for (const auto corner : mesh.triangles[i]) used[corner] = true;
        flat += length2(Vec3d(mesh.view().normal(i))) == 0;
    });
    const EdgeFaults edges(mesh.view(), executor);
    return {{"kind", "triangles"},
            {"triangles", mesh.size()},
            {"vertices", mesh.vertices.size()},
            {"zero_area_triangles", flat},
            {"unused_vertices", std::count(used.begin(), used.end(), false)},
            {"open_edges", edges.open},
            {"non_manifold_edges", edges.crowded},
            {"closed", edges.open == 0}};
}
template <class T, int D>
ordered_json facts(const SphereSet<T, D>& s, Executor&) {
    return {{"kind", "spheres"}, {"spheres", s.size()}, {"dimension", D}};
}
template <class T, int D>
ordered_json facts(const PointCloud<T, D>& s, Executor& executor) {
    auto sorted = s.points;
    const auto before = [](const auto& a, const auto& b) {
        return std::lexicographical_compare(a.data, a.data + D, b.data, b.data + D);
    };
    sort_watched(sorted.begin(), sorted.end(), executor, before);
    const auto distinct = std::unique(sorted.begin(), sorted.end()) - sorted.begin();
    return {{"kind", "points"},
            {"points", s.size()},
            {"dimension", D},
            {"coincident_points", s.size() - static_cast<std::size_t>(distinct)}};
}
template <class T>
ordered_json facts(const SegmentSet<T>& s, Executor&) {
    return {{"kind", "segments"}, {"segments", s.size()}, {"dimension", 2}};
}

/// What is in a scene, and between what coordinates.
template <class T>
ordered_json facts_of_scene(const Common& c, const Scene<T>& scene) {
    ProgressLine line("looking at " + c.scene, c.quiet);
    WatchedExecutor watched(serial_executor(), line.progress());
    return std::visit(
        [&](const auto& set) {
            auto j = facts(set, watched);
            j.update(extent_of(set, watched));
            return j;
        },
        scene);
}

/// The facts about a saved index that its mesh does not show.
ordered_json facts_of_index(const std::string& path) {
    constexpr const char* builders[] = {"fast", "medium", "high"};
    const IndexFileInfo file = index_file_info(path);
    return {{"format_version", file.version},
            {"precision", file.scalar},
            {"face_ids", file.faces},
            {"builder", builders[static_cast<int>(file.options.builder)]},
            {"width", file.options.width},
            {"max_leaf_size", file.options.max_leaf_size},
            {"nodes", file.nodes},
            {"leaves", file.leaves},
            {"depth", file.depth},
            {"index_bytes", file.index_bytes},
            {"file_bytes", file.file_bytes}};
}

struct InfoArguments : Common {
    std::string structure = "wide";
    bool check = false, memory = false;
};

/// What a structure over a scene will take in memory, as predicted from the number of primitives.
ordered_json predicted(const InfoArguments& a, const SceneSize& size) {
    const bool in_double = precision_of(a) == "double";
    const PredictedMemory memory = predicted_memory(a.structure, size.kind, size.count, in_double);
    const double scene = size.bytes(in_double ? sizeof(double) : sizeof(float));
    const auto whole = [](double bytes) { return static_cast<std::uint64_t>(bytes); };
    return {
        {"structure", a.structure},
        {"scene_bytes", whole(scene)},
        {"predicted_index_bytes", whole(memory.index)},
        {"predicted_bytes_each", memory.index / static_cast<double>(std::max<std::uint64_t>(1, size.count))},
        {"predicted_build_peak", whole(scene + memory.build_peak)}};
}

void print_facts(const ordered_json& facts) {
    for (const auto& [key, value] : facts.items()) fmt::print("{:22} {}\n", key, value.dump());
}

/// Prints what a scene and an index over it take, by the scene's name or its file's header. Returns false,
/// and prints nothing, if neither says how many primitives there are.
bool print_memory(const InfoArguments& a) {
    const std::optional<SceneSize> size = known_size(a);
    if (!size) return false;
    ordered_json all = {
        {"kind", size->kind}, {std::string(size->kind), size->count}, {"dimension", size->dimension}};
    all.update(predicted(a, *size));
    a.json ? print_json(all) : print_facts(all);
    return true;
}

template <class T>
int print_info(const InfoArguments& a) {
    const Scene<T> scene = load<T>(a);
    const auto* const mesh = std::get_if<TriangleMesh<T>>(&scene);
    if (a.check && mesh == nullptr)
        throw InputError(a.scene + " has no triangles, of which --check finds the faults");
    ordered_json all = facts_of_scene(a, scene);
    if (names_index_file(a.scene)) all.update(facts_of_index(a.scene));
    all.update(predicted(a, size_of(scene)));
    MeshFaults faults;
    if (a.check) faults = faults_of(a, *mesh);
    if (a.json) {
        if (a.check) all["check"] = faults.facts;
        print_json(all);
    } else {
        print_facts(all);
        if (a.check) fmt::print("\n"), print_faults(faults);
    }
    return 0;
}

}  // namespace

Run add_info(CLI::App& verb) {
    auto a = std::make_shared<InfoArguments>();
    add_common(verb, *a, false);
    verb.add_flag("--check", a->check,
                  "look for the faults of a mesh: holes, edges and parts turned the wrong way, triangles "
                  "without area, twice or intersecting. The exit code is 0 with faults, too");
    verb.add_option("--structure", a->structure, "NAME[:OPTION=VALUE,...], whose memory is predicted")
        ->capture_default_str();
    verb.add_flag(
        "--memory", a->memory,
        "only predict the memory, without reading more of a PLY, NumPy, binary STL or .hedgerow file "
        "than its header, or generating a scene");
    return [a] {
        if (a->check && a->memory) throw UsageError("--check reads the whole scene: leave out --memory");
        predicted_memory(a->structure, "points", 0, false);  // refuse unknown structures before any work
        if (a->memory && print_memory(*a)) return 0;
        return in_precision(*a, [&]<class T>(T) { return print_info<T>(*a); });
    };
}

}  // namespace hedgerow::cli
