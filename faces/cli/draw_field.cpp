/// Fields over a plane through a scene in space: distances, winding numbers and counts, as PNG.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/ask/insides.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/ask/regions.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/image.h>

#include "draw.h"
#include "field_picture.h"
#include "picture_notes.h"
#include "slice.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

/// The plane of the picture, and what of it is shown.
struct FieldPlane {
    int axis, right, up;
    double position, diagonal;
    Section<3> section;
    Box2d frame;
};

/// The plane of --slice; without it the plane through the middle, across the shorter axis of those that do
/// not point up. The frame shows the scene's bounds with a margin of a tenth, and is as high as wide at most
/// and half as high at least.
FieldPlane field_plane_of(const DrawArguments& a, const Box3d& bounds, const Upright& upright) {
    FieldPlane plane;
    const Vec3d extent = bounds.extent();
    plane.diagonal = length(extent);
    if (!std::isfinite(plane.diagonal))
        throw InputError(a.scene + " is too large for a picture of a field: its diagonal is infinite");
    const int one = (upright.axis + 1) % 3, other = (upright.axis + 2) % 3;
    Slice slice{extent[std::max(one, other)] <= extent[std::min(one, other)] ? std::max(one, other)
                                                                             : std::min(one, other)};
    if (!a.slice.empty()) slice = slice_of(a.slice);
    plane.axis = slice.axis, plane.position = slice.position(bounds);
    plane.section = section_across(plane.axis, plane.position, upright);
    plane.right = plane.section.right[0] != 0 ? 0 : (plane.section.right[1] != 0 ? 1 : 2);
    plane.up = 3 - plane.axis - plane.right;
    const Vec2d middle(bounds.center()[plane.right], bounds.center()[plane.up]);
    Vec2d half = Vec2d(extent[plane.right], extent[plane.up]) * 0.5;
    double longest = std::max(half[0], half[1]);
    if (longest == 0) longest = plane.diagonal > 0 ? plane.diagonal / 2 : 1;
    if (half[0] == 0 && half[1] == 0) half = Vec2d::all(longest);
    half = half + Vec2d::all(longest / 5);
    half[0] = std::max(half[0], half[1]);
    half[1] = std::max(half[1], half[0] / 2);
    plane.frame = {middle - half, middle + half};
    if (!(plane.frame.extent()[0] > 1e-6 * (std::abs(middle[0]) + std::abs(middle[1]))))
        plane.frame = {middle - Vec2d(longest, longest) * 1.2, middle + Vec2d(longest, longest) * 1.2};
    return plane;
}

/// Calls ask(points, values) for the rows of a picture, some at a time, until all are done or the work is
/// interrupted.
template <class T, class Ask>
void fill(FieldValues& field, const Section<3>& section, const Progress& progress, Ask ask) {
    const int rows = std::max(1, 32768 / field.width);
    std::vector<Vec<T, 3>> points;
    for (int first = 0; first < field.height && !progress.cancelled(); first += rows) {
        const int end = std::min(field.height, first + rows);
        points.clear();
        for (int y = first; y < end; ++y)
            for (int x = 0; x < field.width; ++x) {
                const Vec2d at = field.place(x, y);
                const Vec3d p = section.origin + section.right * at[0] + section.up * at[1];
                points.push_back({rounded_to<T>(p[0]), rounded_to<T>(p[1]), rounded_to<T>(p[2])});
            }
        const auto offset = static_cast<std::size_t>(first) * static_cast<std::size_t>(field.width);
        ask(points, std::span(field.values).subspan(offset, points.size()));
        progress(static_cast<std::uint64_t>(end), static_cast<std::uint64_t>(field.height));
    }
}

template <class I, class T>
auto distances_from(const I& index) {
    return [&index](const std::vector<Vec<T, 3>>& points, std::span<double> values) {
        std::vector<Near<T, 3>> near(points.size());
        closest_points(index, points, std::span(near));
        for (std::size_t i = 0; i < near.size(); ++i)
            values[i] = std::sqrt(static_cast<double>(near[i].distance2));
    };
}
template <class I, class T>
auto counts_within(const I& index, T radius) {
    return [&index, radius](const std::vector<Vec<T, 3>>& points, std::span<double> values) {
        std::vector<Sphere<T, 3>> balls;
        balls.reserve(points.size());
        for (const auto& p : points) balls.push_back({p, radius});
        std::vector<std::size_t> counts(points.size());
        overlap_counts(index, balls, std::span(counts));
        for (std::size_t i = 0; i < counts.size(); ++i) values[i] = static_cast<double>(counts[i]);
    };
}
template <class S, class T>
auto sides_of_solid(const S& solid, FieldKind kind) {
    return [&solid, kind](const std::vector<Vec<T, 3>>& points, std::span<double> values) {
        if (kind == FieldKind::winding) {
            winding_numbers(solid, points, values);
            return;
        }
        std::vector<T> distances(points.size());
        signed_distances(solid, points, std::span(distances));
        std::copy(distances.begin(), distances.end(), values.begin());
    };
}

const char* letter(int axis) {
    constexpr const char* letters_of[] = {"x", "y", "z"};
    return letters_of[axis];
}

