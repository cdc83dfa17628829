/// An environment as a source of light: lookups by direction, and samples by importance.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/looks/light.h>
#include <hedgerow/render/lighting/cumulative_table.h>
#include <hedgerow/render/lighting/light_shapes.h>

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

/// Light from a direction of an environment.
struct EnvironmentSample {
    Vec3f direction;  ///< toward the environment, of length 1
    Vec3f radiance;
    float density = 0;  ///< per solid angle
};

/// The environment is looked up between texels. Columns wrap around, and beyond a pole lies the meridian
/// opposite. Whatever wrap modes the texture has do not matter.
///
/// Directions are sampled by a table over latitude and longitude, row first, then column, as in pbrt (Pharr,
/// Jakob and Humphreys, Physically Based Rendering). The weight of a cell is its mean brightness times its
/// solid angle, and within a cell directions are uniform in solid angle. Memory: 8 bytes a cell.
class EnvironmentMap {
public:
    /// Makes the table. O(texels). Throws InputError for the first texel that is NaN, infinite or negative,
    /// for a radiance that is, and for a matrix that is no rotation.
    explicit EnvironmentMap(const Environment& environment, const EnvironmentMapOptions& options = {})
        : environment_(environment) {
        check();
        const Texture& panorama = environment_.panorama;
        if (panorama.pixels && panorama.pixels->width > 0 && panorama.pixels->height > 0)
            texel_columns_ = panorama.pixels->width, texel_rows_ = panorama.pixels->height;
        columns_ = static_cast<std::size_t>(std::clamp(options.most_columns, 1, texel_columns_));
        rows_ = static_cast<std::size_t>(std::clamp(options.most_rows, 1, texel_rows_));
        for (std::size_t j = 0; j <= rows_; ++j) cosines_.push_back(cosine_of_row(j, rows_));
        make_table(cell_means(), options.compensates);
    }

    /// The radiance that arrives from a direction, of length 1. O(1).
    Vec3f radiance(const Vec3f& direction) const {
        const Vec3d local = to_local(direction);
        return lookup(turns(local), latitude(local));
    }
    /// Chooses a direction by two numbers in [0, 1). The density is 0 if the environment is black. O(log of
    /// the columns and rows).
    EnvironmentSample sample(float u, float v) const {
        if (!lit()) return {};
        const TableChoice row = choose_entry(row_sums_, static_cast<double>(v));
        const TableChoice column = choose_entry(sums_of_row(row.entry), static_cast<double>(u));
        const double top = cosines_[row.entry], bottom = cosines_[row.entry + 1];
        const double height = top + product(bottom - top, row.u);
        const double radius = std::sqrt(std::max(0.0, product(1 - height, 1 + height)));
        const auto turn =
            rounded_to<float>((static_cast<double>(column.entry) + column.u) / static_cast<double>(columns_));
        const SineCosine<float> at = sine_cosine_of_turns(turn);
        const Vec3d local(-product(radius, static_cast<double>(at.sine)), height,
                          product(radius, static_cast<double>(at.cosine)));
        return {to_world(local), lookup(static_cast<double>(turn), latitude(local)),
                density_of(row.entry, product(row.probability, column.probability))};
    }
    /// The density with which `sample` chooses a direction of length 1, per solid angle. At the edge of two
    /// cells it may be that of either. O(log of the rows).
    float density(const Vec3f& direction) const {
        if (!lit()) return 0;
        const Vec3d local = to_local(direction);
        // Rows lie between descending cosines.
        const auto below =
            std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, local[1], std::greater<double>());
        const auto row = static_cast<std::size_t>(below - cosines_.begin()) - 1;
        const double place = turns(local) * static_cast<double>(columns_);
        const std::size_t column = std::min(columns_ - 1, static_cast<std::size_t>(place));
        return density_of(row,
                          product(share_of_entry(row_sums_, row), share_of_entry(sums_of_row(row), column)));
    }

    /// The mean radiance over all directions.
    const Vec3f& mean() const { return mean_; }
    /// Whether any light comes from the environment.
    bool lit() const { return !row_sums_.empty(); }
    const Environment& environment() const { return environment_; }
    /// The size of the table of densities.
    std::size_t columns() const { return columns_; }
    std::size_t rows() const { return rows_; }

