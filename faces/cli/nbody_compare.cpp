/// hedgerow nbody --compare: what ways to find forces cost and how much they err, over numbers of particles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/index.h>
#include <hedgerow/nbody/barnes_hut.h>
#include <hedgerow/nbody/force_check.h>
#include <hedgerow/nbody/forces.h>
#include <hedgerow/nbody/plain_fmm.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/structures/kdtree/point_kdtree.h>
#include <hedgerow/structures/orthtree/point_orthtree.h>

#include "nbody.h"
#include "report/plot.h"
#include "report/table.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;
using Found = std::vector<PotentialAt<double>>;

/// A way to find the forces on all particles, and the method that it is one setting of. Slow ways are not
/// asked for more than so many.
struct Way {
    std::string method, setting;
    std::size_t most;
    std::function<Found(const Particles&)> find;

    std::string name() const { return setting.empty() ? method : method + ", " + setting; }
};

template <template <class, int> class Structure>
Way one_by_one(const std::string& structure, double angle) {
    return {"Barnes-Hut, plain, " + structure, fmt::format("angle {:g}", angle), 100000,
            [angle](const Particles& all) {
                const PointCloud<double, 3> cloud{all.places};
                const auto index = build<Structure>(cloud);
                const BarnesHut method(index, all.masses, angle);
                Found found(all.size());
                default_executor().for_each_piece(all.size(), 64, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) found[i] = method(all.places[i]);
                });
                return found;
            }};
}
template <int order>
Way plain_multipoles() {
    return {"fast multipoles, plain", fmt::format("order {}", order), 100000, [](const Particles& all) {
                const PointCloud<double, 3> cloud{all.places};
                return PlainFmm<order>(0.6)(build<PointOrthtree>(cloud, {.leaf_size = 32}), all.masses);
            }};
}
std::vector<Way> all_ways() {
    const auto charges = [](const Particles& all) { return Charges<double>{all.places, all.masses}; };
    std::vector<Way> ways;
    ways.push_back({"direct sum", "", 300000, [charges](const Particles& all) {
                        Found found(all.size());
                        direct_sum<double>(charges(all), all.places, found);
                        return found;
                    }});
    for (const double angle : {0.7, 0.4}) ways.push_back(one_by_one<PointOrthtree>("octree", angle));
    ways.push_back(one_by_one<PointKdTree>("kd-tree", 0.4));
    for (const double angle : {0.8, 0.55, 0.4, 0.28})
        ways.push_back({"barnes_hut", fmt::format("angle {:g}", angle), largest_scene_size,
                        [charges, angle](const Particles& all) {
                            Found found(all.size());
                            barnes_hut<double>(charges(all), found, {.opening_angle = angle});
                            return found;
                        }});
    ways.push_back(plain_multipoles<2>());
    ways.push_back(plain_multipoles<4>());
    for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9})
        ways.push_back({"forces", fmt::format("within {:.0e}", accuracy), largest_scene_size,
                        [charges, accuracy](const Particles& all) {
                            Found found(all.size());
                            forces<double>(charges(all), found, {.accuracy = accuracy});
                            return found;
                        }});
    return ways;
}

struct Measured {
    double seconds = 0, error = 0;
};
/// The best of some runs.
Measured measured(const Way& way, const Particles& all, const ForceCheck& check) {
    Measured best{std::numeric_limits<double>::infinity(), 0};
    double spent = 0;
    for (int run = 0; run < 5 && (run == 0 || spent < 0.5); ++run) {
        const double began = now();
        const Found found = way.find(all);
        const double seconds = now() - began;
        best.seconds = std::min(best.seconds, seconds), spent += seconds;
        best.error = check.errors_of<double>(found).rms;
    }
    return best;
}
Particles first_of(const Particles& all, std::size_t count) {
    Particles some = all;
    some.resize(count);
    return some;
}

