/// Two outlines in a plane through the points where they are farthest from each other, as SVG.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/ask/hausdorff.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/text_file.h>

#include "draw.h"
#include "picture_parts.h"
#include "ray_option.h"
#include "section.h"

namespace hedgerow::cli {

namespace {

std::string name_of(const std::string& scene) {
    return std::filesystem::path(scene).filename().string();
}
std::string style() {
    return std::string(plain_style()) +
           ".a.line{stroke:#16181d}.a.dot{fill:#16181d}.b.line{stroke:#2f7fd0}.b.dot{fill:#2f7fd0}\n"
           ".apart{stroke:#d0103a;stroke-width:2.2}.far{fill:#d0103a}\n"
           ".label{paint-order:stroke;stroke:#fff;stroke-width:3px}\n"
           ".reach{fill:none;stroke:#d0103a;stroke-width:1;stroke-dasharray:4 4;stroke-opacity:.6}\n";
}

Section<2> turned_upright(const Section<2>& section, const Upright&) {
    return section;
}
/// The plane of a section, with the picture's axes turned so that the scene's upward direction points up.
Section<3> turned_upright(Section<3> section, const Upright& upright) {
    const Vec3d normal = cross(section.right, section.up);
    Vec3d up;
    up[upright.axis] = 1;
    section.up = normalized(up - normal * dot(up, normal));
    section.right = cross(section.up, normal);
    return section;
}

template <class A, class B>
int draw_far(const DrawArguments& a, const A& set, const B& other) {
    using T = typename A::Scalar;
    constexpr int D = A::dimension;
    const auto one = build<WideBvh>(set);
    const auto two = build<WideBvh>(other);
    const Hausdorff<T, D> far = hausdorff_distance(one, two);
    if (!far) throw InputError("one of the scenes is empty, and nothing is far from it");
    if (far.point_a == far.point_b)
        throw InputError(
            fmt::format("{} and {} are the same set: they are nowhere apart", a.scene, a.hausdorff));
    // The plane has the two points in it, and stands upright.
    const auto &from = far.from_b ? far.point_b : far.point_a, &to = far.from_b ? far.point_a : far.point_b;
    const Vec<double, D> start(from), end(to);
    const Upright upright = upright_of(a.view, a, set);
    const auto section = turned_upright(section_along(Ray<T, D>{from, to - from}, upright), upright);
    Box<double, D> bounds{Vec<double, D>(one.bounds().low), Vec<double, D>(one.bounds().high)};
    bounds.expand(Vec<double, D>(two.bounds().low)).expand(Vec<double, D>(two.bounds().high));
    const FlatScene scene = flat_scene(a, set, section, bounds),
                    beside = flat_scene(a, other, section, bounds);
    // Draw both outlines, and the line between the points.
    const auto number = fmt::format("{:.4g}", length(end - start));
    const std::string fact = fmt::format(
        "a point of {} is {} from all of {}; no point of either is more than {:.5g} from the other",
        name_of(far.from_b ? a.hausdorff : a.scene), number, name_of(far.from_b ? a.scene : a.hausdorff),
        far.upper);
    const Layout layout(scene.width, scene.height, {{"", {fact}, {}}});
    FlatScene all = scene;
    all.primitives.insert(all.primitives.end(), beside.primitives.begin(), beside.primitives.end());
    Box2d frame = frame_of(all, {});
    frame.expand(section.flat(start)).expand(section.flat(end));
    const Panel panel(frame, layout.area(0));
    Svg svg(scene.width, scene.height, style());
    svg.text({picture_margin, 32},
             fmt::format("{} and {}: where they are farthest", name_of(a.scene), name_of(a.hausdorff)),
             "class=\"title\"");
    draw_primitives(svg, panel, scene.primitives, 1, " a");
    draw_primitives(svg, panel, beside.primitives, 1, " b");
    const Vec2d p = panel(section.flat(start)), q = panel(section.flat(end));
    svg.circle(p, length(q - p), "class=\"reach\"");
    svg.line(p, q, "class=\"apart\"");
    svg.circle(p, 4.5, "class=\"far\""), svg.circle(q, 3, "class=\"far\"");
    svg.text(p + normalized(p - q) * 12.0 + Vec2d(0, 4), number,
             fmt::format("class=\"name label\" text-anchor=\"{}\"", p[0] < q[0] ? "end" : "start"));
    layout.draw_caption(svg, 0);
    Legend legend(svg, layout.legend());
    const auto line = [&](std::string_view text, const std::string& look) {
        legend.line(text, [&](const Box2d& b) {
            svg.line({b.low[0], b.center()[1]}, {b.high[0], b.center()[1]}, look);
        });
    };
    line(name_of(a.scene), "class=\"a line\" stroke-width=\"1.6\"");
    line(name_of(a.hausdorff), "class=\"b line\" stroke-width=\"1.6\"");
    line("farthest point", "class=\"apart\"");
    save_text(a.output, svg.finished());
    if (a.json)
        print_json(
            {{"output", a.output}, {"lower", far.lower}, {"upper", far.upper}, {"from_b", far.from_b}});
    else if (!a.quiet)
        fmt::print("{}\n", fact);
    return 0;
}

}  // namespace

template <class T>
int draw_hausdorff(const DrawArguments& a, const Scene<T>& scene) {
    expect_ending(a, ".svg", "two outlines");
    Common of_other = a;
    of_other.scene = a.hausdorff;
    const Scene<T> other = load<T>(of_other);
    return std::visit(
        [&]<class A, class B>(const A& set, const B& with) -> int {
            if constexpr (FarFrom<ViewOf<A>, ViewOf<B>> && FarFrom<ViewOf<B>, ViewOf<A>>)
                return draw_far(a, set, with);
            else
                throw InputError(fmt::format(
                    "{} and {}: --hausdorff is of triangles or points in one space. Name such scenes",
                    a.scene, a.hausdorff));
        },
        scene, other);
}
template int draw_hausdorff(const DrawArguments&, const Scene<float>&);
template int draw_hausdorff(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
