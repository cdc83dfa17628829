/// hedgerow render: renders a picture, by casting rays or by rasterising.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>
#include <hedgerow/io/model_file.h>
#include <hedgerow/render/model_scene.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/render/visibility/rasterise_stream.h>
#include <hedgerow/scenes/looks.h>

#include "kernel_use.h"
#include "verbs.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

struct RenderArguments : Common {
    std::string structure = "wide", shading = "diffuse", visibility = "cast";
    ViewArguments view;
    int spp = 1;
    unsigned threads = 0;
    std::uint64_t steps_max = 0;
    int camera = -1;                      // of the file
    bool counts = false, layers = false;  // layers: whether the output is .exr

    bool rasterises() const { return visibility == "raster"; }
    bool uses_beams() const { return visibility == "beams"; }
    /// Whether the picture needs an index: for its rays from the eye, or those to the light.
    bool needs_index() const { return !rasterises() || is_lit(parse_shading(shading)); }
};

struct Outcome {
    Picture picture;
    std::size_t primitives = 0, bytes = 0;
    Upright upright{2, ""};
    Vec3f up;
    FinishedPicture finished;
    bool indexed = false, loaded = false;  // whether there is an index, and whether it was loaded, not built
    bool counted = false;                  // visits of rays were counted
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
    const PictureCosts& costs = p.costs;
    const double rays = double(std::max<std::uint64_t>(costs.rays, 1));
    const auto a_ray = [&](std::uint64_t count) { return double(count) / rays; };
    if (a.json) {
        nlohmann::ordered_json j = {{"structure", a.structure},
                                    {"visibility", a.visibility},
                                    {"output", o.finished.output},
                                    {"width", p.image.width},
                                    {"height", p.image.height},
                                    {"primitives", o.primitives},
                                    {"bytes", o.bytes},
                                    {o.loaded ? "load_seconds" : "build_seconds", o.build_seconds},
                                    {"up", {o.up[0], o.up[1], o.up[2]}},
                                    {"rays", costs.rays},
                                    {"rays_by", rays_by(costs.use)},
                                    {"seconds", o.seconds},
                                    {"rays_per_second", rays / o.seconds},
                                    {"finished", o.finished.whole}};
        if (o.counted) {
            j["nodes_per_ray"] = a_ray(costs.visits.nodes);
            j["leaves_per_ray"] = a_ray(costs.visits.leaves);
            j["primitives_per_ray"] = a_ray(costs.visits.primitives);
        }
        if (a.uses_beams()) {
            j["beams"] = costs.beams.beams;
            j["visits_of_beams"] = costs.beams.visits;
            j["samples_filled"] = costs.beams.filled;
        }
        if (a.rasterises()) {
            j["triangles_drawn"] = costs.drawn.triangles;
            j["triangles_outside"] = costs.drawn.outside;
        }
        print_json(j);
    } else if (!a.quiet) {
        fmt::print("{}: {}x{}, {} primitives", o.finished.output, p.image.width, p.image.height,
                   o.primitives);
        if (o.indexed)
            fmt::print(", {} {} in {:.1f} ms, {:.1f} bytes a primitive", a.structure,
                       o.loaded ? "loaded" : "built", o.build_seconds * 1e3,
                       double(o.bytes) / double(std::max<std::size_t>(1, o.primitives)));
        fmt::print("\n");
        if (costs.beams.beams > 0)
            fmt::print("{} beams, {:.0f}% of the samples without a packet; ", costs.beams.beams,
                       100 * double(costs.beams.filled) /
                           (double(p.image.width) * double(p.image.height) * double(a.spp)));
        if (a.rasterises())
            fmt::print("{} triangles drawn, {} of them outside of the picture; ", costs.drawn.triangles,
                       costs.drawn.outside);
        fmt::print("{} rays in {:.3f} s", costs.rays, o.seconds);
        if (costs.rays > 0) fmt::print(": {:.3f} million a second", rays / o.seconds * 1e-6);
        if (costs.use.packets + costs.use.phased > 0) fmt::print("; {}", most_used(costs.use, costs.rays));
        if (o.counted)
            fmt::print("; a ray visits {:.1f} nodes, {:.1f} leaves, {:.1f} primitives",
                       a_ray(costs.visits.nodes), a_ray(costs.visits.leaves), a_ray(costs.visits.primitives));
        fmt::print("\n{}", up_text(a.view, a, o.upright));
    }
}

