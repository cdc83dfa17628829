/// An environment as a source of light: lookups by direction, and samples by importance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/looks/light.h>
#include <hedgerow/render/lighting/cumulative_table.h>
#include <hedgerow/render/lighting/light_shapes.h>
#include <hedgerow/render/lighting/panorama.h>

namespace hedgerow {

struct EnvironmentMapOptions {
    /// Whether directions are sampled by how much brighter than the mean they are (Karlík et al., MIS
    /// compensation, SIGGRAPH Asia 2019). Directions darker than the mean then have density 0, so samples of
    /// the environment must be combined with samples of the material by multiple importance sampling. Off:
    /// the density is positive wherever the radiance is.
    bool compensates = true;
    /// The most columns and rows of the table of densities. Its cells are no smaller than a texel.
    int most_columns = 1024, most_rows = 512;
};

/// Light from a direction of an environment; from four directions, of F = FloatLanes.
template <class F>
struct EnvironmentSampleOf {
    Vec<F, 3> direction;  ///< toward the environment, of length 1
    Vec<F, 3> radiance;
    F density = 0;  ///< per solid angle
};
using EnvironmentSample = EnvironmentSampleOf<float>;

/// Directions are sampled by a table over latitude and longitude, row first, then column, as in pbrt (Pharr,
/// Jakob and Humphreys, Physically Based Rendering). The weight of a cell is its mean brightness times its
/// solid angle, and within a cell directions are uniform in solid angle. Memory: 8 bytes a cell.
class EnvironmentMap {
public:
    /// Makes the table. O(texels). Throws InputError as Panorama does, and for a matrix that is no rotation.
    explicit EnvironmentMap(const Environment& environment, const EnvironmentMapOptions& options = {})
        : panorama_(environment),
          to_world_(environment.to_world),
          columns_(static_cast<std::size_t>(std::clamp(options.most_columns, 1, panorama_.columns()))),
          rows_(static_cast<std::size_t>(std::clamp(options.most_rows, 1, panorama_.rows()))) {
        check_rotation();
        for (std::size_t j = 0; j <= rows_; ++j) cosines_.push_back(Panorama::cosine_of_row(j, rows_));
        make_table(cell_means(), options.compensates);
    }

    /// The radiance that arrives from a direction. O(1).
    Vec3f radiance(const Vec3f& direction) const { return radiance(place_of(direction)); }
    /// The density with which `sample` chooses a direction, per solid angle. O(1).
    float density(const Vec3f& direction) const { return density(place_of(direction)); }
    /// Where the panorama shows a direction, or four; and radiance and density there.
    template <class F>
    PanoramaPlaceOf<WideOf<F>> place_of(const Vec<F, 3>& direction) const {
        using D = WideOf<F>;
        const auto& m = to_world_;
        const auto d = widened(direction);
        const auto along = [&](int i) {
            return product(D(m[0][i]), d[0]) + product(D(m[1][i]), d[1]) + product(D(m[2][i]), d[2]);
        };
        return panorama_place(Vec<D, 3>(along(0), along(1), along(2)));
    }
    Vec3f radiance(const PanoramaPlace& place) const { return panorama_.radiance(place); }
    float density(const PanoramaPlace& place) const {
        if (!lit()) return 0;
        const auto row = static_cast<std::size_t>(place.row(static_cast<int>(rows_))),
                   column = static_cast<std::size_t>(place.column(static_cast<int>(columns_)));
        const double share = share_of_entry(sums_of_row(row), column);
        return share > 0 ? in_float(detail::bounded_density(share * row_densities_[row])) : 0;
    }
    /// The radiance and the density of a direction, or of four, at once.
    template <class F>
    EnvironmentSampleOf<F> at(const Vec<F, 3>& direction) const {
        const auto place = place_of(direction);
        return {direction, each_vector<F>([&](int k) { return radiance(lane(place, k)); }),
                each_lane<F>([&](int k) { return density(lane(place, k)); })};
    }
    /// Chooses a direction by two numbers in [0, 1), or four by two of each. Returns what `at` returns for
    /// it: rounding to floats puts about one direction of 30,000 beyond the edge of its cell, and it counts
    /// where it lies. So the density may be 0, and it is if the environment is black. O(log of the columns
    /// and rows).
    template <class F>
    EnvironmentSampleOf<F> sample(F u, F v) const {
        if (!lit()) return {};
        using D = WideOf<F>;
        const auto row = choose_entries([&](int) { return row_sums_.data(); }, rows_, D(v));
        const auto column =
            choose_entries([&](int k) { return sums_of_row(row.entries[k]).data(); }, columns_, D(u));
        const D top = each_lane<D>([&](int k) { return cosines_[row.entries[k]]; }),
                bottom = each_lane<D>([&](int k) { return cosines_[row.entries[k] + 1]; });
        const D height = top + product(bottom - top, row.within);
        const D radius = root(greater(D(0), product(1 - height, 1 + height)));
        const D first = each_lane<D>([&](int k) { return static_cast<double>(column.entries[k]); });
        const auto around =
            sine_cosine_of_turns(in_float((first + column.within) / static_cast<double>(columns_)));
        return at(
            to_world(Vec<D, 3>(-product(radius, D(around.sine)), height, product(radius, D(around.cosine)))));
    }

    /// The mean radiance over all directions.
    const Vec3f& mean() const { return panorama_.mean(); }
    /// Whether any light comes from the environment.
    bool lit() const { return !row_sums_.empty(); }
    /// The size of the table of densities.
    std::size_t columns() const { return columns_; }
    std::size_t rows() const { return rows_; }

private:
    static constexpr double pi = std::numbers::pi;