/// Time against error at the greatest number of particles, a line a method.
LinePlot error_plot(const NbodyArguments& a, const std::vector<Way>& ways,
                    const std::vector<std::vector<std::optional<Measured>>>& results,
                    const std::vector<std::size_t>& counts) {
    LinePlot plot{
        fmt::format("{} particles of {}: seconds a particle against the error", counts.back(), a.scene),
        "rms error of the accelerations",
        Unit::seconds,
        {},
        {}};
    for (std::size_t w = 0; w < ways.size(); ++w) {
        const auto& result = results[w].back();
        if (!result || !(result->error > 0)) continue;
        if (plot.series.empty() || plot.series.back().name != ways[w].method)
            plot.series.push_back({ways[w].method, plot.series.size(), {}});
        plot.series.back().points.emplace_back(result->error,
                                               result->seconds / static_cast<double>(counts.back()));
    }
    for (Series& series : plot.series) std::sort(series.points.begin(), series.points.end());
    return plot;
}

}  // namespace

int nbody_compare(const NbodyArguments& a) {
    if (!a.output.empty()) {
        if (ending_of(a.output) != ".svg")
            throw UsageError(a.output + ": the plot of a comparison is written as .svg");
        check_writable(a.output);
    }
    const Particles all = load_particles(a).particles;
    if (all.size() < 2) throw InputError(a.scene + ": a comparison needs some particles");
    std::vector<std::size_t> counts;
    for (std::size_t n = all.size(); n >= std::min<std::size_t>(500, all.size()); n /= 4)
        counts.insert(counts.begin(), n);
    const std::vector<Way> ways = all_ways();
    std::vector<std::vector<std::optional<Measured>>> results(ways.size());
    {
        ProgressLine line("comparing", a.quiet);
        for (const std::size_t n : counts) {
            const Particles some = first_of(all, n);
            const ForceCheck check(Charges<double>{some.places, some.masses});
            for (std::size_t w = 0; w < ways.size(); ++w) {
                line.say(fmt::format("{}, {} particles", ways[w].name(), n));
                line.progress().look();
                results[w].push_back(n <= ways[w].most ? std::optional(measured(ways[w], some, check))
                                                       : std::nullopt);
            }
        }
    }
    // Report times a particle, the error at the greatest number, and where each overtakes the direct sum.
    Table table{
        fmt::format("{}: microseconds a particle", a.scene),
        "Errors are the rms of those of accelerations as shares of them. A way overtakes the direct sum from "
        "the first number on at which it is faster.",
        {"way"},
        {}};
    for (const std::size_t n : counts) table.columns.push_back(std::to_string(n));
    table.columns.insert(table.columns.end(), {"rms error", "overtakes at"});
    ordered_json json = ordered_json::array();
    for (std::size_t w = 0; w < ways.size(); ++w) {
        std::vector<std::string> row{ways[w].name()};
        ordered_json of_way{{"way", ways[w].name()}, {"results", ordered_json::array()}};
        std::size_t overtakes = 0;  // 0: not
        double error = 0;
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const auto& result = results[w][k];
            if (!result) {
                row.emplace_back("");
                continue;
            }
            error = result->error;
            row.push_back(fmt::format("{:.3g}", result->seconds / static_cast<double>(counts[k]) * 1e6));
            of_way["results"].push_back(
                {{"particles", counts[k]}, {"seconds", result->seconds}, {"error", result->error}});
            if (w > 0 && results[0][k] && result->seconds < results[0][k]->seconds) {
                if (overtakes == 0) overtakes = counts[k];
            } else if (w > 0 && results[0][k]) {
                overtakes = 0;
            }
        }
        row.push_back(fmt::format("{:.1e}", error));
        row.push_back(overtakes > 0 ? std::to_string(overtakes) : "");
        if (overtakes > 0) of_way["overtakes_direct_sum_at"] = overtakes;
        table.rows.push_back(row), json.push_back(of_way);
    }
    if (!a.output.empty()) save_text(a.output, svg_of(error_plot(a, ways, results, counts)));
    if (a.json)
        print_json({{"scene", a.scene}, {"ways", json}});
    else
        fmt::print("{}", text_of(table));
    return 0;
}

}  // namespace hedgerow::cli
