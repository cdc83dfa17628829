/// hedgerow flow: moves a fluid, with snapshots, pictures, surfaces and a log in a folder.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/fluid/fluid_measures.h>
#include <hedgerow/fluid/surface_of.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/text_file.h>

#include "flow.h"
#include "picture_notes.h"
#include "run_folder.h"
#include "snapshot_rows.h"
#include "view.h"

namespace hedgerow::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view columns_of_flow_log =
    "step,time,kinetic,potential,fastest,mean_compression,compression_of_most,leaks,seconds";
constexpr int log_lines_per_snapshot = 10;

/// Calls f(name, number) for the columns of a particle in a snapshot.
template <int D, class State, class F>
void each_column(State& s, std::size_t i, F&& f) {
    constexpr const char* places[] = {"x", "y", "z"};
    constexpr const char* velocities[] = {"vx", "vy", "vz"};
    constexpr const char* accelerations[] = {"ax", "ay", "az"};
    for (int k = 0; k < D; ++k) f(places[k], s.places[i].data[k]);
    for (int k = 0; k < D; ++k) f(velocities[k], s.velocities[i].data[k]);
    for (int k = 0; k < D; ++k) f(accelerations[k], s.accelerations[i].data[k]);
    f("compression", s.compressions[i]), f("compression_rate", s.compression_rates[i]);
}
/// What the file has beside them, which follows from the state.
struct Derived {
    double mass, density, pressure, time;
    template <class F>
    void each(F&& f) {
        f("mass", mass), f("density", density), f("pressure", pressure), f("time", time);
    }
};
template <int D, class State, class F>
void each_column_with_derived(State& s, std::size_t i, Derived derived, F&& f) {
    each_column<D>(s, i, f);
    derived.each(f);
}
template <int D>
ColumnList snapshot_columns() {
    ColumnList list;
    FluidState<D> one;
    one.resize(1);
    each_column_with_derived<D>(one, 0, {}, list);
    return list;
}
template <int D>
void save_snapshot(const std::filesystem::path& path, const FluidFlow<D>& flow) {
    const FluidState<D>& state = flow.state();
    const double density = flow.options().rest_density;
    save_snapshot_rows(path, snapshot_columns<D>(), state.size(), [&](std::size_t i, Record& record) {
        const Derived derived = {flow.mass(), density * (1 + state.compressions[i]), flow.pressure(i),
                                 state.time};
        each_column_with_derived<D>(state, i, derived,
                                    [&](const char* name, double number) { record(name, number); });
    });
}
template <int D>
FluidState<D> load_snapshot(const std::filesystem::path& path) {
    FluidState<D> state;
    load_snapshot_rows(path, snapshot_columns<D>(), [&](const double* next) {
        const std::size_t i = state.size();
        state.resize(i + 1);
        each_column<D>(state, i, [&](const char*, double& number) { number = *next++; });
        state.time = next[3];
    });
    return state;
}

/// What run.json holds. `visit` is called with the name and the value of each option.
template <class Arguments, class Visit>
void each_flow_option(Arguments& a, Visit visit) {
    visit("scene", a.scene), visit("seed", a.seed), visit("drop_bad", a.drop_bad), visit("plane", a.plane);
    visit("walls", a.walls), visit("inflow", a.inflow), visit("inflow_velocity", a.inflow_velocity),
        visit("up", a.up), visit("spacing", a.spacing), visit("sound", a.sound);
    visit("viscosity", a.viscosity), visit("gravity", a.gravity), visit("until", a.until);
    visit("every", a.every), visit("colour", a.colour), visit("size", a.size), visit("surface", a.surface);
    visit("floor", a.floor);
}

constexpr std::string_view materials_of_surfaces =
    "# Clear water. Without the exponent it would be rough.\n"
    "newmtl water\nKd 1 1 1\nKs 1 1 1\nNi 1.33\nNs 1000000\nd 0\nillum 7\n"
    "newmtl floor\nKd 0.7 0.66 0.6\n";

