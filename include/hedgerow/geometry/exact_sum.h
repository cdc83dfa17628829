/// Exact signs of polynomials, for predicates whose sign rounding leaves in doubt.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// A sum of products of up to three finite doubles, without any rounding, overflow or underflow. Positive and
/// negative products are summed separately, each in a fixed-point number that is wide enough for all of them
/// (Kulisch 2008, the long accumulator). A product costs some 20 ns, so predicates filter first.
class ExactSum {
public:
    ExactSum& add(double a, double b, double c = 1) { return add_product(a, b, c, false); }
    ExactSum& subtract(double a, double b, double c = 1) { return add_product(a, b, c, true); }
    /// −1, 0 or 1.
    int sign() const {
        for (std::size_t i = words; i-- > 0;)
            if (positive_[i] != negative_[i]) return positive_[i] > negative_[i] ? 1 : -1;
        return 0;
    }

private:
    // A product is an integer of 159 bits times 2^e, with e from 3·(−1074) to 3·971.
    static constexpr int least_exponent = -1074;
    static constexpr std::size_t words = (3 * (971 - least_exponent) + 159) / 32 + 3;
    using Accumulator = std::array<std::uint32_t, words>;
    using Product = std::array<std::uint32_t, 6>;  // 159 bits, shifted by up to 31 more

    struct Parts {
        std::uint64_t significand;
        int exponent;  // of the significand's last bit, relative to least_exponent
        bool negative;
    };
    static Parts parts(double x) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const auto exponent = static_cast<int>(bits >> 52 & 2047);
        const std::uint64_t fraction = bits & ((std::uint64_t(1) << 52) - 1);
        if (exponent == 0) return {fraction, 0, x < 0};
        return {fraction | std::uint64_t(1) << 52, exponent - 1, x < 0};
    }
    static void multiply(Product& x, std::uint64_t factor) {
        const std::uint64_t low = factor & 0xFFFFFFFFu, high = factor >> 32;
        std::uint64_t carry = 0, before = 0;  // `before` is the word before this one
        for (auto& word : x) {
            const std::uint64_t by_low = word * low, by_high = before * high;
            const std::uint64_t sum =
                (by_low & 0xFFFFFFFFu) + (by_high & 0xFFFFFFFFu) + (carry & 0xFFFFFFFFu);
            carry = (by_low >> 32) + (by_high >> 32) + (carry >> 32) + (sum >> 32);
            before = word;
            word = static_cast<std::uint32_t>(sum);
        }
    }
    ExactSum& add_product(double a, double b, double c, bool subtracted) {
        const Parts p = parts(a), q = parts(b), r = parts(c);
        if (p.significand == 0 || q.significand == 0 || r.significand == 0) return *this;
        const auto exponent = static_cast<unsigned>(p.exponent + q.exponent + r.exponent);
        // Multiply the significands, and shift the product to the accumulator's words.
        Product x{static_cast<std::uint32_t>(p.significand), static_cast<std::uint32_t>(p.significand >> 32)};
        multiply(x, q.significand);
        multiply(x, r.significand);
        multiply(x, std::uint64_t(1) << exponent % 32);
        // Add the product to the sum of its sign, word by word.
        Accumulator& sum = (p.negative != q.negative) != (r.negative != subtracted) ? negative_ : positive_;
        std::uint64_t carry = 0;
        std::size_t at = exponent / 32;
        for (const auto word : x) {
            carry += std::uint64_t(sum[at]) + word;
            sum[at++] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        // Propagate the carry.
        for (; carry != 0; carry >>= 32) {
            carry += sum[at];
            sum[at++] = static_cast<std::uint32_t>(carry);
        }
        return *this;
    }

    Accumulator positive_{}, negative_{};
};

/// The side of the line through p and q on which x lies, in the plane of axes u and v: 1 if p, q, x turn
/// counterclockwise, −1 if clockwise, 0 if x is on the line. Exact.
template <int D>
[[gnu::noinline]] int exact_turn(const Vec<double, D>& p, const Vec<double, D>& q, const Vec<double, D>& x,
                                 int u, int v) {
    ExactSum sum;
    sum.add(q[u], x[v]).subtract(q[u], p[v]).subtract(p[u], x[v]);
    sum.subtract(q[v], x[u]).add(q[v], p[u]).add(p[v], x[u]);
    return sum.sign();
}

/// The side of a triangle's plane on which x lies: 1 if the normal (b − a) × (c − a) points to it, −1 if x is
/// behind, 0 if x is on the plane. Exact.
[[gnu::noinline]] inline int exact_side(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& x) {
    ExactSum sum;
    const auto add_determinant = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            sum.add(p[i], q[j], r[k]).subtract(p[i], q[k], r[j]);
        }
    };
    add_determinant(b, c, x);
    add_determinant(a, x, c);  // minus the determinant of a, c, x
    add_determinant(a, b, x);
    add_determinant(a, c, b);
    return sum.sign();
}

}  // namespace hedgerow
