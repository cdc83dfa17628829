#include "ray_drawing.h"
#include "report/xml.h"

namespace hedgerow::cli {

namespace {

constexpr std::string_view page_style = R"(<style>
body{font-family:'DejaVu Sans',Helvetica,Arial,sans-serif;margin:16px;color:#222}
main{display:flex;flex-wrap:wrap;gap:20px}
table{border-collapse:collapse;font-size:12px}
td,th{padding:2px 8px;text-align:left;white-space:nowrap;border-bottom:1px solid #eee}
td:last-child{white-space:normal}
tbody tr{cursor:pointer}tr.now{background:#ffe9b8}tr.later{color:#aaa}
.rows{max-height:760px;overflow:auto}
.step{visibility:hidden}.step.past{visibility:visible;opacity:.25}.step.now{visibility:visible}
.step.past .interval,.step.past .tested{visibility:hidden}
#now{min-height:1.3em;font-weight:bold}
</style>
)";
constexpr std::string_view page_script = R"(<script>
const rows = [...document.querySelectorAll('tbody tr')], slider = document.getElementById('slider');
let now = 1;
function show(step) {
  now = Math.max(1, Math.min(rows.length, step));
  rows.forEach((row, i) => {
    row.className = i + 1 < now ? 'past' : i + 1 > now ? 'later' : 'now';
    document.getElementById('step' + (i + 1)).setAttribute('class', 'step ' + row.className);
  });
  slider.value = now;
  document.getElementById('where').textContent = now + ' of ' + rows.length;
  if (rows.length) {
    const [step, node, level, kind, box, t, limit] = [...rows[now - 1].children].map(c => c.textContent);
    document.getElementById('now').textContent =
      `${kind} ${node}, level ${level} \u2014 box ${box} \u2014 t in ${t}, up to the limit ${limit}`;
  }
  if (rows.length) rows[now - 1].scrollIntoView({block: 'nearest'});
}
rows.forEach((row, i) => row.addEventListener('click', () => show(i + 1)));
slider.addEventListener('input', () => show(+slider.value));
document.getElementById('back').addEventListener('click', () => show(now - 1));
document.getElementById('next').addEventListener('click', () => show(now + 1));
document.addEventListener('keydown', e => {
  if (e.key === 'ArrowRight') show(now + 1); else if (e.key === 'ArrowLeft') show(now - 1); else return;
  e.preventDefault();
});
show(1);
</script>
)";

std::string drawing_of(const FlatScene& scene, const RayView& view) {
    // Draw what all steps share: the pale cells and tree, and the ray.
    const Layout layout(scene.width, scene.height,
                        {NamedStructure{view.structure.name, {view.table.summary()}, {}}});
    const RayFrame frame(scene, {view});
    Svg svg(scene.width, scene.height, RayDrawing::style());
    add_definitions(svg);
    svg.text({picture_margin, 32}, scene.title, "class=\"title\"");
    RayDrawing drawing(svg, scene, view, frame, layout.area(0));
    drawing.ground();
    drawing.ray();
    // Draw each step in a group, which the script shows and hides.
    for (std::size_t i = 0; i < view.table.rows.size(); ++i) {
        svg.open_group(fmt::format("class=\"step\" id=\"step{}\"", i + 1));
        drawing.cell(i);
        svg.open_group("class=\"interval\"");
        drawing.interval(i);
        svg.close_group();
        drawing.tests(i);
        drawing.node(i);
        svg.close_group();
    }
    drawing.hit();
    layout.draw_caption(svg, 0);
    RayDrawing::add_legend(svg, layout.legend(), false, !view.structure.tree.nodes.empty());
    return svg.finished();
}

}  // namespace

std::string ray_page(const FlatScene& scene, const RayView& view) {
    const auto& rows = view.table.rows;
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
        "charset=\"utf-8\"/><title>{}</title>\n{}</head><body>\n"
        "<p><button id=\"back\">back</button> <input id=\"slider\" type=\"range\" min=\"1\" max=\"{}\" "
        "value=\"1\"/> <button id=\"next\">next</button> step <span id=\"where\"></span> (arrow keys, or "
        "click a row)</p>\n<p id=\"now\"></p>\n<main>\n{}<div class=\"rows\"><table><thead><tr>",
        escaped(scene.title), page_style, std::max<std::size_t>(1, rows.size()), drawing_of(scene, view));
    for (const auto name : table_columns()) page += fmt::format("<th>{}</th>", name);
    page += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        page += "<tr>";
        for (const auto& cell : texts_of(rows[i], i + 1)) page += fmt::format("<td>{}</td>", escaped(cell));
        page += "</tr>\n";
    }
    return page + "</tbody></table></div>\n</main>\n" + std::string(page_script) + "</body></html>\n";
}

}  // namespace hedgerow::cli