/// The files that a run writes as it goes on.
template <int D>
class FlowRecorder {
public:
    FlowRecorder(const FlowArguments& a, const RunFolder& folder, std::uint64_t step,
                 const FlowScene<D>& scene)
        : a_(a),
          folder_(folder),
          scene_(scene),
          size_(flow_picture_size(a, scene)),
          log_(folder, columns_of_flow_log, a.resume ? std::optional(step) : std::nullopt),
          began_(now()) {}
    /// Writes a line, and keeps the worst of all.
    FluidMeasures<D> line(std::uint64_t step, const FluidFlow<D>& flow) {
        const auto m = measures(flow);
        const std::size_t outside = leaks(scene_, flow.state());
        log_.line(fmt::format("{},{},{},{},{},{},{},{},{:.3f}", step, flow.state().time, m.kinetic,
                              m.potential, m.fastest, m.mean_compression, m.compression_of_most, outside,
                              now() - began_));
        worst_mean = std::max(worst_mean, m.mean_compression);
        dense += m.dense, far_from_rest += m.far_from_rest;
        most_leaks = std::max(most_leaks, outside);
        return m;
    }
    void snapshot(std::uint64_t step, const FluidFlow<D>& flow) {
        if (size_)
            save_png(folder_.picture(step),
                     flow_picture(a_, scene_, flow.state(), size_->first, size_->second), {},
                     picture_notes(a_.seed));
        if constexpr (D == 3)
            if (!a_.surface.empty()) save_surface(step, flow);
        // Last: a run goes on behind its last snapshot, and makes what comes before it again.
        save_snapshot(folder_.snapshot(step), flow);
    }
    /// Writes up to twelve pictures of the run side by side.
    void sheet() const {
        if (!size_) return;
        const auto steps = folder_.steps();
        constexpr std::size_t most = 12, in_a_row = 4;
        const std::size_t count = std::min(steps.size(), most);
        if (count < 2) return;
        const int width = 360, height = std::max(1, width * size_->second / size_->first), gap = 6;
        const auto columns = static_cast<int>(std::min(in_a_row, count)),
                   rows = static_cast<int>((count + in_a_row - 1) / in_a_row);
        Image all(columns * (width + gap) - gap, rows * (height + gap) - gap, {255, 255, 255});
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t step = steps[i * (steps.size() - 1) / (count - 1)];
            const auto state = load_snapshot<D>(folder_.snapshot(step));
            paste(flow_picture(a_, scene_, state, width, height), all,
                  static_cast<int>(i % in_a_row) * (width + gap),
                  static_cast<int>(i / in_a_row) * (height + gap));
        }
        save_png(folder_.file("sheet.png"), all, {}, picture_notes(a_.seed));
    }

    /// The share of particles, over all lines, whose density is more than a twentieth from that at rest.
    double share_far_from_rest() const {
        return dense > 0 ? static_cast<double>(far_from_rest) / static_cast<double>(dense) : 0;
    }

    double worst_mean = 0;
    std::size_t most_leaks = 0, dense = 0, far_from_rest = 0;

private:
    void save_surface(std::uint64_t step, const FluidFlow<D>& flow) {
        PointSurfaceOptions options;
        options.spacing = flow.options().spacing;
        const auto surface = surface_of(flow.state().places, options);
        SavedLooks looks{Strided<Vec3f>(surface.normals), "", ""};
        if (a_.surface == "obj") {
            save_text(folder_.file("water.mtl"), std::string(materials_of_surfaces));
            looks.material_file = "water.mtl", looks.material = "water";
        }
        const fs::path path = folder_.file(fmt::format("surface-{:07}.{}", step, a_.surface));
        save_mesh(path, surface.mesh, {}, nullptr, looks);
        if (!a_.floor) return;
        std::ifstream in(path, std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(in), {}};
        save_text(path, text + floor_below(surface.mesh.vertices.size()));
    }
    /// A floor a spacing below the tank and five times as wide, as lines of an OBJ after so many vertices.
    std::string floor_below(std::size_t vertices) const {
        const int up = scene_.up, right = up == 0 ? 1 : 0, back = 3 - up - right;
        const Vec3d middle = scene_.tank.center(), reach = scene_.tank.extent() * 2.5;
        std::string text;
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            Vec3d p;
            p[right] = middle[right] + x * reach[right], p[back] = middle[back] + y * reach[right];
            p[up] = scene_.tank.low[up] - scene_.options.spacing;
            text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
        }
        // Counterclockwise as seen from above.
        const bool turned = up == 1;
        const std::size_t a = vertices + 1, b = vertices + (turned ? 4 : 2), d = vertices + (turned ? 2 : 4);
        return text + fmt::format("usemtl floor\nf {} {} {} {}\n", a, b, vertices + 3, d);
    }

    const FlowArguments& a_;
    const RunFolder& folder_;
    const FlowScene<D>& scene_;
    std::optional<std::pair<int, int>> size_;
    RunLog log_;
    double began_;
};

