/// hedgerow generate and hedgerow convert: write scenes to files.
#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/writable.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

template <class T>
void save_scene(const Common& c, const TriangleMesh<T>& mesh, const Progress& progress) {
    RoundingReport report;
    save_mesh(c.output, mesh, progress, &report);
    if (report.loses_detail)
        fmt::print(stderr,
                   "hedgerow: {}: its floats move coordinates by up to {:.2g}, which matters. .ply, .obj and "
                   ".off keep them\n",
                   c.output, report.rounding);
}
template <class T, int D>
void save_scene(const Common& c, const PointCloud<T, D>& cloud, const Progress& progress) {
    save_points(c.output, cloud, progress);
}
template <class Other>
void save_scene(const Common& c, const Other&, const Progress&) {
    throw InputError(c.scene + ": no file format here holds these primitives");
}

constexpr std::string_view mesh_endings[] = {".ply", ".stl", ".obj", ".off"};
constexpr std::string_view point_endings[] = {".ply", ".npy", ".csv", ".xyz"};

/// Throws UsageError, before a scene is read or generated, if the extension of the output names no format, or
/// a format that cannot hold the scene's primitives.
void check_format(const Common& c) {
    std::string_view yields;  // empty for a file: not known before it is read
    for (const SceneInfo& info : scene_list())
        if (info.name == generated_name(c)) yields = info.yields;
    const bool mesh = yields.empty() || yields == "triangles", points = yields.empty() || yields == "points";
    if (!mesh && !points) throw UsageError(fmt::format("{}: no file format here holds {}", c.scene, yields));
    // Accept an extension of a format that can hold the scene.
    const auto among = [&](std::span<const std::string_view> endings) {
        return std::find(endings.begin(), endings.end(), ending_of(c.output)) != endings.end();
    };
    if ((mesh && among(mesh_endings)) || (points && among(point_endings))) return;
    // Name the formats that can.
    std::string known;
    if (mesh) known += fmt::format(" Meshes are written as {}.", fmt::join(mesh_endings, " "));
    if (points) known += fmt::format(" Points are written as {}.", fmt::join(point_endings, " "));
    throw UsageError(fmt::format("{}: this ending names no format for {}.{}", c.output,
                                 yields.empty() ? "meshes or points" : yields, known));
}

int save_scene(const Common& c) {
    check_format(c);
    check_writable(c.output);
    return in_precision(c, [&]<class T>(T) {
        const Scene<T> scene = load<T>(c);
        {
            ProgressLine line("saving " + c.output, c.quiet, "elements");
            std::visit([&](const auto& set) { save_scene(c, set, line.progress()); }, scene);
        }
        if (c.json)
            print_json({{"output", c.output}});
        else if (!c.quiet)
            fmt::print("{}\n", c.output);
        return 0;
    });
}

}  // namespace

Run add_generate(CLI::App& verb) {
    auto c = std::make_shared<Common>();
    add_common(verb, *c, true);
    return [c] {
        if (!c->scene.starts_with("gen:"))
            throw UsageError(c->scene + ": only a gen: scene can be generated, as gen:terrain:200000. " +
                             "'hedgerow convert' takes files");
        return save_scene(*c);
    };
}

Run add_convert(CLI::App& verb) {
    auto c = std::make_shared<Common>();
    c->precision = "double";  // files of doubles keep their digits
    add_common(verb, *c, true);
    return [c] { return save_scene(*c); };
}

}  // namespace hedgerow::cli
