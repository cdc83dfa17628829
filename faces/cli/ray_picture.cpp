#include "ray_drawing.h"

namespace hedgerow::cli {

std::string ray_picture(const FlatScene& scene, const std::vector<RayView>& views) {
    std::vector<NamedStructure> captions;
    bool trees = false;
    for (const auto& v : views) {
        captions.push_back({v.structure.name, {v.table.summary()}, {}});
        trees = trees || !v.structure.tree.nodes.empty();
    }
    // Lay the panels out. All have one frame, so that they can be compared.
    const Layout layout(scene.width, scene.height, captions, trees ? 1 : 0);
    const RayFrame frame(scene, views);
    Svg svg(scene.width, scene.height, RayDrawing::style());
    add_definitions(svg);
    svg.text({picture_margin, 32}, scene.title, "class=\"title\"");
    for (std::size_t s = 0; s < views.size(); ++s) {
        // Draw the visited cells over all others, then the tested primitives, and the ray on top.
        RayDrawing drawing(svg, scene, views[s], frame, layout.area(s));
        drawing.ground();
        const std::size_t steps = views[s].table.rows.size();
        for (std::size_t i = 0; i < steps; ++i) drawing.cell(i);
        for (std::size_t i = 0; i < steps; ++i) drawing.tests(i);
        for (std::size_t i = 0; i < steps; ++i) drawing.node(i);
        drawing.ray();
        drawing.hit();
        drawing.numbers();
        layout.draw_caption(svg, s);
    }
    RayDrawing::add_legend(svg, layout.legend(), true, trees);
    return svg.finished();
}

}  // namespace hedgerow::cli
