/// Pictures of fluids.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/lettering.h>

#include "flow.h"
#include "run_folder.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

/// What pictures show: the tank and some room around it, from the front.
struct FlowFrame {
    int right, up, back;  // axes; in the plane `back` is `right`
    double wide, high;    // what must be seen
    double left, top, scale;

    double x(double place) const { return (place - left) * scale; }
    double y(double place) const { return (top - place) * scale; }
};
template <int D>
FlowFrame flow_frame_of(const FlowScene<D>& scene, int width, int height) {
    FlowFrame f;
    f.up = scene.up, f.right = scene.up == 0 ? 1 : 0, f.back = D == 2 ? f.right : 3 - f.up - f.right;
    const double margin = 4 * scene.options.spacing;
    f.wide = scene.tank.extent()[f.right] + 2 * margin, f.high = scene.tank.extent()[f.up] + 2 * margin;
    f.scale = std::min(width / f.wide, height / f.high);
    f.left = scene.tank.center()[f.right] - width / f.scale / 2;
    f.top = scene.tank.center()[f.up] + height / f.scale / 2;
    return f;
}
constexpr Image::Pixel air_colour = {250, 250, 252}, wall_colour = {120, 124, 132};

Image::Pixel shaded(const Image::Pixel& colour, double light) {
    Image::Pixel p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(std::clamp(colour[k] * light, 0.0, 255.0));
    return p;
}
/// Draws a ball, lit from the upper left; a disc if it is flat. Covers a pixel at least.
void draw_ball(Image& image, double x, double y, double radius, const Image::Pixel& colour, bool flat) {
    radius = std::max(radius, 0.7);
    for (int row = std::max(0, int(y - radius)); row <= std::min(image.height - 1, int(y + radius)); ++row)
        for (int column = std::max(0, int(x - radius)); column <= std::min(image.width - 1, int(x + radius));
             ++column) {
            const double across = (column + 0.5 - x) / radius, down = (row + 0.5 - y) / radius;
            const double rest = 1 - across * across - down * down;
            if (rest < 0) continue;
            const double light = 0.55 + 0.3 * std::sqrt(rest) - 0.2 * across - 0.25 * down;
            image.at(column, row) = flat ? colour : shaded(colour, std::min(1.0, light));
        }
}
void draw_box(Image& image, double left, double top, double right, double bottom, int thick) {
    for (int row = int(top) - thick; row < int(bottom) + thick; ++row)
        for (int column = int(left) - thick; column < int(right) + thick; ++column) {
            const bool inside =
                row >= int(top) && row < int(bottom) && column >= int(left) && column < int(right);
            if (!inside && row >= 0 && column >= 0 && row < image.height && column < image.width)
                image.at(column, row) = wall_colour;
        }
}

}  // namespace

template <int D>
std::optional<std::pair<int, int>> flow_picture_size(const FlowArguments& a, const FlowScene<D>& scene) {
    if (a.size == no_pictures) return std::nullopt;
    if (a.size != "auto") return parse_size(a.size);
    const FlowFrame f = flow_frame_of(scene, 800, 800);
    return std::pair(800, std::clamp(static_cast<int>(800 * (f.high / f.wide)), 200, 1200));
}

template <int D>
Image flow_picture(const FlowArguments& a, const FlowScene<D>& scene, const FluidState<D>& state, int width,
                   int height) {
    Image image(width, height, air_colour);
    const FlowFrame f = flow_frame_of(scene, width, height);
    if (scene.mesh == nullptr || !scene.fluid_inside)
        draw_box(image, f.x(scene.tank.low[f.right]), f.y(scene.tank.high[f.up]),
                 f.x(scene.tank.high[f.right]), f.y(scene.tank.low[f.up]), std::max(2, width / 200));
    // From the back to the front.
    std::vector<std::size_t> order(state.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if constexpr (D == 3)
        std::stable_sort(order.begin(), order.end(),
                         [&state, back = f.back, up = scene.up](std::size_t i, std::size_t k) {
                             const double away = state.places[i][back] - state.places[k][back];
                             return up == 1 ? away < 0 : away > 0;
                         });
    const double g = length(scene.options.gravity), depth = scene.depth(),
                 most_pressure = g * depth / (scene.options.sound * scene.options.sound),
                 most_speed = std::sqrt(2 * std::max(g * depth, 0x1p-100));
    for (const std::size_t i : order) {
        const double share = a.colour == "speed" ? length(state.velocities[i]) / most_speed
                             : most_pressure > 0 ? state.compressions[i] / most_pressure
                                                 : 0;
        const Image::Pixel colour = heat(static_cast<float>(std::clamp(0.1 + 0.9 * share, 0.0, 1.0)));
        draw_ball(image, f.x(state.places[i][f.right]), f.y(state.places[i][f.up]),
                  0.5 * scene.options.spacing * f.scale, colour, D == 2);
    }
    draw_note(
        image, 0, 0,
        {fmt::format("t = {:.3f}", state.time), fmt::format("{} particles, {}", state.size(), a.colour)},
        width >= 1000 ? 2 : 1);
    return image;
}
template Image flow_picture(const FlowArguments&, const FlowScene<2>&, const FluidState<2>&, int, int);
template Image flow_picture(const FlowArguments&, const FlowScene<3>&, const FluidState<3>&, int, int);
template std::optional<std::pair<int, int>> flow_picture_size(const FlowArguments&, const FlowScene<2>&);
template std::optional<std::pair<int, int>> flow_picture_size(const FlowArguments&, const FlowScene<3>&);

}  // namespace hedgerow::cli
