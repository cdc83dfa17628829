/// hedgerow generate: writes a generated scene.
#include <fmt/format.h>

#include <hedgerow/error.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

template <class T>
void save(const Common& c, const TriangleMesh<T>& mesh) {
    save_mesh(c.output, mesh);
}
template <class T, int D>
void save(const Common& c, const PointCloud<T, D>& cloud) {
    save_points(c.output, cloud);
}
template <class Other>
void save(const Common& c, const Other&) {
    throw InputError(c.scene + ": no file format here holds these primitives");
}

}  // namespace

Run add_generate(CLI::App& verb) {
    auto c = std::make_shared<Common>();
    add_common(verb, *c, true);
    return [c] {
        if (!c->scene.starts_with("gen:"))
            throw InputError(c->scene + ": only a gen: scene can be generated, as gen:terrain:200000");
        check_writable(c->output);
        return in_precision(*c, [&]<class T>(T) {
            std::visit([&](const auto& set) { save(*c, set); }, load<T>(*c));
            if (c->json)
                fmt::print("{{\"output\": \"{}\"}}\n", c->output);
            else if (!c->quiet)
                fmt::print("{}\n", c->output);
            return 0;
        });
    };
}

}  // namespace hedgerow::cli
