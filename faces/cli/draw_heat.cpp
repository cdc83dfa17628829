/// Heat maps: the costs of the rays of a view, as PNG or as layers of numbers.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/render.h>

#include "draw.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

/// The end of the scale without --scale, in steps, tests or nanoseconds. It is the same for every structure
/// and scene, so that pictures can be compared.
std::uint64_t usual_scale(Shading shading) {
    return shading == Shading::steps ? 200 : (shading == Shading::tests ? 60 : 4000);
}
template <class P>
int draw_heat_of(const DrawArguments& a, const P& set) {
    RenderOptions options;
    options.layers = asks_for_layers(a.output);
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.seed = a.seed;
    options.shading = named_shading(a.heat).value();
    options.scale.logarithmic = a.log;
    // A logarithmic scale without an end of its own follows the counts, which is what 0 asks for.
    options.scale.top = a.scale > 0 || a.log ? a.scale : usual_scale(options.shading);
    // Build, and place the camera by the bounds of the index.
    const auto index = build_shown(a, a.structure, set);
    const Upright upright = upright_of(a.view, a, set);
    options.camera =
        camera_of(a.view, a, Box3f{Vec3f(index->bounds().low), Vec3f(index->bounds().high)}, upright);
    // Cast the rays. After an interruption the finished rows are kept.
    Picture picture;
    FinishedPicture finished;
    {
        ProgressLine line("casting rays", a.quiet, "rows");
        picture = render(*index, set, by(default_executor(), options), line.progress());
        finished = finish_picture(a.output, picture.pixels > 0, picture.whole);
    }
    if (options.scale.top == 0)
        options.scale.top = static_cast<std::uint64_t>(std::ceil(std::max(picture.most, 1.0)));
    // Write the figures on the picture, left of the colour bar, and save it.
    const double share_beyond = double(picture.beyond) / double(picture.pixels);
    const std::string unit =
        a.heat == "time" ? "nanoseconds" : (a.heat == "tests" ? "primitives tested" : a.heat);
    draw_note(picture.image, 0, 0,
              note_lines(picture.image,
                         {std::filesystem::path(a.scene).filename().string() + ", " + a.structure,
                          fmt::format("{} a ray: {:.1f} on average, at most {:.0f}", unit, picture.mean,
                                      picture.most)},
                         colour_bar_left(picture.image, options.scale.top)),
              letter_scale(picture.image));
    save(finished.output, picture, a.seed);
    if (a.json)
        print_json({{"output", finished.output},
                    {"structure", a.structure},
                    {"heat", a.heat},
                    {"scale", options.scale.top},
                    {"logarithmic", a.log},
                    {"mean", picture.mean},
                    {"most", picture.most},
                    {"share_beyond_scale", share_beyond},
                    {"finished", finished.whole}});
    else if (!a.quiet)
        fmt::print(
            "{}: {} a ray: {:.1f} on average, at most {:.0f}; the scale ends at {}, and {:.2f}% of the "
            "pixels lie beyond\n{}",
            a.structure, unit, picture.mean, picture.most, options.scale.top, 100 * share_beyond,
            up_text(a.view, a, upright));
    return finished.exit_code();
}

}  // namespace

template <class T>
int draw_heat(const DrawArguments& a, const Scene<T>& scene) {
    return in_space(a, scene, [&](const auto&, const auto& seen) { return draw_heat_of(a, seen); });
}
template int draw_heat(const DrawArguments&, const Scene<float>&);
template int draw_heat(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