/// Goes on from a step, until the time is reached or the run is interrupted. Returns the last step, and adds
/// up what was moved. Steps end at lines of the log, which have times of their own.
template <int D>
std::uint64_t move_fluid(const FlowArguments& a, const FlowScene<D>& scene, FluidFlow<D>& flow,
                         FlowRecorder<D>& recorder, std::uint64_t step, std::uint64_t& moved) {
    Vec<double, D> inflow_velocity;
    for (int k = 0; k < D; ++k) inflow_velocity[k] = a.inflow_velocity[static_cast<std::size_t>(k)];
    const double from = flow.state().time, of_line = a.every / log_lines_per_snapshot;
    auto line = static_cast<std::uint64_t>(std::floor(from / of_line * (1 + 1e-12) + 1e-9)) + 1;
    return go_on({.doing = "moving the fluid",
                  .finished = [&] { return !(flow.state().time < a.until); },
                  .step =
                      [&](std::uint64_t number) {
                          const double next = std::min(a.until, static_cast<double>(line) * of_line);
                          if (!scene.inflow.empty()) flow.pour(scene.inflow, inflow_velocity);
                          flow.step_towards(next);
                          moved += flow.state().size();
                          if (flow.state().time < next) return false;
                          recorder.line(number, flow);
                          return line++ % log_lines_per_snapshot == 0 || next == a.until;
                      },
                  .snapshot = [&](std::uint64_t number) { recorder.snapshot(number, flow); },
                  .share = [&] { return (flow.state().time - from) / (a.until - from); }},
                 step, a.quiet);
}

/// The pressures of a fluid that has come to rest, beside those of its weight, in words; that it moves, while
/// it does.
template <int D>
std::string hydrostatics(const FlowScene<D>& scene, const FluidFlow<D>& flow, bool& kept) {
    const FluidState<D>& state = flow.state();
    const double g = length(scene.options.gravity), n = static_cast<double>(state.size());
    double surface = -1e300, low = 1e300, speeds = 0, errors = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
        surface = std::max(surface, state.places[i][scene.up]),
        low = std::min(low, state.places[i][scene.up]);
        speeds += length2(state.velocities[i]);
    }
    surface += scene.options.spacing / 2;
    const double depth = surface - low + scene.options.spacing / 2;
    if (!(std::sqrt(speeds / n) < 0.01 * std::sqrt(g * depth))) return "the fluid moves: no hydrostatics";
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double wanted = flow.options().rest_density * g * (surface - state.places[i][scene.up]);
        errors += std::pow(flow.pressure(i) - wanted, 2);
    }
    const double rms = std::sqrt(errors / n) / (flow.options().rest_density * g * depth);
    // The surface is known to a part of a spacing.
    kept &= rms < std::max(0.02, 0.25 * scene.options.spacing / depth);
    return fmt::format("pressures differ from those of its weight by {:.2f}% (rms) of the deepest",
                       100 * rms);
}