/// The picture's options, with the camera placed by the bounds of the scene.
RenderOptions options_of(const RenderArguments& a, const Box3f& bounds, const Upright& upright) {
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = a.spp, options.seed = a.seed, options.scale.top = a.steps_max;
    options.shading = parse_shading(a.shading);
    options.layers = a.layers, options.counts = a.counts;
    options.camera = camera_of(a.view, a, bounds, upright);
    return options;
}
/// What finds the hits of the samples.
template <class T, class P>
std::unique_ptr<Visibility<T>> visibility_of(const RenderArguments& a, const P& primitives,
                                             const Tracer<T>* tracer) {
    if (!a.rasterises()) return std::make_unique<RayCasting<T>>(*tracer);
    if constexpr (std::same_as<ViewOf<P>, TriangleMeshView<T>>)
        return std::make_unique<Rasterising<T>>(view_of(primitives));
    else
        throw InputError(a.scene + ": only triangles can be rasterised; use --visibility cast");
}
/// Makes the picture, saves it and reports. After an interruption the finished rows are saved. Returns the
/// exit code.
template <class T>
int finish(const RenderArguments& a, const PictureParts<T>& parts, const RenderOptions& options, Outcome o,
           const Progress& progress) {
    o.counted = options.counted(), o.up = options.camera.up;
    const double start = now();
    o.picture = render(parts, options, default_executor(), progress);
    o.seconds = now() - start;
    o.finished = finish_picture(a.output, o.picture.pixels > 0, o.picture.whole);
    save(o.finished.output, o.picture);
    report(a, o);
    return o.finished.exit_code();
}
/// Renders `primitives` by an index over them, or by none. Returns the exit code.
template <class T, class P>
int render(const RenderArguments& a, const AnyIndex<T, 3>* index, const P& primitives, Outcome o) {
    const SurfacesOf<P> surfaces(primitives);
    std::optional<IndexTracer<AnyIndex<T, 3>>> tracer;
    if (index != nullptr) tracer.emplace(*index), o.bytes = index->bytes(), o.indexed = true;
    const Tracer<T>* const asked = tracer ? &*tracer : nullptr;
    o.primitives = primitives.size();
    o.upright = upright_of(a.view, a, primitives);
    const Box<T, 3> box = index != nullptr ? index->bounds() : surfaces.bounds();
    const RenderOptions options = options_of(a, Box3f{Vec3f(box.low), Vec3f(box.high)}, o.upright);
    const auto visibility = visibility_of<T>(a, primitives, asked);
    ProgressLine line("rendering", a.quiet, "rows");
    return finish(a, PictureParts<T>{*visibility, surfaces, asked}, options, std::move(o), line.progress());
}
/// Renders triangles by beams through the engine's index. Returns the exit code.
template <class T, class P>
int render_by_beams(const RenderArguments& a, const P& primitives) {
    if constexpr (!std::same_as<ViewOf<P>, TriangleMeshView<T>>) {
        throw InputError(a.scene + ": beams go through triangles alone; use --visibility cast");
    } else {
        Outcome o;
        const double start = now();
        const MeshIndex<T> index = [&] {
            ProgressLine line("building " + a.structure, a.quiet);
            WatchedExecutor watched(default_executor(), line.progress());
            return build<WideBvh>(primitives, {}, watched);
        }();
        o.build_seconds = now() - start;
        o.indexed = true, o.bytes = index.bytes(), o.primitives = primitives.size();
        o.upright = upright_of(a.view, a, primitives);
        const IndexTracer<MeshIndex<T>> tracer(index);
        const SurfacesOf<P> surfaces(primitives);
        BeamTracing<MeshIndex<T>> beams(index);
        const auto& box = index.bounds();
        const RenderOptions options = options_of(a, Box3f{Vec3f(box.low), Vec3f(box.high)}, o.upright);
        ProgressLine line("rendering", a.quiet, "rows");
        return finish(a, PictureParts<T>{beams, surfaces, &tracer}, options, std::move(o), line.progress());
    }
}
/// Renders the triangles of a file without loading them all.
template <class T>
int render_stream(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    Outcome o;
    ProgressLine line("reading " + a.scene, a.quiet, "bytes");
    const Progress progress = line.progress();
    const auto stream = stream_triangles<T>(a.scene, progress);
    RasterisingStream<T> rasterising(*stream);
    Box3f box;
    stream->for_each_part([&](const TriangleMesh<T>& part, std::uint32_t) {
        for (const auto& p : part.vertices) box.expand(Vec3f(p));
        o.primitives += part.size();
    });
    o.upright = a.view.up == "auto" ? upright_by_format(a.scene, {}) : Upright{a.view.up[0] - 'x', ""};
    const RenderOptions options = options_of(a, box, o.upright);
    return finish(a, PictureParts<T>{rasterising, rasterising}, options, std::move(o), {{}, progress.cancel});
}
/// Loads or generates a scene with its looks, and tells what of it is not shown.
template <class T>
Model<T> load_looks(const RenderArguments& a) {
    if (a.scene.starts_with("gen:")) {
        ProgressLine line("generating " + a.scene, a.quiet, "triangles");
        return generate_model<T>(parse_scene_spec(a.scene), line.progress());
    }
    Model<T> model = [&] {
        ProgressLine line("loading " + a.scene, a.quiet, "bytes");
        return load_model<T>(a.scene, {}, line.progress());
    }();
    if (a.quiet) return model;
    for (const std::string& warning : model.warnings) fmt::print(stderr, "hedgerow: warning: {}\n", warning);
    if (!model.not_shown.empty())
        fmt::print(stderr, "hedgerow: {}: not shown: {}\n", a.scene, fmt::join(model.not_shown, ", "));
    return model;
}
/// The camera of a file, turned into one of ours: it looks along its -z, with y up.
template <class T>
Camera camera_of(const RenderArguments& a, const Model<T>& model, const Camera& given) {
    if (a.camera < 0) return given;
    if (static_cast<std::size_t>(a.camera) >= model.cameras.size())
        throw UsageError(fmt::format("--camera {}: {} has {} cameras, counted from 0", a.camera, a.scene,
                                     model.cameras.size()));
    const FileCamera& from = model.cameras[static_cast<std::size_t>(a.camera)];
    Camera c = given;
    c.eye = Vec3f(from.to_world.point({}));
    c.target = c.eye + Vec3f(normalized(from.to_world.vector({0, 0, -1})));
    c.up = Vec3f(normalized(from.to_world.vector({0, 1, 0})));
    if (const auto* const view = std::get_if<PerspectiveView>(&from.view))
        c.projection = Projection::perspective,
        c.field_of_view = static_cast<float>(view->field_of_view * 180 / 3.14159265358979323846);
    else
        c.projection = Projection::orthographic,
        c.height = static_cast<float>(std::get<OrthographicView>(from.view).height);
    return c;
}
/// Renders a scene with its looks, by rays through an index of two levels, or by its triangles.
template <class T>
int render_looks(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    Outcome o;
    const Model<T> model = load_looks<T>(a);
    const double start = now();
    const ModelScene<T> scene(model, interruptible_executor());
    o.build_seconds = now() - start;
    o.indexed = true, o.bytes = scene.bytes(), o.primitives = model.triangles();
    o.upright = model.objects.size() == 1 || a.scene.starts_with("gen:")
                    ? upright_of(a.view, a, model.objects[0].mesh)
                : a.view.up != "auto" ? Upright{a.view.up[0] - 'x', ""}
                                      : upright_by_format(a.scene, {});
    const auto& box = scene.bounds();
    RenderOptions options = options_of(a, Box3f{Vec3f(box.low), Vec3f(box.high)}, o.upright);
    options.camera = camera_of(a, model, options.camera);
    const auto& looks = scene.appearances();
    std::unique_ptr<Visibility<T>> visibility;
    if (!a.rasterises())
        visibility = std::make_unique<RayCasting<T>>(
            scene.tracer(), looks.has_masks() ? [&](const Hit<T>& hit) { return looks.is_there(hit); }
                                              : std::function<bool(const Hit<T>&)>());
    else if (!looks.has_masks())
        visibility =
            std::make_unique<Rasterising<T, InstanceSetView<MeshIndex<T>>>>(scene.instances().view());
    else
        throw InputError(a.scene + ": has masks of opacity, which only rays see; use --visibility cast");
    ProgressLine line("rendering", a.quiet, "rows");
    return finish(a, PictureParts<T>{*visibility, scene.surfaces(), &scene.tracer(), &looks}, options,
                  std::move(o), line.progress());
}
template <class P>
int render(const RenderArguments& a, const P& primitives) {
    using T = typename P::Scalar;
    const ThreadLimit limit(a.threads);
    if (a.uses_beams()) return render_by_beams<T>(a, primitives);
    Outcome o;
    if (!a.needs_index()) return render<T>(a, nullptr, primitives, std::move(o));
    const double start = now();
    const auto index = build_shown(a, a.structure, primitives);
    o.build_seconds = now() - start;
    return render(a, index.get(), primitives, std::move(o));
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
    return render(a, index.get(), mesh, std::move(o));
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
    verb.add_option("--shading", a->shading,
                    "normals, depth, diffuse (grey), colour (materials and textures of the scene) or steps")
        ->capture_default_str()
        ->check(CLI::IsMember({"normals", "depth", "diffuse", "colour", "steps"}));
    verb.add_option(
            "--visibility", a->visibility,
            "how hits are found: cast rays, raster triangles, or beams of rays; the picture is the same")
        ->capture_default_str()
        ->check(CLI::IsMember({"cast", "raster", "beams"}));
    verb.add_option("--spp", a->spp, "samples a pixel")->check(CLI::Range(1, 4096));
    verb.add_flag("--counts", a->counts,
                  "count what rays visit, without the engine's kernels; layers and steps are counts already");
    verb.add_option("--threads", a->threads, "that build and render; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    add_view(verb, a->view);
    add_projection(verb, a->view);
    verb.add_option("--camera", a->camera, "of --shading colour: a camera of the file, counted from 0")
        ->check(CLI::NonNegativeNumber);
    verb.add_option("--steps-max", a->steps_max, "the top of the scale of --shading steps; 0: what was seen");
    return [a] {
        const bool saved = names_index_file(a->scene);
        a->layers = asks_for_layers(a->output);
        if (a->visibility != "cast" && counted(parse_shading(a->shading)))
            throw UsageError("--shading " + a->shading + " shows what rays cost: it needs --visibility cast");
        if (a->uses_beams() && a->structure != "wide")
            throw UsageError("--structure " + a->structure + ": beams go through 'wide' alone");
        check_picture_memory(a->view.size, a->layers);
        check_writable(a->output);
        const bool by_looks = parse_shading(a->shading) == Shading::colour;
        if (by_looks && (a->uses_beams() || a->structure != "wide"))
            throw UsageError(
                "--shading colour casts rays at 'wide' or rasters: leave out --structure and beams");
        if (a->camera >= 0 && !by_looks)
            throw UsageError("--camera is of files with looks: it needs --shading colour");
        return in_precision(*a, [&]<class T>(T) {
            if (by_looks) return render_looks<T>(*a);
            if (saved && a->structure == "wide" && !a->uses_beams() &&
                !index_file_info(a->scene).holds_points)
                return render_saved<T>(*a);
            if (!a->needs_index() && !a->drop_bad && !a->scene.starts_with("gen:") && can_stream(a->scene))
                return render_stream<T>(*a);
            return std::visit([&](const auto& set) { return render(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
