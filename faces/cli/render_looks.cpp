#include "render_looks.h"

#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hedgerow/any_index.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/io/model_file.h>
#include <hedgerow/io/texture_file.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/lighting/default_sky.h>
#include <hedgerow/render/model_cones.h>
#include <hedgerow/render/model_scene.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/scenes/looks.h>

namespace hedgerow::cli {

namespace {

/// Loads or generates a scene with its looks, and tells what of it is not shown.
template <class T>
Model<T> load_looks(const RenderArguments& a) {
    if (a.scene.starts_with("gen:")) {
        SceneSpec spec = parse_scene_spec(a.scene);
        spec.seed = a.seed;
        check_memory(spec);
        ProgressLine line("generating " + a.scene, a.quiet, "triangles");
        return generate_model<T>(spec, line.progress());
    }
    if (a.drop_bad)
        throw UsageError(
            "--drop-bad leaves no looks: write the file without them (hedgerow convert --drop-bad), "
            "or choose another --shading");
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
        c.field_of_view = static_cast<float>(view->field_of_view * 180 / std::numbers::pi);
    else
        c.projection = Projection::orthographic,
        c.height = static_cast<float>(std::get<OrthographicView>(from.view).height);
    return c;
}
/// The light of the panorama that the user names, upright in the scene.
Environment environment_of(const RenderArguments& a, const Vec3f& up) {
    Environment environment = load_environment(a.environment);
    if (const Pixels& p = *environment.panorama.pixels; p.width != 2 * p.height && !a.quiet)
        fmt::print(
            stderr,
            "hedgerow: warning: {} has {}x{} pixels, where a panorama in latitude and longitude is twice "
            "as wide as high\n",
            a.environment, p.width, p.height);
    const double angle = a.environment_rotation * (std::numbers::pi / 180);
    const Vec3d turned_x(cosine(angle), 0, -sine(angle)), turned_z(sine(angle), 0, cosine(angle));
    for (Vec3d& row : environment.to_world = upright_environment(up))
        row = Vec3d(dot(row, turned_x), row[1], dot(row, turned_z));
    environment.radiance = Vec3f::all(static_cast<float>(a.environment_strength));
    return environment;
}
/// The shadings of a sheet, row by row.
constexpr Shading on_sheet[] = {Shading::colour, Shading::diffuse, Shading::normals,
                                Shading::depth,  Shading::steps,   Shading::tests};
constexpr int sheet_columns = 3, sheet_rows = 2;

/// Makes a sheet of a model in every shading, saves it and reports. What rays cost is that of `structure`
/// over the triangles in the world. Returns the exit code.
template <class T>
int finish_sheet(const RenderArguments& a, const PictureParts<T>& by_looks, const Model<T>& model,
                 const RenderOptions& options, Outcome o) {
    const auto mesh = model.in_world();
    const double began = now();
    const auto index = build_shown(a, a.structure, mesh);
    o.build_seconds = now() - began, o.bytes = index->bytes();
    const IndexTracer<AnyIndex<T, 3>> tracer(*index);
    RayCasting<T> casting(tracer);
    const PictureParts<T> by_cost{casting, by_looks.surfaces, &tracer};
    Picture& sheet = o.picture;
    sheet.image = Image(sheet_columns * options.width, sheet_rows * options.height);
    o.up = options.camera.up;
    const double start = now();
    for (int i = 0; i < sheet_columns * sheet_rows && sheet.whole; ++i) {
        RenderOptions of_panel = options;
        of_panel.shading = on_sheet[i];
        const bool shows_cost = counted(of_panel.shading);
        of_panel.transparent &= !shows_cost;
        const std::string name(shading_names[static_cast<std::size_t>(of_panel.shading)]);
        ProgressLine line("rendering " + name, a.quiet, "rows");
        Picture panel =
            render(shows_cost ? by_cost : by_looks, by(default_executor(), of_panel), line.progress());
        draw_note(panel.image, 0, 0, {shows_cost ? name + ": " + a.structure : name},
                  std::max(1, options.height / 256));
        paste(panel.image, sheet.image, i % sheet_columns * options.width,
              i / sheet_columns * options.height);
        sheet.costs += panel.costs, sheet.whole = panel.whole, sheet.pixels += panel.pixels;
    }
    o.seconds = now() - start;
    return save_and_report(a, std::move(o));
}

}  // namespace

void check_sheet(const RenderArguments& a) {
    if (a.layers) throw UsageError("--sheet is a picture of pictures: its output is .png, not .exr");
    if (a.counts || a.steps_max > 0) throw UsageError("--sheet takes no --counts and no --steps-max");
    const auto [width, height] = parse_size(a.view.size);
    check_picture_memory(fmt::format("{}x{}", sheet_columns * width, sheet_rows * height), false);
}

template <class T>
ShownModel<T>::ShownModel(const RenderArguments& a)
    : model(load_looks<T>(a)), started(now()), scene(model, interruptible_executor()) {
    outcome.build_seconds = now() - started;
    outcome.indexed = true, outcome.bytes = scene.bytes(), outcome.primitives = model.triangles();
    outcome.upright = model.objects.size() == 1 || a.scene.starts_with("gen:")
                          ? upright_of(a.view, a, model.objects[0].mesh)
                      : a.view.up != "auto" ? Upright{a.view.up[0] - 'x', ""}
                                            : upright_by_format(a.scene, {});
    const auto& box = scene.bounds();
    options = options_of(a, Box3f{Vec3f(box.low), Vec3f(box.high)}, outcome.upright);
    up = upward(a.view, a, outcome.upright);
    options.camera = camera_of(a, model, options.camera);
    if (!a.environment.empty()) model.environment = environment_of(a, up);
}
template struct ShownModel<float>;
template struct ShownModel<double>;

template <class T>
int render_looks(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    const ShownModel<T> shown(a);
    const ModelScene<T>& scene = shown.scene;
    const RenderOptions& options = shown.options;
    Outcome o = shown.outcome;
    const auto& looks = scene.appearances();
    RayCasting<T> casting(scene.tracer(), looks.has_masks()
                                              ? [&](const Hit<T>& hit) { return looks.is_there(hit); }
                                              : std::function<bool(const Hit<T>&)>());
    Rasterising<T, InstanceSetView<MeshIndex<T>>> rasterising(scene.instances().view());
    if (a.rasterises() && looks.has_masks())
        throw InputError(a.scene + ": has masks of opacity, which only rays see; use --visibility cast");
    Visibility<T>& visibility = a.rasterises() ? static_cast<Visibility<T>&>(rasterising) : casting;
    std::optional<ModelCones<T>> cones;
    if (a.uses_cones()) cones.emplace(shown.model, interruptible_executor()), o.bytes += cones->bytes();
    const PictureParts<T> parts{visibility, scene.surfaces(), &scene.tracer(), &looks,
                                cones ? &*cones : nullptr};
    if (a.sheet) return finish_sheet(a, parts, shown.model, options, std::move(o));
    ProgressLine line("rendering", a.quiet, "rows");
    return finish(a, parts, options, std::move(o), line.progress());
}
template int render_looks<float>(const RenderArguments&);
template int render_looks<double>(const RenderArguments&);

}  // namespace hedgerow::cli
