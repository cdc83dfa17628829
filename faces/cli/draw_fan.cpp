/// A fan of rays, as SVG: the cells in which each ray's walk ends, or the parts into which a beam divides.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/ask/families.h>
#include <hedgerow/base/error.h>
#include <hedgerow/io/text_file.h>

#include "draw.h"
#include "fan_picture.h"
#include "ray_option.h"
#include "section.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

template <class T, int D>
FlatFan flat_fan(const std::vector<Ray<T, D>>& rays, const Section<D>& section) {
    FlatFan fan;
    fan.origin = section.flat(Vec<double, D>(rays.front().origin));
    for (const auto& r : rays)
        fan.directions.push_back(section.flat(Vec<double, D>(r.origin) + Vec<double, D>(r.direction)) -
                                 fan.origin);
    fan.hits.resize(rays.size());
    return fan;
}

/// Traces the rays in a structure, and writes the t of their hits to the fan.
template <class P, int D>
FanView view_of(const DrawArguments& a, const std::string& spec, const P& set,
                const std::vector<Ray<typename P::Scalar, D>>& rays, const Section<D>& section, FlatFan& fan,
                Box<double, D>& bounds) {
    const auto index = build_shown(a, spec, set);
    bounds = bounds_of(*index);
    FanView view{{spec, {}, {}}, {}, {}};
    const auto cells = index->outline(section.limits(a.levels > 0 ? a.levels : OutlineLimits<D>().levels));
    if (cells.size() <= most_behind) view.structure.flat = flat_structure(cells, section);
    std::size_t hits = 0;
    Visits visits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto walked = trace(*index, rays[i]);
        visits += walked.visits;
        if (walked.hit) fan.hits[i] = static_cast<double>(walked.hit.t), ++hits;
        bool ended = false;
        for (const auto& step : walked.steps) {
            if (!step.cell.leaf) continue;
            ++view.looked_into[step.cell.id];
            for (const auto& test : step.tests)
                if (walked.hit && !ended && test.id == walked.hit.element && test.t)
                    ++view.ended[step.cell.id], ended = true;
        }
    }
    view.structure.facts = {
        fmt::format("{} of {} rays end at a hit, in {} leaves; they look into {} of {} leaves, and visit "
                    "{:.1f} cells each",
                    hits, rays.size(), view.ended.size(), view.looked_into.size(), index->leaf_count(),
                    static_cast<double>(visits.nodes + visits.leaves) / static_cast<double>(rays.size()))};
    return view;
}

/// Halves a beam until each part sees one segment alone, or nothing, or is of two rays (Heckbert and Hanrahan
/// 1984, with halves instead of the outlines of what the beam meets).
template <class I>
class BeamDivision {
public:
    using T = typename I::Scalar;

    BeamDivision(const I& index, const std::vector<Ray<T, 2>>& rays) : index_(index), rays_(rays) {
        for (const auto& ray : rays) hits_.push_back(closest_hit(index, ray));
        divide(0, rays.size() - 1, 0);
    }
    const std::vector<BeamPart>& parts() const { return parts_; }
    const std::vector<Hit<T>>& hits() const { return hits_; }
    /// How many beams were asked what they may hit.
    std::size_t asked() const { return asked_; }

private:
    void divide(std::size_t first, std::size_t last, int level) {
        using Sees = BeamPart::Sees;
        const Hit<T>&low = hits_[first], &high = hits_[last];
        bool whole = low.element == high.element;  // both may be no primitive
        if (whole) {
            // Nothing else may be nearer than the segment that both rays hit.
            const FrustumRays<T, 2> beam({rays_[first], rays_[last]});
            const double most = std::max(low ? beam.depth_of(rays_[first], low.t) : 0,
                                         high ? beam.depth_of(rays_[last], high.t) : 0);
            candidates(index_, beam, found_,
                       {.limit = low ? static_cast<double>(rounded_up<T>(most)) : FamilyOptions().limit});
            ++asked_;
            for (const auto& c : found_) whole = whole && c.element == low.element;
        }
        if (whole || last - first < 2) {
            parts_.push_back({first, last, level,
                              !whole ? Sees::undecided
                              : low  ? Sees::one
                                     : Sees::nothing});
            return;
        }
        const std::size_t middle = first + (last - first) / 2;
        divide(first, middle, level + 1), divide(middle, last, level + 1);
    }

