/// Particles, and the state of a motion, in rows.
#include <hedgerow/io/particle_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/rows.h>

#include "gadget.h"
#include "other_columns.h"
#include "text.h"

namespace hedgerow {
namespace {

constexpr std::array state_columns{"x",    "y",         "z",  "vx", "vy", "vz",
                                   "mass", "potential", "ax", "ay", "az", "time"};
using Names = std::vector<std::string>;

Names names(std::size_t count) {
    return {state_columns.begin(), state_columns.begin() + static_cast<std::ptrdiff_t>(count)};
}
/// The columns that a file may have, the most first.
const std::vector<Names>& column_lists() {
    static const std::vector<Names> lists{names(12), names(7), {"x", "y", "z", "mass"}, names(3)};
    return lists;
}

void add_row(MotionState& state, const double* row, std::size_t columns, const std::filesystem::path& path) {
    Particles& all = state.particles;
    const bool moving = columns >= 7;
    all.places.emplace_back(row[0], row[1], row[2]);
    all.velocities.push_back(moving ? Vec3d(row[3], row[4], row[5]) : Vec3d());
    all.masses.push_back(moving ? row[6] : columns == 4 ? row[3] : 1.0);
    if (columns < 12) return;
    state.potentials.push_back(row[7]);
    state.accelerations.emplace_back(row[8], row[9], row[10]);
    if (all.size() > 1 && row[11] != state.time)
        throw InputError(path.string() + ": row " + std::to_string(all.size() - 1) + " is of the time " +
                         std::to_string(row[11]) + ", those before of " + std::to_string(state.time) +
                         "; a state has one time");
    state.time = row[11];
}

/// Reads rows with the first list of columns that the file has, and returns how many these are.
std::size_t read_rows(const std::filesystem::path& path, const Progress& progress, MotionState& state) {
    std::vector<double> numbers;
    for (const Names& list : column_lists()) {
        const std::size_t columns = list.size(), most = std::size_t{1} << 15;
        std::unique_ptr<RowReader<double>> rows;
        std::size_t count = 0;
        try {
            rows = open_rows<double>(path, row_format(path), {list}, progress);
            count = rows->read(numbers, most);
        } catch (const detail::OtherColumns& fault) {
            if (&list != &column_lists().back()) continue;
            throw InputError(
                std::string(fault.what()) +
                " (particles have the columns x y z, x y z mass, x y z vx vy vz mass, or those and "
                "potential ax ay az time)");
        }
        for (; count > 0; count = rows->read(numbers, most))
            for (std::size_t i = 0; i < count; ++i)
                add_row(state, numbers.data() + i * columns, columns, path);
        return columns;
    }
    return 0;
}

/// Throws InputError for a number that is not finite, or beyond what coordinates may be. Particles are never
/// left out, since the forces on all others would be wrong.
void expect_numbers(const MotionState& state, const std::filesystem::path& path) {
    const Particles& all = state.particles;
    const auto expect = [&](double x, const char* what, std::size_t i) {
        if (!(std::abs(x) <= largest_coordinate<double>))
            throw InputError(path.string() + ": " + what + " of particle " + std::to_string(i) + " is " +
                             detail::shortest_text(x) +
                             ": numbers are finite, and at most 2^480. Repair the file");
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            expect(all.places[i][k], "a coordinate", i), expect(all.velocities[i][k], "a velocity", i);
        expect(all.masses[i], "the mass", i);
    }
    for (std::size_t i = 0; i < state.potentials.size(); ++i) expect(state.potentials[i], "the potential", i);
    for (std::size_t i = 0; i < state.accelerations.size(); ++i)
        for (int k = 0; k < 3; ++k) expect(state.accelerations[i][k], "an acceleration", i);
    if (all.size() > 0) expect(state.time, "the time", 0);
}

MotionState read_state(const std::filesystem::path& path, const Progress& progress) {
    if (detail::names_hdf5(path)) return detail::load_gadget(path);
    MotionState state;
    std::size_t columns = 3;
    bool in_rows = true;
    try {
        row_format(path);
    } catch (const UsageError&) {
        in_rows = false;
    }
    if (in_rows) {
        columns = read_rows(path, progress, state);
    } else {
        LoadReport report;
        const auto cloud = load_points<double, 3>(path, {.drop_bad = true, .report = &report}, progress);
        if (report.dropped_points > 0)
            throw InputError(path.string() + ": " + std::to_string(report.dropped_points) +
                             " of the points are NaN, infinite or too far away. Repair the file, or write "
                             "one without them (hedgerow convert --drop-bad)");
        for (const Vec3d& p : cloud.points) add_row(state, p.data, columns, path);
    }
    if (columns == 3)
        for (double& mass : state.particles.masses) mass /= static_cast<double>(state.particles.size());
    return state;
}

}  // namespace

MotionState load_state(const std::filesystem::path& path, const Progress& progress) {
    MotionState state = read_state(path, progress);
    expect_numbers(state, path);
    return state;
}

void save_state(const std::filesystem::path& path, const MotionState& state, double period) {
    for (const std::size_t count : {state.particles.velocities.size(), state.particles.masses.size(),
                                    state.accelerations.size(), state.potentials.size()})
        if (count != state.particles.size())
            throw InputError(path.string() + ": the state has " + std::to_string(state.particles.size()) +
                             " places, and velocities, masses, accelerations or potentials of " +
                             std::to_string(count) + ": save that of a Motion, which has found them");
    if (detail::names_hdf5(path)) return detail::save_gadget(path, state, period);
    std::vector<Column> columns;
    columns.reserve(std::size(state_columns));
    for (const char* name : state_columns) columns.push_back({name, NumberType::f64});
    const Particles& all = state.particles;
    RowWriter writer(path, row_format(path), columns, all.size());
    constexpr std::size_t at_once = 1 << 15;
    for (std::size_t first = 0; first < all.size(); first += at_once) {
        const std::size_t count = std::min(at_once, all.size() - first);
        std::string records;
        append_records(
            records, count, state_columns.size() * sizeof(double), [&](std::size_t k, Record& record) {
                const std::size_t i = first + k;
                const Vec3d &p = all.places[i], &v = all.velocities[i], &a = state.accelerations[i];
                for (const double x : {p[0], p[1], p[2], v[0], v[1], v[2], all.masses[i], state.potentials[i],
                                       a[0], a[1], a[2], state.time})
                    record("", x);
            });
        writer.write(writer.encode(std::move(records)), count);
    }
    writer.finish();
}

}  // namespace hedgerow