    void check_rotation() const {
        const auto& m = to_world_;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                if (!(std::abs(dot(m[i], m[j]) - (i == j)) < 1e-4))
                    throw InputError("environment: its matrix must be a rotation, without scale or shear");
    }
    template <class D>
    auto to_world(const Vec<D, 3>& local) const {
        const auto across = [&](std::size_t i) {
            const Vec3d& row = to_world_[i];
            return dot(Vec<D, 3>(row[0], row[1], row[2]), local);
        };
        return in_float(normalized(Vec<D, 3>(across(0), across(1), across(2))));
    }
    std::span<const double> sums_of_row(std::size_t row) const {
        return std::span(column_sums_).subspan(row * (columns_ + 1), columns_ + 1);
    }
    /// The solid angle of a cell.
    double solid_angle(std::size_t row) const {
        return (cosines_[row] - cosines_[row + 1]) * (2 * pi / static_cast<double>(columns_));
    }

    /// The brightness of the texels of a row, averaged over each texel as lookups interpolate it across.
    std::vector<double> brightness_of_row(int row) const {
        std::vector<double> values(static_cast<std::size_t>(panorama_.columns())), smooth(values.size());
        for (std::size_t x = 0; x < values.size(); ++x)
            values[x] = detail::brightness(panorama_.texel(static_cast<int>(x), row));
        if (!panorama_.interpolates()) return values;
        for (std::size_t x = 0; x < values.size(); ++x)
            smooth[x] = over_texel(values[x == 0 ? values.size() - 1 : x - 1], values[x],
                                   values[x + 1 == values.size() ? 0 : x + 1]);
        return smooth;
    }
    /// The mean over a texel of what is interpolated between its value and that of both neighbours.
    static double over_texel(double before, double value, double after) {
        return (before + product(6.0, value) + after) / 8;
    }

    /// The mean brightness of each cell, row by row.
    std::vector<double> cell_means() const {
        std::vector<double> cells(columns_ * rows_);
        std::vector<double> above = brightness_of_row(-1), here = brightness_of_row(0);
        for (int y = 0; y < panorama_.rows(); ++y) {
            std::vector<double> below = brightness_of_row(y + 1);
            std::vector<double> smooth = here;
            if (panorama_.interpolates())
                for (std::size_t x = 0; x < smooth.size(); ++x)
                    smooth[x] = over_texel(above[x], here[x], below[x]);
            for_each_cell(y, panorama_.rows(), rows_, [&](std::size_t row, double share) {
                for (int x = 0; x < panorama_.columns(); ++x)
                    for_each_cell(x, panorama_.columns(), columns_, [&](std::size_t column, double part) {
                        cells[row * columns_ + column] +=
                            product(smooth[static_cast<std::size_t>(x)], product(share, part));
                    });
            });
            above = std::move(here);
            here = std::move(below);
        }
        return cells;
    }
    /// Calls `visit(cell, share)` for each of the cells that texel i of `texels` overlaps in one direction,
    /// with the share of the cell that it covers. There are as many cells as texels, or fewer.
    template <class Visit>
    static void for_each_cell(int i, int texels, std::size_t cells, const Visit& visit) {
        // In units of which a whole side has texels · cells.
        const auto parts = static_cast<std::int64_t>(cells);
        const std::int64_t low = i * parts, high = low + parts;
        for (std::int64_t j = low / texels; j * texels < high; ++j) {
            const std::int64_t overlap = std::min(high, (j + 1) * texels) - std::max(low, j * texels);
            visit(static_cast<std::size_t>(j), static_cast<double>(overlap) / texels);
        }
    }
    /// Makes the sums of rows and columns. A map without any light gets none.
    void make_table(std::vector<double> means, bool compensates) {
        if (compensates) lessen(means);
        column_sums_.resize((columns_ + 1) * rows_);
        row_sums_.resize(rows_ + 1);
        for (std::size_t row = 0; row < rows_; ++row) {
            const auto sums = std::span(column_sums_).subspan(row * (columns_ + 1), columns_ + 1);
            std::copy_n(means.begin() + static_cast<std::ptrdiff_t>(row * columns_), columns_,
                        sums.begin() + 1);
            row_sums_[row + 1] = product(accumulate_shares(sums), solid_angle(row));
        }
        if (!(accumulate_shares(row_sums_) > 0)) row_sums_.clear();
        for (std::size_t row = 0; lit() && row < rows_; ++row)
            row_densities_.push_back(share_of_entry(row_sums_, row) / solid_angle(row));
    }
    /// Subtracts the mean, where that leaves enough. What it leaves of a map that is almost flat would be
    /// noise.
    void lessen(std::vector<double>& means) const {
        const auto sum = [&](double less) {
            double total = 0;
            for (std::size_t row = 0; row < rows_; ++row) {
                double of_row = 0;
                for (std::size_t x = 0; x < columns_; ++x)
                    of_row += std::max(0.0, means[row * columns_ + x] - less);
                total += product(of_row, solid_angle(row));
            }
            return total;
        };
        const double whole = sum(0), mean = whole / (4 * pi);
        if (!(sum(mean) > whole / 1024)) return;
        for (double& m : means) m = std::max(0.0, m - mean);
    }

    Panorama panorama_;
    Rows<3> to_world_;
    std::size_t columns_, rows_;
    std::vector<double> cosines_;        // of the angles from the zenith of the rows' edges
    std::vector<double> column_sums_;    // of each row, columns + 1
    std::vector<double> row_sums_;       // none: the map is black
    std::vector<double> row_densities_;  // the density of a cell that had all samples of its row
};

}  // namespace hedgerow