template <class P>
int draw_field_of(const DrawArguments& a, const P& set) {
    using T = typename P::Scalar;
    const FieldKind kind = parse_field(a.field);
    const bool needs_solid = kind == FieldKind::signed_distance || kind == FieldKind::winding;
    constexpr bool triangles = TriangleSet<ViewOf<P>>;
    if (needs_solid && !triangles)
        throw InputError(fmt::format(
            "{} has no triangles, of which --field {} tells inside and outside: draw its distance or count",
            a.scene, a.field));
    if (set.size() == 0) throw InputError(a.scene + " is empty: there is no field to draw");
    // Place the plane.
    Box<T, 3> box;
    for (std::size_t i = 0; i < set.size(); ++i) box.expand(view_of(set).bounds(i));
    const Upright upright = upright_of(a.view, a, set);
    const FieldPlane plane = field_plane_of(a, {Vec3d(box.low), Vec3d(box.high)}, upright);
    const double radius =
        a.view.radius > 0 ? a.view.radius : (plane.diagonal > 0 ? plane.diagonal / 20 : 1.0);
    FieldValues field;
    field.kind = kind, field.frame = plane.frame;
    field.width = a.width - width_of_legend(a.width);
    field.height = std::max(
        1, static_cast<int>(std::lround(field.width * plane.frame.extent()[1] / plane.frame.extent()[0])));
    field.values.assign(static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height),
                        std::numeric_limits<double>::quiet_NaN());
    // Build the index, and ask it row by row. After an interruption the finished rows are kept.
    const auto index = [&] {
        ProgressLine line("building the index of " + a.scene, a.quiet);
        WatchedExecutor watched(default_executor(), line.progress());
        return build<WideBvh>(set, {}, watched);
    }();
    using I = std::remove_cvref_t<decltype(index)>;
    std::string note;
    ordered_json of_field = ordered_json::object();
    FinishedPicture finished;
    const auto fill_shown = [&](auto ask) {
        ProgressLine line("computing the " + a.field, a.quiet, "rows");
        fill<T>(field, plane.section, line.progress(), ask);
        finished = finish_picture(a.output, line.done() > 0,
                                  line.done() == static_cast<std::uint64_t>(field.height));
    };
    if (kind == FieldKind::distance) {
        fill_shown(distances_from<I, T>(index));
    } else if (kind == FieldKind::count) {
        fill_shown(counts_within<I, T>(index, rounded_to<T>(radius)));
        note = fmt::format("primitives within {:.4g}", radius);
        of_field["radius"] = radius;
    } else if constexpr (triangles) {
        const Solid solid(index);
        fill_shown(sides_of_solid<Solid<I>, T>(solid, kind));
        of_field["closed"] = solid.closed(), of_field["oriented"] = solid.oriented();
        if (!solid.closed())
            note = "the mesh is open: inside is where its winding number is 1/2 or more";
        else if (!solid.oriented())
            note = "neighbours are turned different ways: inside is where the winding number is 1/2 or more";
    }
    // Draw, save and report.
    const FieldScale scale(field);
    const std::string name = kind == FieldKind::signed_distance ? "signed distance"
                             : kind == FieldKind::winding       ? "winding number"
                                                                : a.field;
    const std::string plane_text = fmt::format("{} = {:.6g}", letter(plane.axis), plane.position);
    std::vector<std::string> title = {
        fmt::format("{}, {} over {}", std::filesystem::path(a.scene).filename().string(), name, plane_text),
        fmt::format("from {:.4g} to {:.4g}, a contour each {:.4g}; {} from {:.4g} to {:.4g}, {} upward from "
                    "{:.4g} to {:.4g}",
                    scale.found_low, scale.found_high, scale.step, letter(plane.right), plane.frame.low[0],
                    plane.frame.high[0], letter(plane.up), plane.frame.low[1], plane.frame.high[1])};
    if (!note.empty()) title.push_back(note);
    save_png(finished.output,
             field_picture(field, scale, title, flat_primitives(set, plane.section, 0.01 * plane.diagonal)),
             {}, picture_notes(a.seed));
    if (a.json) {
        ordered_json report = {{"output", finished.output},
                               {"field", a.field},
                               {"axis", letter(plane.axis)},
                               {"position", plane.position},
                               {"right", letter(plane.right)},
                               {"low", {plane.frame.low[0], plane.frame.low[1]}},
                               {"high", {plane.frame.high[0], plane.frame.high[1]}},
                               {"least", scale.found_low},
                               {"most", scale.found_high},
                               {"contour", scale.step}};
        report.update(of_field);
        report["finished"] = finished.whole;
        print_json(report);
    } else if (!a.quiet) {
        fmt::print("{} over {}: from {:.6g} to {:.6g}, a contour each {:.6g}\n{}{}", name, plane_text,
                   scale.found_low, scale.found_high, scale.step, note.empty() ? note : note + "\n",
                   up_text(a.view, a, upright));
    }
    return finished.exit_code();
}

}  // namespace

void check_field(const DrawArguments& a) {
    expect_ending(a, ".png", "a field");
    if (a.field != "count" && a.view.radius > 0)
        throw UsageError("--radius is about --field count: leave it out");
}

template <class T>
int draw_field(const DrawArguments& a, const Scene<T>& scene) {
    return std::visit(
        [&]<class P>(const P& set) -> int {
            if constexpr (P::dimension == 3)
                return draw_field_of(a, set);
            else
                throw InputError(a.scene +
                                 " is flat: a field is drawn over a plane through a scene in space");
        },
        scene);
}
template int draw_field(const DrawArguments&, const Scene<float>&);
template int draw_field(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
