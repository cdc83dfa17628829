/// A panorama in latitude and longitude: the place of a direction in it, and the light that it shows there.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/number_lanes.h>
#include <hedgerow/geometry/rounding.h>
#include <hedgerow/looks/light.h>
#include <hedgerow/render/lighting/cumulative_table.h>

namespace hedgerow {

/// A place of a panorama, from its top left corner: shares of its width and its height, each in [0, 1). D is
/// double, or DoubleLanes for four places.
template <class D>
struct PanoramaPlaceOf {
    D across, down;

    /// The one of `columns` equal parts of the width in which the place lies, and likewise of the height.
    int column(int columns) const requires std::same_as<D, double> {
        return static_cast<int>(across * columns);
    }
    int row(int rows) const requires std::same_as<D, double> { return static_cast<int>(down * rows); }
};
using PanoramaPlace = PanoramaPlaceOf<double>;
/// Place k of four, or of one.
template <class D>
PanoramaPlace lane(const PanoramaPlaceOf<D>& p, int k) {
    return {lane(p.across, k), lane(p.down, k)};
}

namespace detail {

/// The arctangent of a slope from −1 to 1 in half turns, −1/4 to 1/4, within 1.2·10⁻⁸: less than the rounding
/// of a direction to floats turns it by. The polynomial is a minimax fit to the error. Its terms are added in
/// pairs, which do not wait for each other (Estrin 1960).
template <class D>
D half_turns_of_slope(D slope) {
    const D z = product(slope, slope), z2 = product(z, z), z4 = product(z2, z2);
    const D a = 0x1.45f2f8ab3c9e6p-2 + product(z, D(-0x1.b28dc75bb17f3p-4)),
            b = 0x1.041012c1afc6ep-4 + product(z, D(-0x1.6aae4268d034bp-5)),
            c = 0x1.f6dbe61f88d4fp-6 + product(z, D(-0x1.2397f3d0facf6p-6)),
            d = 0x1.c814129bc359dp-8 + product(z, D(-0x1.525373eaa4a45p-10));
    return product(slope, (a + product(z2, b)) + product(z4, c + product(z2, d)));
}

}  // namespace detail

/// Where a panorama shows a direction of its own space: +y at the top, −z in the middle column, +x right of
/// it. The direction may have any length whose square neither overflows nor underflows. Errs by 2.4·10⁻⁸ at
/// most. Every direction has a place, also a pole, 0 and NaN. O(1), without branches: two polynomials. D is
/// double or DoubleLanes.
template <class D>
PanoramaPlaceOf<D> panorama_place(const Vec<D, 3>& direction) {
    const D x = direction[0], y = direction[1], z = direction[2];
    const D level2 = product(x, x) + product(z, z), level = root(level2);
    const D length = root(level2 + product(y, y));
    // The tangent of half an angle is a slope of at most 1: of the angle to the horizon, and of that to the
    // nearer half of the z axis.
    const D rise = detail::half_turns_of_slope(y / (length + level)),
            turn = detail::half_turns_of_slope(magnitude(x) / (level + magnitude(z)));
    const D of_axis = 0.25 + with_sign_of(D(0.25), z);  // turns from −z to that half: 0 or 1/2
    return {in_unit_interval(0.5 + with_sign_of(magnitude(of_axis - turn), x)),
            in_unit_interval(0.5 - 2 * rise)};
}

inline PanoramaPlace panorama_place(const Vec3d& direction) {
    return panorama_place<double>(direction);
}

/// The light of an environment by place. It is looked up between texels, unless the texture's filter is
/// `nearest`. Columns wrap around, and beyond a pole lies the meridian opposite. Whatever wrap modes the
/// texture has do not matter.
class Panorama {
public:
    /// O(texels). Throws InputError for the first texel that is NaN, infinite or negative, and for a radiance
    /// that is.
    explicit Panorama(const Environment& environment)
        : texture_(environment.panorama), radiance_(environment.radiance) {
        if (!is_light(radiance_))
            throw InputError("environment: the radiance must be finite and not negative in all colours");
        if (texture_.pixels && texture_.pixels->width > 0 && texture_.pixels->height > 0)
            columns_ = texture_.pixels->width, rows_ = texture_.pixels->height;
        else
            texture_.pixels = nullptr;
        sum_texels();
    }

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Whether light changes between the centres of texels, and not at their edges.
    bool interpolates() const { return texture_.filter == TextureFilter::bilinear; }
    /// The mean radiance over all directions.
    const Vec3f& mean() const { return mean_; }

    /// The radiance at a place. O(1).
    Vec3f radiance(const PanoramaPlace& place) const {
        if (columns_ == 1 && rows_ == 1) return texel(0, 0);
        const Vec3f colour = texture_.with_texels([&](const auto& texel) {
            const auto wrapped_texel = [&](std::int64_t column, std::int64_t row) {
                const auto [x, y] = wrapped(static_cast<int>(column), static_cast<int>(row));
                return texel(x, y).colour;
            };
            if (!interpolates()) return wrapped_texel(place.column(columns_), place.row(rows_));
            const auto same = [](std::int64_t i) { return i; };
            return detail::bilinear(product(place.across, static_cast<double>(columns_)),
                                    product(place.down, static_cast<double>(rows_)), {1, 1}, same, same,
                                    wrapped_texel);
        });
        return tinted(colour, radiance_);
    }
    /// The radiance of a texel, whose column and row may each be one outside.
    Vec3f texel(int column, int row) const {
        if (!texture_.pixels) return radiance_;
        const auto [x, y] = wrapped(column, row);
        return tinted(texture_.texel(x, y).colour, radiance_);
    }
    /// The cosine of the angle from the top of the edge above a row, of so many rows.
    static double cosine_of_row(std::size_t row, std::size_t rows) {
        if (row == 0 || row == rows) return row == 0 ? 1 : -1;
        return cosine(product(pi, static_cast<double>(row) / static_cast<double>(rows)));
    }

private:
    static constexpr double pi = std::numbers::pi;

    static bool is_light(const Vec3f& c) { return finite(c) && c[0] >= 0 && c[1] >= 0 && c[2] >= 0; }
    /// The texel that stands for one whose column and row may each be one outside.
    std::pair<int, int> wrapped(int column, int row) const {
        if (row < 0 || row >= rows_) {
            row = row < 0 ? 0 : rows_ - 1;
            column += columns_ / 2;
        }
        return {column + (column < 0 ? columns_ : column >= columns_ ? -columns_ : 0), row};
    }
    /// Computes the mean. Throws InputError for the first bad texel.
    void sum_texels() {
        Vec3d sum;
        double above = 1;
        for (int y = 0; y < rows_; ++y) {
            Vec3d of_row;
            for (int x = 0; x < columns_; ++x) {
                const Vec3f value = texel(x, y);
                if (!is_light(value)) refuse_texel(x, y);
                of_row += Vec3d(value);
            }
            const double below =
                cosine_of_row(static_cast<std::size_t>(y) + 1, static_cast<std::size_t>(rows_));
            sum += of_row * ((above - below) / 2 / columns_);
            above = below;
        }
        mean_ = Vec3f(sum);
    }
    [[noreturn]] void refuse_texel(int x, int y) const {
        const std::string& name = texture_.name;
        throw InputError("environment" + (name.empty() ? "" : " " + name) + ": texel (column " +
                         std::to_string(x) + ", row " + std::to_string(y) +
                         ") is not a finite radiance >= 0: mend it in the image, or scale the image down if "
                         "its values are too large");
    }

    Texture texture_;
    Vec3f radiance_, mean_;
    int columns_ = 1, rows_ = 1;
};

}  // namespace hedgerow
