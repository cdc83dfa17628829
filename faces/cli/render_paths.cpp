/// hedgerow render --shading path: pictures of light that is scattered, by path tracing.
#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/io/exr.h>
#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/film/tone.h>
#include <hedgerow/render/integrators/denoise_paths.h>
#include <hedgerow/render/integrators/path_picture.h>

#include "path_layers.h"
#include "picture_notes.h"
#include "render_looks.h"
#include "saved_picture.h"
#include "saved_rays.h"
#include "terminal_picture.h"

namespace hedgerow::cli {

namespace {

/// The value that has a name in the list of all.
template <class E, class Names>
E named(const Names& names, std::string_view name) {
    return static_cast<E>(std::ranges::find(names, name) - names.begin());
}

Division division_of(const RenderArguments& a) {
    if (a.adaptive) return Division::adaptive;
    return a.denoises ? Division::halves : Division::even;
}
PathPictureOptions path_options(const RenderArguments& a, const RenderOptions& shown) {
    PathPictureOptions o;
    o.camera = shown.camera, o.width = shown.width, o.height = shown.height;
    o.samples = static_cast<std::uint32_t>(a.spp);
    o.paths.seed = a.seed, o.paths.bounces = a.bounces;
    o.filter = named<PixelFilter>(pixel_filter_names, a.filter);
    o.paths.sampler = named<Sampler>(sampler_names, a.sampler);
    o.division = division_of(a), o.keeps_direct = a.layers;
    return o;
}
Image image_of(const RenderArguments& a, const PathPicture& picture, const std::vector<Vec3f>& light) {
    Image image(picture.width, picture.height);
    const auto brightness = static_cast<float>(power(2, static_cast<double>(a.exposure)));
    const Tone tone = named<Tone>(tone_names, a.tone);
    for (std::size_t i = 0; i < light.size(); ++i) image.pixels[i] = srgb(toned(tone, light[i] * brightness));
    return image;
}
/// A heat map of the number of samples of each pixel, on a logarithmic scale up to the most.
Image samples_image(const PathPicture& picture) {
    Image image(picture.width, picture.height);
    std::uint64_t most = 1;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        most = std::max<std::uint64_t>(most, picture.light.samples(i));
    const ColourScale scale{most, true};
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = heat(scale.at(static_cast<float>(picture.light.samples(i))));
    draw_colour_bar(image, scale);
    return image;
}
/// Saves a picture; what is seen first is for an .exr alone. `denoised` is its light without noise, or empty.
void save_picture(const RenderArguments& a, const PathPicture& picture,
                  const std::vector<FirstSurface>& first_surfaces, const std::vector<Vec3f>& denoised = {}) {
    const Notes notes = picture_notes(a.seed);
    if (a.layers)
        save_exr(a.output, PathLayers(picture, first_surfaces, denoised).layers, {}, notes);
    else if (a.shows_samples)
        save_png(a.output, samples_image(picture), {}, notes);
    else
        save_png(a.output, image_of(a, picture, denoised.empty() ? picture.means() : denoised), {}, notes);
}
/// The light of a picture without noise; empty if that is not asked for, or there are too few samples.
std::vector<Vec3f> without_noise(const RenderArguments& a, const PathPicture& picture,
                                 const std::vector<FirstSurface>& first_surfaces) {
    if (!a.denoises) return {};
    if (!can_be_denoised(picture)) {
        fmt::print(stderr, "hedgerow: warning: some pixels have too few samples to be denoised\n");
        return {};
    }
    ProgressLine line("taking noise out", a.quiet);
    Progress progress = line.progress();
    progress.cancel = nullptr;  // after Ctrl-C, too
    return denoised(picture, first_surfaces, {.threads = default_executor()}, progress);
}

/// How many samples a pixel the picture should have next, by its noise; as many as it has if it is finished.
std::uint32_t next_samples(const RenderArguments& a, const PathPicture& picture, double noise) {
    const auto most = static_cast<std::uint32_t>(a.spp);
    if (a.noise == 0 || picture.samples >= most) return std::max(most, picture.samples);
    if (noise <= a.noise) return picture.samples;
    // Noise falls at least with the root of the number of samples. What is known of it is better each time.
    const double ratio = std::min(noise / a.noise, 1e3);
    const double needed = picture.samples * std::min(2.0, ratio * ratio);
    return std::min(most, std::max(2 * pilot_samples, static_cast<std::uint32_t>(needed) + 1));
}

constexpr double never = std::numeric_limits<double>::infinity();

/// Something that is saved again and again while other work waits, with pauses that are at least so many
/// times as long as it took, and at least so many seconds.
class Saving {
public:
    Saving(bool wanted, double times, double least_pause)
        : times_(times), least_(least_pause), next_(wanted ? now() + least_pause : never) {}
    /// When it is saved next, on the clock of now().
    double next() const { return next_; }
    template <class Save>
    void if_due(const Save& save) {
        const double began = now();
        if (began < next_) return;
        save();
        next_ = now() + std::max(times_ * (now() - began), least_);
    }

private:
    double times_, least_, next_;
};

/// Follows paths until the picture has all samples or little noise, the time is over, or Ctrl-C. Meanwhile
/// the picture is saved, and the state, if there is a file for it. Returns whether it was not interrupted.
template <class T>
bool follow(const RenderArguments& a, const PathScene<T>& scene, const PathPictureOptions& options,
            const std::vector<FirstSurface>& first, SavedPicture& state, PathPicture& picture) {
    ProgressLine line("following paths", a.quiet, "samples");
    const Progress shown = line.progress();
    std::atomic<bool> stops{false};
    const double start = now();
    // A kill loses what was done since the last state that is written. Pictures are for looking at alone.
    Saving of_state(state.has_file(), 50, 20), of_picture(true, 200, 10);
    double show_at = a.preview ? start + 1 : never;
    const auto over = [&] { return shown.cancelled() || (a.seconds > 0 && now() - start > a.seconds); };
    const Progress watched{[&](std::uint64_t done, std::uint64_t total) {
                               shown(done, total);
                               if (over() || now() > std::min({of_state.next(), of_picture.next(), show_at}))
                                   stops = true;
                           },
                           &stops};
    for (;;) {
        const double noise = picture.light.noise();
        if (noise < 1) line.rename(fmt::format("following paths, noise {:.2g}%,", 100 * noise));
        const std::uint32_t goal = next_samples(a, picture, noise);
        if (a.preview && (now() > show_at || goal == picture.samples)) {
            const TerminalSize size = terminal_size();
            line.show_above(
                terminal_picture(image_of(a, picture, picture.means()), size.columns, size.rows - 2));
            show_at = now() + 2;
        }
        if (goal == picture.samples || over()) break;
        stops = false;
        add_samples(picture, goal, scene, by(default_executor(), options), watched);
        of_state.if_due([&] { state.begin_to_save(picture); });
        of_picture.if_due([&] {
            if (picture.samples > 0) save_picture(a, picture, first);
        });
    }
    return !shown.cancelled();
}

std::string noise_text(const RenderArguments& a, double noise) {
    if (!(noise < 1e3)) return "too few samples to tell the noise";
    // Samples that are spread evenly have less noise than they show.
    return fmt::format("noise {}{:.2g}% of the light", division_of(a) == Division::even ? "at most " : "",
                       100 * noise);
}

}  // namespace

void check_paths_memory(const RenderArguments& a) {
    const std::size_t of_sums =  // of both halves, and of the direct light
        2 * sizeof(LightSums::Pixel) * (a.layers ? 2 : 1);
    const std::size_t of_work = of_sums + (a.layers || a.denoises ? sizeof(FirstSurface) : 0);
    const std::size_t of_picture =
        a.layers ? 3 * sizeof(Vec3f) + sizeof(float) + sizeof(std::uint32_t) : sizeof(Image::Pixel);
    const std::size_t of_state = a.resume.empty() ? 0 : of_sums;  // a copy
    check_memory_of_pixels(a.view.size, of_work + std::max(of_picture, of_state));
}

template <class T>
int render_paths(const RenderArguments& a) {
    const ThreadLimit limit(a.threads);
    const ShownModel<T> shown(a);
    SceneLightsOptions of_lights;
    of_lights.up = shown.up;
    const SceneLights<T> lights(shown.scene, of_lights, interruptible_executor());
    if (lights.has_default_sky() && !a.quiet)
        fmt::print(stderr, "hedgerow: {}: has no lights, so it gets a sky\n", a.scene);
    PathPictureOptions options = path_options(a, shown.options);
    SavedPicture state(a, shown, options);
    PathPicture picture = state.begun(a, options);
    const PathScene<T> scene{shown.scene, lights, shown.scene.tracer()};
    std::vector<FirstSurface> first;
    if (a.layers || a.denoises)
        first = first_surfaces(scene, std::min(options.samples, 16u), by(default_executor(), options));
    const double before = picture.mean_samples();
    const double start = now();
    const bool finished = follow(a, scene, options, first, state, picture);
    const double seconds = now() - start;
    if (state.has_file()) state.save(picture);
    const double samples = picture.mean_samples(), noise = picture.light.noise();
    if (samples == 0) throw Cancelled("no pixel has a sample");
    save_picture(a, picture, first, without_noise(a, picture, first));
    if (const std::uint64_t dropped = picture.dropped(); dropped > 0)
        fmt::print(stderr, "hedgerow: warning: {} samples were no finite light, and count as black\n",
                   dropped);
    const double rate = double(picture.light.size()) * (samples - before) / seconds;
    if (a.json)
        print_json(nlohmann::ordered_json{{"output", a.output},
                                          {"width", picture.width},
                                          {"height", picture.height},
                                          {"primitives", shown.outcome.primitives},
                                          {"bytes", shown.outcome.bytes},
                                          {"build_seconds", shown.outcome.build_seconds},
                                          {"lights", lights.emitters().size()},
                                          {"samples", samples},
                                          {"samples_before", before},
                                          {"seconds", seconds},
                                          {"samples_per_second", rate},
                                          {"noise", noise},
                                          {"dropped", picture.dropped()},
                                          {"finished", finished}});
    else if (!a.quiet)
        fmt::print(
            "{}: {}x{}, {} primitives, {} lights\n{:.6g} samples a pixel in {:.1f} s: {:.3f} million a "
            "second; {}\n{}",
            a.output, picture.width, picture.height, shown.outcome.primitives, lights.emitters().size(),
            samples, seconds, rate * 1e-6, noise_text(a, noise), up_text(a.view, a, shown.outcome.upright));
    if (finished && !a.save_rays.empty())
        save_rays(a, scene, options, std::max(static_cast<std::uint32_t>(samples), 1u));
    if (finished) return 0;
    fmt::print(stderr, "hedgerow: interrupted; {} has {:.6g} samples a pixel\n", a.output, samples);
    return 130;
}
template int render_paths<float>(const RenderArguments&);
template int render_paths<double>(const RenderArguments&);

}  // namespace hedgerow::cli
