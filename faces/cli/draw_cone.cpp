/// A cone of rays and its footprint, as lines over a view of a scene in space, as PNG.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/shading/footprint.h>
#include <hedgerow/surface.h>

#include "background.h"
#include "draw.h"
#include "picture_notes.h"
#include "ray_option.h"

namespace hedgerow::cli {

namespace {

const std::string cone_colour = "#1b5fa8", footprint_colour = "#d0103a";
constexpr int rim_rays = 240, drawn_rays = 24;

/// The ellipse of all middle + a cos φ + b sin φ.
std::vector<Vec3d> ellipse_of(const Vec3d& middle, const Vec3d& a, const Vec3d& b) {
    std::vector<Vec3d> ellipse;
    for (int i = 0; i < rim_rays; ++i) {
        const double turn = i * (360 * degree) / rim_rays;
        ellipse.push_back(middle + a * cosine(turn) + b * sine(turn));
    }
    return ellipse;
}
/// Directions of length 1 on the rim of a cone about an axis of length 1. `slope` is the tangent of the angle
/// between the axis and the rim.
std::vector<Vec3d> rim_of(const Vec3d& axis, double slope) {
    Vec3d beside;
    beside[std::abs(axis[0]) < 0.5 ? 0 : 1] = 1;
    const Vec3d u = normalized(cross(axis, beside));
    std::vector<Vec3d> rim = ellipse_of(axis, u * slope, cross(axis, u) * slope);
    for (Vec3d& d : rim) d = normalized(d);
    return rim;
}
/// Draws a closed line through points.
void draw_loop(Wireframe& wires, const std::vector<Vec3d>& points, const std::string& colour, float width) {
    for (std::size_t i = 0; i < points.size(); ++i)
        wires.draw({Vec3f(points[i]), Vec3f(points[(i + 1) % points.size()]), pixel_of(colour), width});
}

template <class P, class Seen>
int draw_cone_in(const DrawArguments& a, const P& set, const Seen& seen) {
    using T = typename P::Scalar;
    expect_ending(a, ".png", "a cone in space");
    const auto ray = ray_of<T, 3>(a);
    const auto index = build_shown(a, "bvh", seen);
    const Vec3d eye(ray.origin), axis = normalized(Vec3d(ray.direction));
    const double slope = tangent(a.cone / 2 * degree);
    // Where the axis ends, and the ellipse that the cone covers of the plane there.
    const auto hit_of = [&](const Ray<T, 3>& r) {
        Hit<T> hit;
        closest_hits(*index, std::span(&r, 1), std::span(&hit, 1), {.threads = serial_executor()});
        return hit;
    };
    const auto hit = hit_of(ray);
    if (!hit) throw InputError(a.scene + ": the ray hits nothing, where a cone has its footprint");
    const Vec3d place(position(seen, ray, hit)), across(normal(seen, ray, hit));
    const double distance = length(place - eye), radius = slope * distance;
    const SurfaceFootprint part = footprint_of(axis, radius, across);
    // Where the rays of the rim end.
    const auto rim = rim_of(axis, slope);
    std::vector<Vec3d> ends;
    std::size_t hits = 0;
    for (const Vec3d& d : rim) {
        const Ray<T, 3> beside{ray.origin, Vec<T, 3>(d)};
        const auto found = hit_of(beside);
        hits += bool(found);
        ends.push_back(found ? Vec3d(position(seen, beside, found)) : eye + d * distance);
    }
    // Draw the cone, what its rim meets and the footprint over a pale view.
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = 4, options.seed = a.seed;
    const Upright upright = upright_of(a.view, a, set);
    Box3f shown{Vec3f(index->bounds().low), Vec3f(index->bounds().high)};
    shown.expand(Vec3f(eye));
    options.camera = camera_of(a.view, a, shown, upright);
    const Background background(a, *index, seen, options);
    Image image = background.image;
    Wireframe wires(image, background.surface, background.maker);
    const float unit = std::max(1.0f, static_cast<float>(image.height) / 480);
    for (std::size_t i = 0; i < ends.size(); i += rim_rays / drawn_rays)
        wires.draw({Vec3f(eye), Vec3f(ends[i]), pixel_of(cone_colour), 0.8f * unit});
    wires.draw({Vec3f(eye), Vec3f(place), pixel_of("#111111"), 1.2f * unit});
    draw_loop(wires, ends, cone_colour, 1.8f * unit);
    draw_loop(wires, ellipse_of(place, part.a, part.b), footprint_colour, 2.4f * unit);
    const double wide = 2 * length(part.b), high = 2 * length(part.a);
    const std::vector<std::string> notes = {
        fmt::format("a cone of {:.3g} degrees, {:.3g} wide where its axis ends, at {:.3g}", a.cone,
                    2 * radius, distance),
        fmt::format("red: its footprint there, {:.3g} by {:.3g}", high, wide),
        fmt::format("blue: where {} of {} rays of its rim end", hits, rim_rays)};
    draw_note(image, 0, 0, note_lines(image, notes), letter_scale(image));
    save_png(a.output, image, {}, picture_notes(a.seed));
    if (a.json)
        print_json({{"output", a.output},
                    {"distance", distance},
                    {"footprint", {high, wide}},
                    {"rim_rays", rim_rays},
                    {"rim_hits", hits}});
    else if (!a.quiet)
        fmt::print("{}\n{}", fmt::join(notes, "\n"), up_text(a.view, a, upright));
    return 0;
}

}  // namespace

template <class T>
int draw_cone(const DrawArguments& a, const Scene<T>& scene) {
    const bool flat = std::visit([]<class P>(const P&) { return P::dimension == 2; }, scene);
    if (flat) throw InputError(a.scene + " is flat: the footprint of a cone is a part of a surface in space");
    return in_space(a, scene, [&](const auto& set, const auto& seen) { return draw_cone_in(a, set, seen); });
}
template int draw_cone(const DrawArguments&, const Scene<float>&);
template int draw_cone(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
