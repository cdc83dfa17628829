/// hedgerow render --shading path: pictures of light that is scattered, by path tracing.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/io/exr.h>
#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/integrators/path_picture.h>

#include "picture_notes.h"
#include "render_looks.h"

namespace hedgerow::cli {

namespace {

PathPictureOptions path_options(const RenderArguments& a, const RenderOptions& shown) {
    PathPictureOptions o;
    o.camera = shown.camera, o.width = shown.width, o.height = shown.height;
    o.samples = static_cast<std::uint32_t>(a.spp);
    o.paths.seed = a.seed, o.paths.bounces = a.bounces;
    o.paths.sampler = a.sampler == "independent" ? Sampler::independent : Sampler::sobol;
    return o;
}
Image image_of(const PathPicture& picture, float exposure) {
    Image image(picture.width, picture.height);
    const auto brightness = static_cast<float>(power(2, static_cast<double>(exposure)));
    for (std::size_t i = 0; i < picture.light.size(); ++i)
        image.pixels[i] = srgb(picture.light.mean(i) * brightness);
    return image;
}
/// Linear light, its standard error, and the number of samples.
void save_layers(const std::string& output, const PathPicture& picture, const Notes& notes) {
    const std::vector<Vec3f> light = picture.means();
    std::vector<float> errors;
    std::vector<std::uint32_t> samples;
    for (std::size_t i = 0; i < light.size(); ++i)
        errors.push_back(picture.light.standard_error(i)), samples.push_back(picture.light.samples(i));
    Layers layers{picture.width, picture.height, {}};
    const char* const names[] = {"R", "G", "B"};
    for (int k = 0; k < 3; ++k)
        layers.channels.push_back({names[k], Strided<float>(&light[0].data[k], light.size(), sizeof(Vec3f))});
    layers.channels.push_back({"error", Strided<float>(errors.data(), errors.size(), sizeof(float))});
    layers.channels.push_back(
        {"samples", Strided<std::uint32_t>(samples.data(), samples.size(), sizeof(std::uint32_t))});
    save_exr(output, layers, {}, notes);
}
/// The mean of the standard errors of all pixels, as a share of the mean light.
double relative_error(const PathPicture& picture) {
    double errors = 0, light = 0;
    for (std::size_t i = 0; i < picture.light.size(); ++i) {
        const Vec3f mean = picture.light.mean(i);
        errors += double(picture.light.standard_error(i));
        light += double(mean[0] + mean[1] + mean[2]) / 3;
    }
    return light > 0 ? errors / light : 0;
}

}  // namespace

template <class T>
int render_paths(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    const ShownModel<T> shown(a);
    SceneLightsOptions of_lights;
    of_lights.up = shown.options.camera.up;
    const SceneLights<T> lights(shown.scene, of_lights, interruptible_executor());
    if (lights.has_default_sky() && !a.quiet)
        fmt::print(stderr, "hedgerow: {}: has no lights, so it gets a sky\n", a.scene);
    const PathPictureOptions options = path_options(a, shown.options);
    const double start = now();
    const PathPicture picture = [&] {
        ProgressLine line("following paths", a.quiet, "tiles");
        return trace_paths(PathScene<T>{shown.scene, lights, shown.scene.tracer()}, options,
                           default_executor(), line.progress());
    }();
    const double seconds = now() - start;
    const FinishedPicture finished = finish_picture(a.output, picture.light.samples(0) > 0, picture.whole);
    const Notes notes = picture_notes(a.seed);
    if (a.layers)
        save_layers(finished.output, picture, notes);
    else
        save_png(finished.output, image_of(picture, a.exposure), {}, notes);
    if (picture.dropped > 0)
        fmt::print(stderr, "hedgerow: warning: {} samples were no finite light, and count as black\n",
                   picture.dropped);
    const double samples = double(picture.light.size()) * double(a.spp), error = relative_error(picture);
    if (a.json)
        print_json(nlohmann::ordered_json{{"output", finished.output},
                                          {"width", picture.width},
                                          {"height", picture.height},
                                          {"primitives", shown.outcome.primitives},
                                          {"bytes", shown.outcome.bytes},
                                          {"build_seconds", shown.outcome.build_seconds},
                                          {"lights", lights.emitters().size()},
                                          {"samples", a.spp},
                                          {"seconds", seconds},
                                          {"samples_per_second", samples / seconds},
                                          {"relative_error", error},
                                          {"dropped", picture.dropped},
                                          {"finished", picture.whole}});
    else if (!a.quiet)
        fmt::print(
            "{}: {}x{}, {} primitives, {} lights\n{} samples a pixel in {:.1f} s: {:.3f} million a second; "
            "standard error {:.2g}% of the light\n{}",
            finished.output, picture.width, picture.height, shown.outcome.primitives,
            lights.emitters().size(), a.spp, seconds, samples / seconds * 1e-6, 100 * error,
            up_text(a.view, a, shown.outcome.upright));
    return finished.exit_code();
}
template int render_paths<float>(const RenderArguments&);
template int render_paths<double>(const RenderArguments&);

}  // namespace hedgerow::cli
