/// How fast pictures of paths get right: their error after 4, 16, 64, 256 and 1024 samples a pixel that are
/// spread evenly (Sobol) and that are independent, and the slope of its logarithm. Independent samples have a
/// slope of −1/2. The picture that they are held against has 16 times as many samples, with another seed.
///
///   convergence_benchmark [SIZE] [SCENE ...] [-o PLOT.svg]     default: 32, and
///   gen:cornell-box gen:teapot-in-stadium:50000 gen:hairball:200000 gen:terrain:200000
#include <cmath>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include <hedgerow/io/text_file.h>

#include "../faces/cli/report/plot.h"
#include "path_scene.h"
#include "picture_error.h"
#include "picture_scene.h"

using namespace hedgerow;

namespace {

constexpr std::uint32_t counts[] = {4, 16, 64, 256, 1024}, of_right_picture = 16384;
constexpr std::size_t colours = 10;  // of plots; the same colours follow, dashed

using Errors = std::vector<std::pair<double, double>>;  // by samples a pixel

/// The errors over the ordinals of their numbers of samples, whose logarithms are evenly apart.
Errors over_ordinals(Errors errors) {
    for (std::size_t i = 0; i < errors.size(); ++i) errors[i].first = static_cast<double>(i);
    return errors;
}

/// The slope of the line through the logarithms, with the least squares.
double slope(const Errors& errors) {
    double x_mean = 0, y_mean = 0, products = 0, squares = 0;
    for (const auto& [samples, error] : errors)
        x_mean += std::log(samples) / double(errors.size()),
            y_mean += std::log(error) / double(errors.size());
    for (const auto& [samples, error] : errors) {
        const double x = std::log(samples) - x_mean;
        products += x * (std::log(error) - y_mean), squares += x * x;
    }
    return products / squares;
}

Errors errors_of(const PathBenchmarkScene& scene, PathPictureOptions options, Sampler sampler,
                 const PathPicture& right) {
    options.paths.sampler = sampler;
    PathPicture picture(options.width, options.height);
    Errors errors;
    for (const std::uint32_t samples : counts) {
        add_samples(picture, samples, scene.with(scene.tracer()), by(default_executor(), options));
        errors.emplace_back(samples, error_of(picture, right).root);
    }
    return errors;
}

void measure_scene(const std::string& name, int size, cli::LinePlot& plot) {
    const PathBenchmarkScene scene(name);
    PathPictureOptions options = scene.options(size, of_right_picture);
    options.paths.seed = 1;
    const PathPicture right = trace_paths(scene.with(scene.tracer()), by(default_executor(), options));
    options.paths.seed = 0;
    const std::size_t colour = plot.series.size() / 2;
    for (const Sampler sampler : {Sampler::sobol, Sampler::independent}) {
        const Errors errors = errors_of(scene, options, sampler, right);
        const auto sampler_name = sampler_names[static_cast<std::size_t>(sampler)];
        fmt::print("| {} | {}", name, sampler_name);
        for (const auto& [samples, error] : errors) fmt::print(" | {:.2f}%", 100 * error);
        fmt::print(" | {:.2f} |\n", slope(errors));
        std::fflush(stdout);
        const std::string kind = name.starts_with("gen:") ? name.substr(4, name.find(':', 4) - 4) : "file";
        plot.series.push_back({fmt::format("{}, slope −{:.2f}", kind, -slope(errors)),
                               sampler == Sampler::sobol ? colour : colour + colours, over_ordinals(errors)});
    }
}

}  // namespace

int main(int count, char** arguments) try {
    std::string output;
    if (count > 2 && std::strcmp(arguments[count - 2], "-o") == 0) output = arguments[count - 1], count -= 2;
    const auto [size, names] = PictureArguments(
        count, arguments,
        {"gen:cornell-box", "gen:teapot-in-stadium:50000", "gen:hairball:200000", "gen:terrain:200000"}, 32,
        false);
    fmt::print("| scene | samples |");
    for (const std::uint32_t samples : counts) fmt::print(" {} |", samples);
    fmt::print(" slope |\n|---|---|---|---|---|---|---|---|\n");
    cli::LinePlot plot{"√relMSE over samples a pixel: Sobol (solid), independent (dashed)",
                       "samples a pixel",
                       cli::Unit::percent,
                       {},
                       {}};
    for (const std::uint32_t samples : counts) plot.x_names.push_back(std::to_string(samples));
    for (const auto& name : names) measure_scene(name, size, plot);
    if (!output.empty()) save_text(output, cli::svg_of(plot));
} catch (const std::exception& error) {
    std::fprintf(stderr, "convergence_benchmark: %s\n", error.what());
    return 3;
}
