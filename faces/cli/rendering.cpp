#include "rendering.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kernel_use.h"

namespace hedgerow::cli {

namespace {

void report(const RenderArguments& a, const Outcome& o) {
    const Picture& p = o.picture;
    const PictureCosts& costs = p.costs;
    const double rays = double(std::max<std::uint64_t>(costs.rays, 1));
    const double samples = double(p.image.width) * double(p.image.height) * double(a.spp);
    const auto a_ray = [&](std::uint64_t count) { return double(count) / rays; };
    if (a.json) {
        nlohmann::ordered_json j = {{"structure", a.structure},
                                    {"visibility", a.visibility},
                                    {"output", o.finished.output},
                                    {"width", p.image.width},
                                    {"height", p.image.height},
                                    {"primitives", o.primitives},
                                    {"bytes", o.bytes},
                                    {o.loaded ? "load_seconds" : "build_seconds", o.build_seconds},
                                    {"up", {o.up[0], o.up[1], o.up[2]}},
                                    {"rays", costs.rays},
                                    {"rays_by", rays_by(costs.use)},
                                    {"seconds", o.seconds},
                                    {"rays_per_second", rays / o.seconds},
                                    {"finished", o.finished.whole}};
        if (o.counted) {
            j["nodes_per_ray"] = a_ray(costs.visits.nodes);
            j["leaves_per_ray"] = a_ray(costs.visits.leaves);
            j["primitives_per_ray"] = a_ray(costs.visits.primitives);
        }
        if (a.uses_cones()) j["cones"] = costs.cones;
        if (a.transparent) j["layers"] = costs.layers.layers, j["samples_ended"] = costs.layers.ended;
        if (a.uses_beams()) {
            j["beams"] = costs.beams.beams;
            j["visits_of_beams"] = costs.beams.visits;
            j["samples_filled"] = costs.beams.filled;
        }
        if (a.rasterises()) {
            j["triangles_drawn"] = costs.drawn.triangles;
            j["triangles_outside"] = costs.drawn.outside;
        }
        print_json(j);
    } else if (!a.quiet) {
        fmt::print("{}: {}x{}, {} primitives", o.finished.output, p.image.width, p.image.height,
                   o.primitives);
        if (o.indexed)
            fmt::print(", {} {} in {:.1f} ms, {:.1f} bytes a primitive", a.structure,
                       o.loaded ? "loaded" : "built", o.build_seconds * 1e3,
                       double(o.bytes) / double(std::max<std::size_t>(1, o.primitives)));
        fmt::print("\n");
        if (costs.beams.beams > 0)
            fmt::print("{} beams, {:.0f}% of the samples without a packet; ", costs.beams.beams,
                       100 * double(costs.beams.filled) / samples);
        if (a.transparent)
            fmt::print("{} layers, {:.1f}% of the samples end before their last; ", costs.layers.layers,
                       100 * double(costs.layers.ended) / samples);
        if (a.rasterises())
            fmt::print("{} triangles drawn, {} of them outside of the picture; ", costs.drawn.triangles,
                       costs.drawn.outside);
        if (a.uses_cones()) fmt::print("{} cones and ", costs.cones);
        fmt::print("{} rays in {:.3f} s", costs.rays, o.seconds);
        if (costs.rays > 0 && !a.uses_cones())
            fmt::print(": {:.3f} million a second", rays / o.seconds * 1e-6);
        if (costs.use.packets + costs.use.phased > 0) fmt::print("; {}", most_used(costs.use, costs.rays));
        if (o.counted)
            fmt::print("; a ray visits {:.1f} nodes, {:.1f} leaves, {:.1f} primitives",
                       a_ray(costs.visits.nodes), a_ray(costs.visits.leaves), a_ray(costs.visits.primitives));
        fmt::print("\n{}", up_text(a.view, a, o.upright));
    }
}

}  // namespace

int save_and_report(const RenderArguments& a, Outcome o) {
    o.finished = finish_picture(a.output, o.picture.pixels > 0, o.picture.whole);
    save(o.finished.output, o.picture, a.seed);
    report(a, o);
    return o.finished.exit_code();
}

RenderOptions options_of(const RenderArguments& a, const Box3f& bounds, const Upright& upright) {
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.view.size);
    options.samples = a.spp, options.seed = a.seed, options.scale.top = a.steps_max;
    options.shading = a.shading_of_rays();
    options.layers = a.layers, options.counts = a.counts;
    options.refines = a.refines;
    options.footprints = a.footprints || a.cones;
    options.cones = a.cones, options.light_degrees = a.light_degrees;
    options.transparent = a.transparent, options.opacity = a.opacity;
    options.camera = camera_of(a.view, a, bounds, upright);
    return options;
}

}  // namespace hedgerow::cli