    const I& index_;
    const std::vector<Ray<T, 2>>& rays_;
    std::vector<Hit<T>> hits_;
    std::vector<BeamPart> parts_;
    std::vector<FamilyCandidate<T>> found_;
    std::size_t asked_ = 0;
};

template <class P>
int draw_beam_in(const DrawArguments& a, const P& set) {
    using T = typename P::Scalar;
    if constexpr (P::dimension == 2 && !PointSet<ViewOf<P>>) {
        expect_ending(a, ".svg", "a beam");
        const Section<2> section;
        const auto rays = fan_of(a, ray_of<T, 2>(a), section);
        const auto index = build<WideBvh>(set);
        const BeamDivision division(index, rays);
        FlatFan fan = flat_fan(rays, section);
        for (std::size_t i = 0; i < rays.size(); ++i)
            if (const auto& hit = division.hits()[i]) fan.hits[i] = static_cast<double>(hit.t);
        FlatScene scene =
            flat_scene(a, set, section, Box2d{Vec2d(index.bounds().low), Vec2d(index.bounds().high)});
        scene.title += ": a beam that divides";
        const auto fact = fmt::format("a beam of {} rays ends as {} parts, after {} beams were asked",
                                      rays.size(), division.parts().size(), division.asked());
        save_text(a.output, beam_picture(scene, fan, division.parts(), fact));
        if (a.json)
            print_json({{"output", a.output},
                        {"rays", rays.size()},
                        {"parts", division.parts().size()},
                        {"asked", division.asked()}});
        else if (!a.quiet)
            fmt::print("{}\n", fact);
        return 0;
    } else {
        throw InputError(a.scene + ": --beam divides in a flat scene of segments, as gen:segments2d");
    }
}

template <class P>
int draw_fan_in(const DrawArguments& a, const P& set) {
    constexpr int D = P::dimension;
    expect_ending(a, ".svg", "a fan of rays");
    const auto middle = ray_of<typename P::Scalar, D>(a);
    const auto section = section_along(middle, upright_of(a.view, a, set));
    const auto rays = fan_of(a, middle, section);
    FlatFan fan = flat_fan(rays, section);
    std::vector<FanView> views;
    Box<double, D> bounds;
    for (const auto& spec : structures_of(a))
        views.push_back(view_of(a, spec, set, rays, section, fan, bounds));
    FlatScene scene = flat_scene(a, set, section, bounds);
    scene.title += D == 2 ? ": where rays end" : ": where rays end, in a plane along them";
    save_text(a.output, fan_picture(scene, fan, views));
    ordered_json report = ordered_json::array();
    for (const auto& v : views) {
        report.push_back({{"structure", v.structure.name},
                          {"leaves_looked_into", v.looked_into.size()},
                          {"leaves_of_hits", v.ended.size()}});
        if (!a.json && !a.quiet) fmt::print("{}: {}\n", v.structure.name, v.structure.facts.front());
    }
    if (a.json) print_json({{"output", a.output}, {"rays", rays.size()}, {"structures", report}});
    return 0;
}

}  // namespace

template <class T>
int draw_fan(const DrawArguments& a, const Scene<T>& scene) {
    return std::visit([&](const auto& set) { return a.beam ? draw_beam_in(a, set) : draw_fan_in(a, set); },
                      scene);
}
template int draw_fan(const DrawArguments&, const Scene<float>&);
template int draw_fan(const DrawArguments&, const Scene<double>&);

}  // namespace hedgerow::cli
