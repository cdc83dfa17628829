/// hedgerow render: renders a picture, by casting rays or by rasterising.
#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>
#include <hedgerow/render/film/tone.h>
#include <hedgerow/render/sampling/path_samples.h>
#include <hedgerow/render/sampling/pixel_filter.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/render/visibility/rasterise_stream.h>

#include "render_looks.h"
#include "saved_rays.h"
#include "verbs.h"

namespace hedgerow::cli {

namespace {

constexpr const char* layers_help =
    "Layers of an .exr file, of a pixel's first ray or the mean of its --spp rays:\n"
    "  R G B                    linear light, or the count that --shading steps shows; mean\n"
    "  depth.Z                  distance along the first ray; infinity where nothing is hit\n"
    "  normal.X .Y .Z           there, on the eye's side; 0 where nothing is hit\n"
    "  id                       the primitive's number there; 4294967295 where nothing is hit\n"
    "  nodes leaves primitives  looked at to find the hit; mean\n"
    "Of --shading path, in place of these counts:\n"
    "  error samples            the standard error of the light, and how many samples there are\n"
    "  direct.R .G .B           linear light that is scattered at most once on its way to the eye\n"
    "  indirect.R .G .B         linear light that is scattered more often: R G B less direct\n"
    "  albedo.R .G .B           colour of the first surface that scatters, and its normal in normal; means\n"
    "  denoised.R .G .B         with --denoise: linear light with less noise\n"
    "  instance uv.U .V         the object's number at the first hit, and its texture coordinates\n\n";

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
/// Renders triangles by beams or cones through the engine's index. Returns the exit code.
template <class T, class P>
int render_by_engine(const RenderArguments& a, const P& primitives) {
    if constexpr (!std::same_as<ViewOf<P>, TriangleMeshView<T>>) {
        throw InputError(a.scene + (a.uses_beams()
                                        ? ": beams go through triangles alone; use --visibility cast"
                                        : ": cones see triangles alone; leave out --cones and --light-size"));
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
        const IndexCones<MeshIndex<T>> cones(index);
        BeamTracing<MeshIndex<T>> beams(index);
        const auto other = a.uses_beams() ? nullptr : visibility_of<T>(a, primitives, &tracer);
        Visibility<T>& visibility = other ? *other : beams;
        const auto& box = index.bounds();
        const RenderOptions options = options_of(a, Box3f{Vec3f(box.low), Vec3f(box.high)}, o.upright);
        ProgressLine line("rendering", a.quiet, "rows");
        return finish(a, PictureParts<T>{visibility, surfaces, &tracer, nullptr, &cones}, options,
                      std::move(o), line.progress());
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
    tell(a, stream->report());
    o.upright = a.view.up == "auto" ? upright_by_format(a.scene, {}) : Upright{a.view.up[0] - 'x', ""};
    const RenderOptions options = options_of(a, box, o.upright);
    return finish(a, PictureParts<T>{rasterising, rasterising}, options, std::move(o), {{}, progress.cancel});
}
template <class P>
int render(const RenderArguments& a, const P& primitives) {
    using T = typename P::Scalar;
    const ThreadLimit limit(a.threads);
    if (a.uses_beams() || a.uses_cones()) return render_by_engine<T>(a, primitives);
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

/// Throws UsageError for options that cones do not go with.
void check_cones(const RenderArguments& a) {
    const std::string name = a.cones ? "--cones" : "--light-size";
    if (a.structure != "wide")
        throw UsageError("--structure " + a.structure + ": cones go through 'wide' alone");
    if (a.transparent) throw UsageError(name + ": cones do not see through surfaces; leave out --opacity");
    if (!a.cones) return;
    if (a.sheet) throw UsageError("--cones: leave out --sheet, which also shows what rays cost");
    if (a.visibility != "cast")
        throw UsageError("--cones: leave out --visibility, since cones find what is visible");
    if (a.spp > 1) throw UsageError("--cones: leave out --spp, since a cone sees all of a pixel");
    if (counted(a.shading_of_rays()) || a.counts)
        throw UsageError("--cones: leave out --shading steps and --counts, which show what rays cost");
}

/// Throws UsageError for options that refinement does not go with.
void check_refinement(const RenderArguments& a) {
    if (a.spp < 5) throw UsageError("--refine: give more than four samples, as --spp 16");
    const auto refuse = [](bool given, const std::string& option) {
        if (given) throw UsageError("--refine adds rays where light differs: leave out " + option);
    };
    refuse(a.visibility != "cast", "--visibility " + a.visibility);
    refuse(a.cones, "--cones"), refuse(a.sheet, "--sheet");
    refuse(counted(a.shading_of_rays()), "--shading " + a.shading);
}

/// Admits the names in a list.
template <class Names>
CLI::IsMember one_of(const Names& names) {
    return CLI::IsMember(std::vector<std::string>(names.begin(), names.end()));
}
constexpr auto options_of_paths = {"--bounces",
                                   "--sampler",
                                   "--filter",
                                   "--tone",
                                   "--time",
                                   "--noise",
                                   "--adaptive",
                                   "--preview",
                                   "--resume",
                                   "--exposure",
                                   "--save-rays",
                                   "--denoise",
                                   "--show-samples",
                                   "--environment",
                                   "--environment-rotation",
                                   "--environment-strength"};
/// Throws UsageError for options that are not of paths.
void check_paths(const RenderArguments& a) {
    const auto refuse = [](bool given, const char* option) {
        if (given)
            throw UsageError(std::string("--shading path: leave out ") + option + ", which is not of paths");
    };
    refuse(a.sheet, "--sheet"), refuse(a.counts, "--counts"), refuse(a.footprints, "--footprints");
    refuse(a.refines, "--refine"), refuse(a.uses_cones(), a.cones ? "--cones" : "--light-size");
    refuse(a.transparent || a.opacity < 1, "--transparency and --opacity");
    refuse(a.visibility != "cast", "--visibility");
    if (a.shows_samples && (a.layers || a.denoises))
        throw UsageError(std::string("--show-samples: leave out ") +
                         (a.layers ? ".exr, which has the samples as a layer" : "--denoise"));
    if (a.denoises && a.spp < 4) throw UsageError("--denoise: a picture needs four samples, as --spp 4");
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
    verb.add_option(
            "--shading", a->shading,
            "normals, depth, diffuse (grey), colour (materials and textures of the scene), path (scattered "
            "light) or steps")
        ->capture_default_str()
        ->check(CLI::IsMember({"normals", "depth", "diffuse", "colour", "path", "steps"}));
    verb.add_option(
            "--visibility", a->visibility,
            "how hits are found: cast rays, raster triangles, or beams of rays; the picture is the same")
        ->capture_default_str()
        ->check(CLI::IsMember({"cast", "raster", "beams"}));
    verb.add_flag("--transparency", a->transparent,
                  "light goes through what is not opaque, in shadows too; alone it needs --shading colour");
    verb.add_option("--opacity", a->opacity,
                    "of all surfaces, times that of their looks; below 1 light goes through")
        ->check(CLI::Range(0.0, 1.0));
    verb.add_flag("--cones", a->cones, "a cone for each pixel, in place of --spp: smooth edges of triangles");
    verb.add_flag("--footprints", a->footprints,
                  "of --shading colour: textures are averaged over what a sample's part of its pixel sees of "
                  "them; --cones does so too");
    verb.add_option("--light-size", a->light_degrees,
                    "the light's diameter in degrees (the sun's is 0.53): shadows have soft edges")
        ->check(CLI::Range(0.0, 89.0));
    verb.add_flag("--sheet", a->sheet, "every shading side by side, on one .png of three times two pictures");
    const auto* const spp =
        verb.add_option("--spp", a->spp, "samples a pixel; of --shading path 64 if not given")
            ->check(CLI::Range(1, 1 << 20));
    verb.add_flag("--refine", a->refines,
                  "all of --spp only where light differs much, by the first four samples and those of "
                  "neighbours; of paths --adaptive does more");
    verb.add_option("--bounces", a->bounces, "of --shading path: how often light is scattered at most")
        ->capture_default_str();
    verb.add_option("--sampler", a->sampler, "of --shading path: sobol (spread evenly) or independent")
        ->capture_default_str()
        ->check(one_of(sampler_names));
    verb.add_option("--filter", a->filter, "of --shading path: where a pixel's samples lie, box or gaussian")
        ->capture_default_str()
        ->check(one_of(pixel_filter_names));
    verb.add_option(
            "--tone", a->tone,
            "of --shading path: how a .png shows what is brighter than white, linear (cut off) or neutral "
            "(bent)")
        ->capture_default_str()
        ->check(one_of(tone_names));
    verb.add_option("--time", a->seconds,
                    "of --shading path: follow paths for so long, as 90s, 5min or 2h, at most to --spp, "
                    "which then is "
                    "16384 if not given")
        ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                          CLI::AsNumberWithUnit::CASE_SENSITIVE))
        ->check(CLI::PositiveNumber);
    verb.add_option("--noise", a->noise,
                    "of --shading path: follow paths until this is the picture's noise, as a share of its "
                    "light (0.01 is 1%), at most to --spp, which then is 16384 if not given; --adaptive is "
                    "implied")
        ->check(CLI::Range(1e-6, 1.0));
    verb.add_flag(
        "--adaptive", a->adaptive,
        "of --shading path: more samples for pixels whose samples differ, with --spp on the mean; for "
        "pictures of which some parts need many more than others");
    verb.add_flag("--show-samples", a->shows_samples,
                  "of --shading path: a .png of how many samples each pixel has, in place of its light");
    verb.add_flag("--denoise", a->denoises,
                  "of --shading path: take the noise out of a .png, and write layers without noise into an "
                  ".exr beside the others");
    verb.add_flag("--preview", a->preview, "of --shading path: show the picture in the terminal meanwhile");
    verb.add_option(
        "--resume", a->resume,
        "of --shading path: a file in which the work is kept every few seconds; if it is there, the work "
        "goes on from it");
    verb.add_option(
        "--save-rays", a->save_rays,
        "of --shading path: a prefix of files, PREFIX-0.npy and so on, in which rays are saved by "
        "bounce, for bench and query");
    verb.add_option("--environment", a->environment,
                    "of --shading path: a panorama in latitude and longitude (.hdr, .exr, .png or .jpg) that "
                    "lights the scene from all around");
    verb.add_option(
            "--environment-rotation", a->environment_rotation,
            "turns the panorama around the upward axis, in degrees, counterclockwise as seen from above")
        ->check(CLI::Range(-3600.0, 3600.0));
    verb.add_option("--environment-strength", a->environment_strength, "multiplies the light of the panorama")
        ->check(CLI::Range(0.0, 1e6));
    verb.add_option("--exposure", a->exposure, "of --shading path: brightness of a .png in powers of two")
        ->check(CLI::Range(-30.0, 30.0));
    verb.add_flag("--counts", a->counts,
                  "count what rays visit, without the engine's kernels; layers and steps are counts already");
    verb.add_option("--threads", a->threads, "that build and render; 0: all cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 1024));
    add_view(verb, a->view);
    add_projection(verb, a->view);
    verb.add_option("--camera", a->camera,
                    "of --shading colour and path: a camera of the file, counted from 0")
        ->check(CLI::NonNegativeNumber);
    verb.add_option("--steps-max", a->steps_max, "the top of the scale of --shading steps; 0: what was seen");
    const auto given = [&verb](const char* option) { return verb.get_option(option)->count() > 0; };
    return [a, spp, given] {
        if (a->follows_paths() && spp->count() == 0) a->spp = a->seconds > 0 || a->noise > 0 ? 16384 : 64;
        a->adaptive |= a->noise > 0;
        for (const char* const option : options_of_paths)
            if (!a->follows_paths() && given(option))
                throw UsageError(std::string(option) + " is of paths: it needs --shading path");
        for (const char* const option : {"--environment-rotation", "--environment-strength"})
            if (a->environment.empty() && given(option))
                throw UsageError(std::string(option) + " needs --environment, the panorama that it changes");
        if (!a->save_rays.empty()) check_rays_writable(a->save_rays);
        if (!a->resume.empty()) check_writable(a->resume);
        const bool saved = names_index_file(a->scene);
        a->layers = asks_for_layers(a->output);
        if (a->visibility != "cast" && counted(a->shading_of_rays()))
            throw UsageError("--shading " + a->shading + " shows what rays cost: it needs --visibility cast");
        if (a->uses_beams() && a->structure != "wide")
            throw UsageError("--structure " + a->structure + ": beams go through 'wide' alone");
        if (a->sheet) check_sheet(*a);
        if (a->follows_paths())
            check_paths(*a), check_paths_memory(*a);
        else
            check_picture_memory(a->view.size, a->layers);
        check_writable(a->output);
        const bool by_looks = a->sheet || a->follows_paths() || a->shading_of_rays() == Shading::colour;
        if (by_looks && a->uses_beams())
            throw UsageError("beams go through one mesh without looks: leave out --visibility beams");
        if (by_looks && !a->sheet && a->structure != "wide")
            throw UsageError("--shading " + a->shading + " casts rays at 'wide': leave out --structure");
        if (a->transparent && a->opacity == 1 && !by_looks)
            throw UsageError(
                "--transparency: --shading " + a->shading +
                " shows no looks, so all is opaque; give --shading colour, or --opacity for all");
        a->transparent |= a->opacity < 1;
        if (a->transparent && !a->sheet && counted(a->shading_of_rays()))
            throw UsageError("--shading " + a->shading +
                             " shows what rays cost, which end at the first hit; leave out "
                             "--transparency and --opacity");
        if (a->footprints && !by_looks)
            throw UsageError("--footprints: --shading " + a->shading +
                             " shows no textures; give --shading colour");
        if (a->uses_cones()) check_cones(*a);
        if (a->refines) check_refinement(*a);
        if (a->camera >= 0 && !by_looks)
            throw UsageError("--camera is of files with looks: it needs --shading colour or path");
        return in_precision(*a, [&]<class T>(T) {
            if (a->follows_paths()) return render_paths<T>(*a);
            if (by_looks) return render_looks<T>(*a);
            if (saved && a->structure == "wide" && !a->uses_beams() && !a->uses_cones() &&
                !index_file_info(a->scene).holds_points)
                return render_saved<T>(*a);
            if (!a->needs_index() && !a->drop_bad && !a->scene.starts_with("gen:") && can_stream(a->scene))
                return render_stream<T>(*a);
            return std::visit([&](const auto& set) { return render(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
