/// The sum of the solid angles of many triangles.
#pragma once

#include <array>
#include <numbers>

#include <hedgerow/geometry/closing_angle.h>
#include <hedgerow/geometry/orientation.h>

namespace hedgerow {

/// Half the solid angle under which x sees a triangle is the argument of real + i·imaginary (Van Oosterom and
/// Strackee 1983).
struct HalfAngle {
    double real, imaginary;
};

/// Eight sums of half angles, each kept as a product of complex numbers and a count of whole turns, so that
/// one arctangent serves all angles. Kernels (src/engine/winding-inl.h) compute the sums side by side, with
/// the same operations.
class HalfAngles {
public:
    static constexpr int count = 8;
    /// A bound of what the roundings of a triangle change the sum by, in whole turns.
    static constexpr double rounding = 0x1p-45;

    /// Of a triangle seen from x. `scale` brings offsets from x to about 1, and is a power of two.
    static HalfAngle of(const std::array<Vec3d, 3>& corners, const Vec3d& x, double scale) {
        const Vec3d a = (corners[0] - x) * scale, b = (corners[1] - x) * scale, c = (corners[2] - x) * scale;
        const double la = length(a), lb = length(b), lc = length(c), size = product(product(la, lb), lc);
        const HalfAngle h{size + product(dot(a, b), lc) + product(dot(b, c), la) + product(dot(c, a), lb),
                          dot(a, cross(b, c))};
        const double magnitude = std::abs(h.real) + std::abs(h.imaginary);
        return in_doubt(h, size) || !(magnitude > least) ? settled(h, size, corners, x) : h;
    }
    /// Adds the angle of a triangle to sum i.
    void add(int i, const std::array<Vec3d, 3>& corners, const Vec3d& x, double scale) {
        const HalfAngle h = of(corners, x, scale);
        // The product of both.
        const double real = product(re_[i], h.real) - product(im_[i], h.imaginary);
        const double imaginary = product(re_[i], h.imaginary) + product(im_[i], h.real);
        // Two angles of one sign make a whole turn more if their sum has the other sign.
        const bool up = im_[i] >= 0;
        if (up == (h.imaginary >= 0) && up != (imaginary >= 0)) turns_[i] += up ? 1 : -1;
        const double per_magnitude = 1 / (std::abs(real) + std::abs(imaginary));
        re_[i] = product(real, per_magnitude), im_[i] = product(imaginary, per_magnitude);
    }
    /// All eight sums together, in whole turns of the full angles.
    double turns() const { return turns(re_, im_, turns_); }
    static double turns(const double (&re)[count], const double (&im)[count], const double (&turns)[count]) {
        SumOfAngles all;
        double whole = 0;
        for (int i = 0; i < count; ++i) {
            all.add(re[i], im[i]);
            whole += turns[i];
        }
        return all.turns() + whole;
    }

    /// Whether rounding may have changed the sign that decides about a whole turn: x sees the triangle under
    /// nearly half of all directions. `size` is the product of the distances of the corners.
    static bool in_doubt(const HalfAngle& h, double size) {
        return h.real < 0 && std::abs(h.imaginary) <= 0x1p-46 * size;
    }
    /// Magnitudes below this lose digits in products.
    static constexpr double least = 0x1p-900;
    /// The angle of a triangle with the exact sign where that is in doubt, scaled up where it is tiny. A
    /// triangle adds nothing to a point within it, of which half is on either side, or at one of its corners.
    static HalfAngle settled(HalfAngle h, double size, const std::array<Vec3d, 3>& corners, const Vec3d& x) {
        if (in_doubt(h, size)) {
            // Seen from the front, corners turn counterclockwise, and the imaginary part is negative.
            const int of_plane = side(corners[0], corners[1], corners[2], x);
            if (of_plane == 0) return {1, 0};
            h.imaginary = detail::with_sign(h.imaginary, -of_plane);
        }
        const double magnitude = std::abs(h.real) + std::abs(h.imaginary);
        if (!(magnitude > 0)) return {1, 0};
        if (!(magnitude > least)) {
            const int up = -std::ilogb(magnitude);
            h = {std::ldexp(h.real, up), std::ldexp(h.imaginary, up)};
        }
        return h;
    }

private:
    double re_[count] = {1, 1, 1, 1, 1, 1, 1, 1}, im_[count] = {}, turns_[count] = {};
};

}  // namespace hedgerow
