/// hedgerow generate and hedgerow convert: scenes into files.
#include <fmt/format.h>

#include <hedgerow/error.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/writable.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

template <class T>
void save(const Common& c, const TriangleMesh<T>& mesh, const Progress& progress) {
    save_mesh(c.output, mesh, progress);
}
template <class T, int D>
void save(const Common& c, const PointCloud<T, D>& cloud, const Progress& progress) {
    save_points(c.output, cloud, progress);
}
template <class Other>
void save(const Common& c, const Other&, const Progress&) {
    throw InputError(c.scene + ": no file format here holds these primitives");
}

int save_scene(const Common& c) {
    check_writable(c.output);
    return in_precision(c, [&]<class T>(T) {
        const Scene<T> scene = load<T>(c);
        {
            ProgressLine line("saving " + c.output, c.quiet, "elements");
            std::visit([&](const auto& set) { save(c, set, line.progress()); }, scene);
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
    add_common(verb, *c, true);
    return [c] { return save_scene(*c); };
}

}  // namespace hedgerow::cli
