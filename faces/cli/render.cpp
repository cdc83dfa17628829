/// hedgerow render: renders a picture by casting rays.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>
#include <hedgerow/render/raycast.h>

#include "kernel_use.h"
#include "verbs.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

struct RenderArguments : Common {
    std::string structure = "wide", shading = "diffuse";
    ViewArguments view;
    int spp = 1;
    unsigned threads = 0;
    std::uint64_t steps_max = 0;
    bool counts = false, layers = false;  // layers: whether the output is .exr
};

struct Outcome {
    Picture picture;
    std::size_t primitives = 0, bytes = 0;
    Upright upright{2, ""};
    Vec3f up;
    FinishedPicture finished;
    bool loaded = false;   // the index was loaded, not built
    bool counted = false;  // visits of rays were counted
    double build_seconds = 0, seconds = 0;
};

constexpr const char* layers_help =
    "Layers of an .exr file, of a pixel's first ray or the mean of its --spp rays:\n"
    "  R G B                    linear light, or the count that --shading steps shows; mean\n"
    "  depth.Z                  distance along the first ray; infinity where nothing is hit\n"
    "  normal.X .Y .Z           there, on the eye's side; 0 where nothing is hit\n"
    "  id                       the primitive's number there; 4294967295 where nothing is hit\n"
    "  nodes leaves primitives  looked at to find the hit; mean\n\n";

void report(const RenderArguments& a, const Outcome& o) {
    const Picture& p = o.picture;
    const double rays = double(std::max<std::uint64_t>(p.rays, 1));
    const auto a_ray = [&](std::uint64_t count) { return double(count) / rays; };
    if (a.json) {
        nlohmann::ordered_json j = {{"structure", a.structure},
                                    {"output", o.finished.output},
                                    {"width", p.image.width},
                                    {"height", p.image.height},
                                    {"primitives", o.primitives},
                                    {"bytes", o.bytes},
                                    {o.loaded ? "load_seconds" : "build_seconds", o.build_seconds},
                                    {"up", {o.up[0], o.up[1], o.up[2]}},
                                    {"rays", p.rays},
                                    {"rays_by", rays_by(p.use)},
                                    {"seconds", o.seconds},
                                    {"rays_per_second", rays / o.seconds},
                                    {"finished", o.finished.whole}};
        if (o.counted) {
            j["nodes_per_ray"] = a_ray(p.visits.nodes);
            j["leaves_per_ray"] = a_ray(p.visits.leaves);
            j["primitives_per_ray"] = a_ray(p.visits.primitives);
        }
        print_json(j);
    } else if (!a.quiet) {
        fmt::print("{}: {}x{}, {} primitives, {} {} in {:.1f} ms, {:.1f} bytes a primitive\n",
                   o.finished.output, p.image.width, p.image.height, o.primitives, a.structure,
                   o.loaded ? "loaded" : "built", o.build_seconds * 1e3,
                   double(o.bytes) / double(std::max<std::size_t>(1, o.primitives)));
        fmt::print("{} rays in {:.3f} s: {:.3f} million a second", p.rays, o.seconds,
                   rays / o.seconds * 1e-6);
        if (p.use.packets + p.use.phased > 0) fmt::print("; {}", most_used(p.use, p.rays));
        if (o.counted)
            fmt::print("; a ray visits {:.1f} nodes, {:.1f} leaves, {:.1f} primitives", a_ray(p.visits.nodes),
                       a_ray(p.visits.leaves), a_ray(p.visits.primitives));
        fmt::print("\n{}", up_text(a.view, a, o.upright));
    }
}

/// Renders `primitives` by an index over them, saves the picture and reports. Returns the exit code.
template <class Any, class P>
int render(const RenderArguments& a, const Any& index, const P& primitives, Outcome o) {
    // Read the options, and place the camera by the bounds of the index.
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = a.spp, options.seed = a.seed, options.steps_max = a.steps_max;
    options.shading = parse_shading(a.shading);
    options.layers = a.layers, options.counts = a.counts;
    o.primitives = index.size(), o.bytes = index.bytes(), o.counted = options.counted();
    o.upright = upright_of(a.view, a, primitives);
    options.camera =
        camera_of(a.view, a, Box3f{Vec3f(index.bounds().low), Vec3f(index.bounds().high)}, o.upright);
    o.up = options.camera.up;
    // Render. After an interruption the finished rows are saved.
    {
        ProgressLine line("rendering", a.quiet, "rows");
        const double start = now();
        o.picture = raycast(index, primitives, options, default_executor(), line.progress());
        o.seconds = now() - start;
        o.finished = finish_picture(a.output, line.done(), options.height);
    }
    save(o.finished.output, o.picture);
    report(a, o);
    return o.finished.exit_code();
}
template <class P>
int render(const RenderArguments& a, const P& primitives) {
    const ThreadLimit limit(a.threads);
    Outcome o;
    const double start = now();
    const auto index = build_shown(a, a.structure, primitives);
    o.build_seconds = now() - start;
    return render(a, *index, primitives, std::move(o));
}
/// Renders by a saved index, which is loaded and not built.
template <class T>
int render_saved(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    Outcome o;
    const double start = now();
    auto saved = [&] {
        ProgressLine line("loading " + a.scene, a.quiet, "bytes");
        WatchedExecutor watched(default_executor(), line.progress());
        return load_index<T>(a.scene, {}, watched);
    }();
    const auto mesh = saved.primitives();
    const auto index = any_index(std::move(saved));
    o.loaded = true, o.build_seconds = now() - start;
    return render(a, *index, mesh, std::move(o));
}
template <class T>
int render(const RenderArguments& a, const PointCloud<T, 3>& cloud) {
    return render(a, spheres_at(cloud, a.view.radius));
}
template <class T>
int render(const RenderArguments& a, const PointCloud<T, 2>&) {
    throw InputError(a.scene + ": only what lies in space can be rendered, and this is flat");
}
template <class T>
int render(const RenderArguments& a, const SegmentSet<T>&) {
    throw InputError(a.scene + ": only what lies in space can be rendered, and this is flat");
}

}  // namespace

Run add_render(CLI::App& verb) {
    auto a = std::make_shared<RenderArguments>();
    add_common(verb, *a, true);
    verb.get_option("--output")->description("the file to write: .png, or .exr for layers of numbers");
    verb.footer(layers_help + verb.get_footer());
    verb.add_option("--structure", a->structure,
                    "NAME[:OPTION=VALUE,...]; of a .hedgerow file 'wide' is the index as it was saved")
        ->capture_default_str();
    verb.add_option("--shading", a->shading, "normals, depth, diffuse or steps")
        ->capture_default_str()
        ->check(CLI::IsMember({"normals", "depth", "diffuse", "steps"}));
    verb.add_option("--spp", a->spp, "samples a pixel")->check(CLI::Range(1, 4096));
    verb.add_flag("--counts", a->counts,
                  "count what rays visit, without the engine's kernels; layers and steps are counts already");
    verb.add_option("--threads", a->threads, "that build and render; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    add_view(verb, a->view);
    verb.add_option("--steps-max", a->steps_max, "the top of the scale of --shading steps; 0: what was seen");
    return [a] {
        const bool saved = names_index_file(a->scene);
        a->layers = asks_for_layers(a->output);
        check_picture_memory(a->view.size, a->layers);
        check_writable(a->output);
        return in_precision(*a, [&]<class T>(T) {
            if (saved && a->structure == "wide" && !index_file_info(a->scene).holds_points)
                return render_saved<T>(*a);
            return std::visit([&](const auto& set) { return render(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