template <int D>
int report_of_flow(const FlowArguments& a, const FlowScene<D>& scene, const FluidFlow<D>& flow,
                   const FlowRecorder<D>& recorder, const FluidMeasures<D>& first, std::uint64_t step,
                   std::uint64_t moved, double seconds) {
    const auto last = measures(flow);
    // Energies above that of the deepest point that the fluid can come to.
    const double scale = std::abs(flow.mass() * static_cast<double>(flow.state().size()) *
                                  length(scene.options.gravity) * scene.depth()),
                 gained = last.kinetic + last.potential - first.kinetic - first.potential;
    bool kept = true;
    std::string text;
    if (a.check) {
        kept = recorder.worst_mean < 0.01 && recorder.share_far_from_rest() < 0.001 &&
               recorder.most_leaks == 0 && !(scene.inflow.empty() && gained > 0.01 * scale);
        text = hydrostatics(scene, flow, kept);
    }
    if (a.json) {
        nlohmann::ordered_json all = {{"output", a.output},
                                      {"particles", flow.state().size()},
                                      {"walls", flow.walls().places.size()},
                                      {"time", flow.state().time},
                                      {"step", step},
                                      {"spacing", scene.options.spacing},
                                      {"sound", flow.options().sound},
                                      {"kinetic", last.kinetic},
                                      {"potential", last.potential},
                                      {"particle_steps", moved},
                                      {"seconds", seconds}};
        if (a.check)
            all["check"] = {{"mean_compression", recorder.worst_mean},
                            {"share_far_from_rest", recorder.share_far_from_rest()},
                            {"leaks", recorder.most_leaks},
                            {"energy_gained", gained},
                            {"hydrostatics", text},
                            {"kept", kept}};
        print_json(all);
    } else if (!a.quiet) {
        fmt::print(
            "{}: {} particles {:.3g} apart and {} of walls to time {:g}, {} steps (sound {:.3g})\n"
            "kinetic energy {:.3g}, at most {:.2g} fast; density within {:.2f}% in the mean; "
            "{:.3g} million particle steps in {:.1f} s\n",
            a.output, flow.state().size(), scene.options.spacing, flow.walls().places.size(),
            flow.state().time, step, flow.options().sound, last.kinetic, last.fastest,
            100 * last.mean_compression, static_cast<double>(moved) / 1e6, seconds);
        if (a.check)
            fmt::print(
                "check: density within {:.2f}% in the mean, farther than 5% from rest for {:.3f}% of "
                "particles; {} behind walls, energy {} "
                "by {:.1f}% of that of the fall; {}: {}\n",
                100 * recorder.worst_mean, 100 * recorder.share_far_from_rest(), recorder.most_leaks,
                gained > 0 ? "grew" : "fell", 100 * std::abs(gained) / std::max(scale, 0x1p-1000), text,
                kept ? "good" : "NOT as it should be");
    }
    return interrupted ? 130 : kept ? 0 : 1;
}

}  // namespace

template <int D>
int flow_run(FlowArguments a) {
    RunFolder folder(a.output);
    const double began = now();
    std::uint64_t step = 0;
    if (a.resume) {
        const double until = a.until;
        folder.read_options([&](const nlohmann::ordered_json& options) {
            each_flow_option(a, [&](const char* name, auto& value) { options.at(name).get_to(value); });
        });
        if (until >= 0) a.until = until;
        if (a.inflow_velocity.size() != 3)
            throw InputError(folder.options().string() + ": the velocity of the inflow has no three numbers");
        step = folder.last_step();
    } else {
        folder.expect_none();
        if (a.size != no_pictures && a.size != "auto") check_picture_memory(a.size, false);
    }
    FlowScene<D> scene = flow_scene<D>(a);
    if (a.until < 0) a.until = scene.until;
    if (a.every < 0) a.every = (a.until > 0 ? a.until : scene.until) / 20;
    folder.expect_lengths({a.every});
    // Lines of the log have times of their own. An end that is about at one is that one.
    const double of_line = a.every / log_lines_per_snapshot,
                 at_line = std::round(a.until / of_line) * of_line;
    if (std::abs(at_line - a.until) <= 1e-9 * a.until) a.until = at_line;
    FluidState<D> start = a.resume ? load_snapshot<D>(folder.snapshot(step)) : scene.start;
    FluidFlow<D> flow(std::move(start), scene.walls, scene.options);
    const double steps_left = (a.until - flow.state().time) / flow.longest_step();
    if (!(steps_left < 1e9))
        throw UsageError(
            fmt::format("steps are {:.2g} long here, and {:.2g} of them would be needed; give a longer "
                        "spacing, or less --viscosity or --sound",
                        flow.longest_step(), steps_left));
    FlowRecorder<D> recorder(a, folder, step, scene);
    const FluidMeasures<D> first = a.resume ? measures(flow) : recorder.line(0, flow);
    if (!a.resume) {
        recorder.snapshot(0, flow);
        nlohmann::ordered_json options;
        each_flow_option(a, [&](const char* name, const auto& value) { options[name] = value; });
        folder.save_options(options);
    }
    std::uint64_t moved = 0;
    step = move_fluid(a, scene, flow, recorder, step, moved);
    recorder.sheet();
    return report_of_flow(a, scene, flow, recorder, first, step, moved, now() - began);
}
template int flow_run<2>(FlowArguments);
template int flow_run<3>(FlowArguments);

}  // namespace hedgerow::cli