private:
    static constexpr double pi = 3.141592653589793;

    void check() const {
        if (!is_light(environment_.radiance))
            throw InputError("environment: the radiance must be finite and not negative in all colours");
        const auto& m = environment_.to_world;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j <= i; ++j)
                if (!(std::abs(dot(m[i], m[j]) - (i == j)) < 1e-4))
                    throw InputError("environment: its matrix must be a rotation, without scale or shear");
    }
    static bool is_light(const Vec3f& c) { return finite(c) && c[0] >= 0 && c[1] >= 0 && c[2] >= 0; }
    static double cosine_of_row(std::size_t row, std::size_t rows) {
        if (row == 0 || row == rows) return row == 0 ? 1 : -1;
        return cosine(product(pi, static_cast<double>(row) / static_cast<double>(rows)));
    }

    /// Texel (column, row) times the radiance of the environment. The column may be one outside, and so may
    /// the row: that is a texel across the pole.
    Vec3f texel(std::int64_t column, std::int64_t row) const {
        if (row < 0 || row >= texel_rows_) {
            row = row < 0 ? 0 : texel_rows_ - 1;
            column += texel_columns_ / 2;
        }
        column += column < 0 ? texel_columns_ : column >= texel_columns_ ? -texel_columns_ : 0;
        const Texture& panorama = environment_.panorama;
        if (!panorama.pixels || panorama.pixels->width <= 0 || panorama.pixels->height <= 0)
            return environment_.radiance;
        return tinted(panorama.texel(static_cast<int>(column), static_cast<int>(row)).colour,
                      environment_.radiance);
    }
    /// The radiance at a place of the panorama, from 0 to 1 across and down.
    Vec3f lookup(double across, double down) const {
        if (texel_columns_ == 1 && texel_rows_ == 1) return texel(0, 0);
        const double x = product(across, static_cast<double>(texel_columns_)),
                     y = product(down, static_cast<double>(texel_rows_));
        const auto texel_at = [&](double column, double row) {
            return Rgba{texel(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row)), 1};
        };
        if (interpolates()) return detail::bilinear(x, y, {1, 1}, texel_at).colour;
        const auto last = static_cast<double>(texel_rows_ - 1);
        return texel_at(std::floor(x), std::min(last, std::floor(y))).colour;
    }
    bool interpolates() const { return environment_.panorama.filter == TextureFilter::bilinear; }

    Vec3f to_world(const Vec3d& local) const {
        const auto& m = environment_.to_world;
        return Vec3f(normalized(Vec3d(dot(m[0], local), dot(m[1], local), dot(m[2], local))));
    }
    Vec3d to_local(const Vec3f& direction) const {
        const auto& m = environment_.to_world;
        const Vec3d d(direction);
        return m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
    }
    /// How far around the panorama a direction is, from the left edge: 0 to 1. At a pole it is the middle.
    static double turns(const Vec3d& local) {
        if (local[0] == 0 && local[2] == 0) return 0.5;
        const double share = 0.5 + arc_tangent(local[0], -local[2]) / (2 * pi);
        return std::clamp(share, 0.0, 1.0);
    }
    /// How far down the panorama a direction is: 0 at the zenith to 1.
    static double latitude(const Vec3d& local) {
        const double radius = std::sqrt(product(local[0], local[0]) + product(local[2], local[2]));
        if (radius == 0) return local[1] < 0 ? 1 : 0;
        return std::clamp(arc_tangent(radius, local[1]) / pi, 0.0, 1.0);
    }

    std::span<const double> sums_of_row(std::size_t row) const {
        return std::span(column_sums_).subspan(row * (columns_ + 1), columns_ + 1);
    }
    float density_of(std::size_t row, double probability) const {
        if (!(probability > 0)) return 0;
        return detail::bounded_density(probability / solid_angle(row));
    }
    /// The solid angle of a cell.
    double solid_angle(std::size_t row) const {
        return (cosines_[row] - cosines_[row + 1]) * (2 * pi / static_cast<double>(columns_));
    }

    /// The brightness of the texels of a row, averaged over each texel as lookups interpolate it across.
    std::vector<double> brightness_of_row(std::int64_t row) const {
        std::vector<double> values(static_cast<std::size_t>(texel_columns_)), smooth(values.size());
        for (std::size_t x = 0; x < values.size(); ++x)
            values[x] = detail::brightness(texel(static_cast<std::int64_t>(x), row));
        if (!interpolates()) return values;
        for (std::size_t x = 0; x < values.size(); ++x)
            smooth[x] = over_texel(values[x == 0 ? values.size() - 1 : x - 1], values[x],
                                   values[x + 1 == values.size() ? 0 : x + 1]);
        return smooth;
    }
    /// The mean over a texel of what is interpolated between its value and that of both neighbours.
    static double over_texel(double before, double value, double after) {
        return (before + product(6.0, value) + after) / 8;
    }

    /// Checks all texels. Returns the mean brightness of each cell, row by row.
    std::vector<double> cell_means() {
        std::vector<double> cells(columns_ * rows_);
        sum_texels();
        std::vector<double> above = brightness_of_row(-1), here = brightness_of_row(0);
        for (int y = 0; y < texel_rows_; ++y) {
            std::vector<double> below = brightness_of_row(y + 1);
            std::vector<double> smooth = here;
            if (interpolates())
                for (std::size_t x = 0; x < smooth.size(); ++x)
                    smooth[x] = over_texel(above[x], here[x], below[x]);
            for_each_cell(y, texel_rows_, rows_, [&](std::size_t row, double share) {
                for (int x = 0; x < texel_columns_; ++x)
                    for_each_cell(x, texel_columns_, columns_, [&](std::size_t column, double part) {
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
    /// Computes the mean radiance. Throws InputError for the first bad texel.
    void sum_texels() {
        Vec3d sum;
        double above = 1;
        for (int y = 0; y < texel_rows_; ++y) {
            Vec3d of_row;
            for (int x = 0; x < texel_columns_; ++x) {
                const Vec3f value = texel(x, y);
                if (!is_light(value)) refuse_texel(x, y);
                of_row += Vec3d(value);
            }
            const double below =
                cosine_of_row(static_cast<std::size_t>(y) + 1, static_cast<std::size_t>(texel_rows_));
            sum += of_row * ((above - below) / 2 / texel_columns_);
            above = below;
        }
        mean_ = Vec3f(sum);
    }
    [[noreturn]] void refuse_texel(int x, int y) const {
        const std::string& name = environment_.panorama.name;
        throw InputError("environment" + (name.empty() ? "" : " " + name) + ": texel (column " +
                         std::to_string(x) + ", row " + std::to_string(y) +
                         ") is not a finite radiance >= 0: mend it in the image, or scale the image down if "
                         "its values are too large");
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

    Environment environment_;
    int texel_columns_ = 1, texel_rows_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<double> cosines_;      // of the angles from the zenith of the rows' edges
    std::vector<double> column_sums_;  // of each row, columns + 1
    std::vector<double> row_sums_;
    Vec3f mean_;
};

}  // namespace hedgerow
