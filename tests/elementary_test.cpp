// The elementary functions against those of the C library in long double, their special values, and the bits
// of some results.
#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hedgerow/geometry/elementary.h>

namespace hedgerow {
namespace {

constexpr int points = 100000;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr float infinity_f = std::numeric_limits<float>::infinity();
constexpr double nan_d = std::numeric_limits<double>::quiet_NaN();
constexpr long double pi = std::numbers::pi_v<long double>;

// The error of a result in units in the last place of T at the exact value.
template <std::floating_point T>
double ulps(T result, long double exact) {
    const auto limits = std::numeric_limits<T>();
    if (std::isnan(exact)) return std::isnan(result) ? 0 : infinity;
    if (std::isinf(result)) return std::abs(exact) >= static_cast<long double>(limits.max()) ? 0 : infinity;
    if (std::isinf(exact) || std::isnan(result)) return infinity;
    const int exponent =
        exact == 0 ? limits.min_exponent - 1 : std::max(std::ilogb(exact), limits.min_exponent - 1);
    const long double unit = std::ldexp(1.0L, exponent - limits.digits + 1);
    return static_cast<double>(std::abs(static_cast<long double>(result) - exact) / unit);
}

// Random numbers of one sign whose exponents are uniform between those of two bounds.
template <std::floating_point T>
std::vector<T> spread(T least, T most, int n = points) {
    using Bits = typename detail::FloatLayout<T>::Bits;
    std::mt19937_64 random(7);
    std::uniform_int_distribution<Bits> bits(std::bit_cast<Bits>(least), std::bit_cast<Bits>(most));
    std::vector<T> all = {least, most};
    for (int i = 0; i < n; ++i) all.push_back(std::bit_cast<T>(bits(random)));
    return all;
}
template <std::floating_point T>
std::vector<T> with_both_signs(std::vector<T> all) {
    const std::size_t n = all.size();
    for (std::size_t i = 0; i < n; ++i) all.push_back(-all[i]);
    return all;
}
template <std::floating_point T>
std::vector<T> uniform(T least, T most) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<T> from(least, most);
    std::vector<T> all = {least, most};
    for (int i = 0; i < points; ++i) all.push_back(from(random));
    return all;
}
// Each number and the numbers next to it.
template <std::floating_point T>
void add_around(std::vector<T>& all, T x) {
    T down = x, up = x;
    all.push_back(x);
    for (int i = 0; i < 4; ++i) {
        all.push_back(down = std::nextafter(down, -std::numeric_limits<T>::infinity()));
        all.push_back(up = std::nextafter(up, std::numeric_limits<T>::infinity()));
    }
}

template <std::floating_point T, class F, class G>
void expect_close(const char* name, const std::vector<T>& arguments, F f, G exact, double limit) {
    double worst = 0;
    T at = 0;
    for (const T x : arguments) {
        const double error = ulps<T>(f(x), exact(static_cast<long double>(x)));
        if (!(error <= worst)) worst = error, at = x;
    }
    EXPECT_LE(worst, limit) << name << ", worst at " << std::hexfloat << at;
    ::testing::Test::RecordProperty(name, std::to_string(worst));
}

// Angles of all sizes, and angles near multiples of π/4. Of all doubles up to 2^20, the first one here is the
// nearest to a multiple of π/2: 2^-60 away. The second is the nearest one above 2^12.
std::vector<double> angles() {
    std::vector<double> all = spread(0x1p-60, 0x1p20);
    all.insert(all.end(), {0x1.6c6cbc45dc8dep+5, 0x1.39c6fd67805a7p+18});
    for (int i = 1; i < 4000; ++i) add_around(all, static_cast<double>(i * pi / 4));
    for (int i = 1300000; i < 1303000; ++i) add_around(all, static_cast<double>(i * pi / 4));
    return with_both_signs(all);
}

TEST(Elementary, SineCosineAndTangentAreWithinOneUnit) {
    const auto all = angles();
    expect_close(
        "sine", all, sine, [](long double x) { return std::sin(x); }, 1);
    expect_close(
        "cosine", all, cosine, [](long double x) { return std::cos(x); }, 1);
    expect_close(
        "tangent", all, tangent, [](long double x) { return std::tan(x); }, 1);
}

TEST(Elementary, LargeAnglesAreRoundedByHalfAUnit) {
    for (const double x : spread(0x1p20, 0x1p60, 2000)) {
        const double unit = std::nextafter(x, infinity) - x;
        EXPECT_NEAR(sine(x), static_cast<double>(std::sin(static_cast<long double>(x))), 0.51 * unit + 1e-15)
            << x;
        EXPECT_NEAR(cosine(x), static_cast<double>(std::cos(static_cast<long double>(x))),
                    0.51 * unit + 1e-15)
            << x;
    }
    for (const double x : spread(0x1p60, std::numeric_limits<double>::max(), 2000)) {
        EXPECT_LE(std::abs(sine(x)), 1) << x;
        EXPECT_LE(std::abs(cosine(x)), 1) << x;
        EXPECT_FALSE(std::isnan(tangent(x))) << x;
    }
}

TEST(Elementary, ExponentialIsWithinOneUnit) {
    auto all = with_both_signs(spread(0x1p-70, 800.0));
    for (const double x : uniform(-746.0, 710.0)) all.push_back(x);
    for (int k = -1075; k <= 1024; ++k) add_around(all, static_cast<double>((k + 0.5L) * std::log(2.0L)));
    expect_close(
        "exponential", all, [](double x) { return exponential(x); },
        [](long double x) { return std::exp(x); }, 1);
}

TEST(Elementary, LogarithmIsWithinOneUnit) {
    auto all = spread(std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max());
    for (const double x : uniform(0.5, 2.0)) all.push_back(x);
    for (const double x : spread(0x1p-52, 0x1p-1)) all.push_back(1 + x), all.push_back(1 - x);
    add_around(all, 1.0), add_around(all, std::sqrt(2.0)), add_around(all, std::sqrt(0.5));
    expect_close(
        "logarithm", all, logarithm, [](long double x) { return std::log(x); }, 1);
}

TEST(Elementary, PowerIsWithinOneUnitForModerateExponents) {
    const auto bases = spread(0x1p-40, 1e6), exponents = uniform(0.1, 10.0);
    for (const double exponent : {2.4, 1 / 2.4, 0.1, 0.25, 1.0, 1.5, 10.0, -1.0, -2.2})
        expect_close(
            "power", bases, [&](double x) { return power(x, exponent); },
            [&](long double x) { return std::pow(x, static_cast<long double>(exponent)); }, 1);
    double worst = 0;
    for (std::size_t i = 0; i < exponents.size(); ++i)
        worst = std::max(
            worst, ulps(power(bases[i], exponents[i]), std::pow(static_cast<long double>(bases[i]),
                                                                static_cast<long double>(exponents[i]))));
    EXPECT_LE(worst, 1);
    RecordProperty("power_of_any", std::to_string(worst));
}

TEST(Elementary, PowerIsWithinTwoUnitsForAllExponents) {
    const auto bases = spread(1e-300, 1e300), logs = uniform(-745.0, 709.0);
    auto near_one = spread(0x1p-52, 0x1p-1);
    for (double& x : near_one) x += 1;
    double worst = 0;
    for (const bool near : {false, true})
        for (std::size_t i = 0; i < logs.size(); ++i) {
            const double base = near ? near_one[i] : bases[i], exponent = logs[i] / std::log(base);
            if (base == 1) continue;
            worst = std::max(
                worst, ulps(power(base, exponent),
                            std::pow(static_cast<long double>(base), static_cast<long double>(exponent))));
        }
    EXPECT_LE(worst, 2);
    RecordProperty("power_of_all", std::to_string(worst));
}

TEST(Elementary, ArcTangentIsWithinOneUnit) {
    const auto x = with_both_signs(spread(0x1p-40, 0x1p40)), y = with_both_signs(uniform(-3.0, 3.0));
    double worst = 0;
    const auto check = [&](double up, double along) {
        worst = std::max(worst, ulps(arc_tangent(up, along), std::atan2(static_cast<long double>(up),
                                                                        static_cast<long double>(along))));
    };
    for (std::size_t i = 0; i < x.size(); ++i)
        check(y[i], x[i]), check(x[i], y[i]), check(y[i], y[(i * 7) % y.size()]);
    const auto wide = with_both_signs(spread(0x1p-1074, 0x1.fp1023));
    for (std::size_t i = 0; i < wide.size(); ++i) check(wide[i], wide[(i * 5 + 3) % wide.size()]);
    for (const double size : {0x1p-1060, 0x1p-1000, 1.0, 0x1p1020})
        for (int i = -40; i <= 40; ++i)
            for (int j = -40; j <= 40; ++j)
                check(std::nextafter(i * size / 16, infinity), j * size / 16), check(i * size / 16, j * size);
    EXPECT_LE(worst, 1);
    RecordProperty("arc_tangent", std::to_string(worst));
}

TEST(Elementary, ArcCosineIsWithinTwoUnits) {
    auto all = with_both_signs(spread(0x1p-60, 1.0));
    for (const double x : spread(0x1p-53, 0.5)) all.push_back(1 - x), all.push_back(x - 1);
    expect_close(
        "arc_cosine", all, arc_cosine, [](long double x) { return std::acos(x); }, 2);
}

TEST(Elementary, FloatsAreWithinTwoUnits) {
    auto turns = with_both_signs(spread(0x1p-140f, 0x1p30f));
    for (int i = 0; i < 64; ++i) add_around(turns, static_cast<float>(i) / 8);
    // Reduce exactly: the long double of 2πu is not exact for large u.
    const auto angle = [](long double u) { return 2 * pi * (u - std::nearbyint(4 * u) / 4); };
    const auto quarter = [](long double u) {
        return static_cast<int>(std::fmod(std::nearbyint(4 * u), 4.0L)) & 3;
    };
    const auto sine_of = [&](long double u, int more) {
        const int n = (quarter(u) + more) & 3;
        const long double value = (n & 1) != 0 ? std::cos(angle(u)) : std::sin(angle(u));
        return n >= 2 ? -value : value;
    };
    expect_close(
        "float sine", turns, [](float u) { return sine_cosine_of_turns(u).sine; },
        [&](long double u) { return sine_of(u, 0); }, 2);
    expect_close(
        "float cosine", turns, [](float u) { return sine_cosine_of_turns(u).cosine; },
        [&](long double u) { return sine_of(u, 1); }, 2);
    auto exponents = with_both_signs(spread(0x1p-40f, 110.f));
    for (const float x : uniform(-104.f, 89.f)) exponents.push_back(x);
    expect_close(
        "float exponential", exponents, [](float x) { return exponential(x); },
        [](long double x) { return std::exp(x); }, 2);
}

TEST(Elementary, FloatArcTangentIsWithinTwoUnits) {
    const auto x = with_both_signs(spread(0x1p-30f, 0x1p30f)), y = with_both_signs(uniform(-3.f, 3.f));
    const auto wide = with_both_signs(spread(0x1p-149f, 0x1.fp127f));
    double worst = 0;
    const auto check = [&](float up, float along) {
        worst = std::max(worst, ulps(arc_tangent(up, along), std::atan2(static_cast<long double>(up),
                                                                        static_cast<long double>(along))));
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
        check(y[i], x[i]), check(x[i], y[i]), check(y[i], y[(i * 7) % y.size()]);
        check(wide[i], wide[(i * 5 + 3) % wide.size()]);
    }
    EXPECT_LE(worst, 2);
    RecordProperty("float arc_tangent", std::to_string(worst));
}

// ---- Special values

// Whether two numbers have the same bits, or both are NaN.
template <std::floating_point T>
bool same(T a, T b) {
    return (a == b && std::signbit(a) == std::signbit(b)) || (std::isnan(a) && std::isnan(b));
}

TEST(Elementary, NanInGivesNanOut) {
    EXPECT_TRUE(std::isnan(sine(nan_d)) && std::isnan(cosine(nan_d)) && std::isnan(tangent(nan_d)));
    EXPECT_TRUE(std::isnan(sine(infinity)) && std::isnan(cosine(-infinity)) && std::isnan(tangent(infinity)));
    EXPECT_TRUE(std::isnan(exponential(nan_d)) && std::isnan(logarithm(nan_d)) &&
                std::isnan(arc_cosine(nan_d)));
    EXPECT_TRUE(std::isnan(power(nan_d, 2)) && std::isnan(power(2, nan_d)));
    EXPECT_TRUE(std::isnan(arc_tangent(nan_d, 1.0)) && std::isnan(arc_tangent(1.0, nan_d)));
    const auto nan_f = static_cast<float>(nan_d);
    EXPECT_TRUE(std::isnan(exponential(nan_f)) && std::isnan(arc_tangent(nan_f, 1.f)));
    for (const float u : {nan_f, infinity_f, -infinity_f})
        EXPECT_TRUE(std::isnan(sine_cosine_of_turns(u).sine) && std::isnan(sine_cosine_of_turns(u).cosine));
}

TEST(Elementary, LimitsAreThoseOfTheLibrary) {
    EXPECT_TRUE(same(sine(-0.0), -0.0) && same(tangent(-0.0), -0.0) && cosine(0) == 1);
    EXPECT_EQ(exponential(0.0), 1);
    EXPECT_EQ(exponential(infinity), infinity);
    EXPECT_EQ(exponential(709.79), infinity);
    EXPECT_TRUE(same(exponential(-infinity), 0.0) && same(exponential(-745.2), 0.0));
    EXPECT_EQ(exponential(-745.1), std::numeric_limits<double>::denorm_min());
    EXPECT_TRUE(logarithm(0) == -infinity && logarithm(-0.0) == -infinity && logarithm(infinity) == infinity);
    EXPECT_TRUE(same(logarithm(1), 0.0) && std::isnan(logarithm(-1)) && std::isnan(logarithm(-infinity)));
    EXPECT_TRUE(arc_cosine(1) == 0 && arc_cosine(2) == 0 && arc_cosine(-1) == std::numbers::pi);
    EXPECT_TRUE(arc_cosine(-infinity) == std::numbers::pi && arc_cosine(0) == std::numbers::pi / 2);
    EXPECT_TRUE(exponential(0.f) == 1 && exponential(89.f) == infinity_f && exponential(-104.f) == 0);
    EXPECT_TRUE(exponential(infinity_f) == infinity_f && exponential(-infinity_f) == 0);
}

TEST(Elementary, LimitsOfPowerAreThoseOfTheLibrary) {
    const double tiny = std::numeric_limits<double>::denorm_min(), huge = std::numeric_limits<double>::max();
    for (const double base : {0.0, tiny, 0.5, 1.0, 1.0000001, 2.0, huge, infinity})
        for (const double exponent :
             {-infinity, -huge, -3.0, -tiny, -0.0, 0.0, tiny, 0.5, 2.0, huge, infinity})
            EXPECT_LE(ulps(power(base, exponent),
                           std::pow(static_cast<long double>(base), static_cast<long double>(exponent))),
                      1)
                << base << "^" << exponent << " = " << power(base, exponent);
    EXPECT_TRUE(std::isnan(power(-2, 2)) && power(nan_d, 0) == 1 && power(1, nan_d) == 1);
}

template <std::floating_point T>
void expect_limits_of_arc_tangent() {
    constexpr T inf = std::numeric_limits<T>::infinity();
    for (const T y : {-inf, T(-2), T(-0.0), T(0), T(2), inf})
        for (const T x : {-inf, T(-2), T(-0.0), T(0), T(2), inf}) {
            const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
            EXPECT_TRUE(same(arc_tangent(y, x), static_cast<T>(exact))) << y << ", " << x;
        }
}
TEST(Elementary, LimitsOfArcTangentAreThoseOfTheLibrary) {
    expect_limits_of_arc_tangent<double>();
    expect_limits_of_arc_tangent<float>();
}

TEST(Elementary, QuartersOfATurnAreExact) {
    const float sines[4] = {0, 1, 0, -1};
    for (int i = 0; i < 16; ++i) {
        const float u = static_cast<float>(i) / 4;
        const auto [s, c] = sine_cosine_of_turns(u);
        EXPECT_EQ(s, sines[i & 3]);
        EXPECT_EQ(c, sines[(i + 1) & 3]);
        EXPECT_EQ(sine_cosine_of_turns(-u).sine, -s);
        EXPECT_EQ(sine_cosine_of_turns(-u).cosine, c);
    }
    EXPECT_EQ(sine_cosine_of_turns(0x1p23f + 1).sine, 0);
    EXPECT_EQ(sine_cosine_of_turns(0x1p127f).cosine, 1);
    EXPECT_EQ(sine_cosine_of_turns(0x1p21f + 0.25f).sine, 1);
}

// ---- Monotonic functions

template <std::floating_point T, class F>
void expect_rising(T from, F f) {
    T x = from, before = f(x);
    for (int i = 0; i < 2000; ++i) {
        x = std::nextafter(x, std::numeric_limits<T>::infinity());
        const T now = f(x);
        ASSERT_GE(now, before) << std::hexfloat << x;
        before = now;
    }
}

TEST(Elementary, RisingFunctionsNeverFall) {
    for (const double x : {-700.0, -1.0, -0.34657359027997264, 0.3, 0.34657359027997264, 1.0396, 20.0, 700.0})
        expect_rising(x, [](double at) { return exponential(at); });
    for (const double x : {1e-310, 0.5, 0.70710678118654746, 0.9999999999999, 1.4142135623730949, 1e6})
        expect_rising(x, logarithm);
    for (const double x : {1e-9, 0.0031308, 0.0441, 0.5, 0.9999999999999})
        expect_rising(x, [](double at) { return power(at, 2.4); });
    for (const double x : {0.0624999999999999, 0.18749999999999, 0.5, 0.99999999999999, 5.0})
        expect_rising(x, [](double at) { return arc_tangent(at, 1.0); });
    for (const double x : {0.1, 0.7853981633974482, 1.5, 1.57079632679}) expect_rising(x, sine);
}

// ---- The bits of results

TEST(Elementary, ResultsHaveTheseBits) {
    EXPECT_EQ(sine(0.1), 0x1.98eaecb8bcb2cp-4);
    EXPECT_EQ(sine(2.5), 0x1.326af0dcfcabp-1);
    EXPECT_EQ(sine(-123456.789), 0x1.ff50e60ab53f9p-1);
    EXPECT_EQ(sine(1e22), 0x1.bf809b25497f6p-1);
    EXPECT_EQ(cosine(0.7), 0x1.87996529f9d93p-1);
    EXPECT_EQ(cosine(4), -0x1.4eaa606db24c1p-1);
    EXPECT_EQ(cosine(999999.5), 0x1.4efdfc640fc4dp-1);
    EXPECT_EQ(tangent(0.39269908169872414), 0x1.a827999fcef32p-2);
    EXPECT_EQ(tangent(1.5), 0x1.c33ed50b88777p+3);
    EXPECT_EQ(tangent(-31415.9), 0x1.b2ddc1144b1b8p-6);
    EXPECT_EQ(exponential(1.0), 0x1.5bf0a8b145769p+1);
    EXPECT_EQ(exponential(-0.3), 0x1.7b4c869c37c05p-1);
    EXPECT_EQ(exponential(100.25), 0x1.8c39b9134bac4p+144);
    EXPECT_EQ(exponential(-740.5), 0x0.0000000000033p-1022);
    EXPECT_EQ(logarithm(2), 0x1.62e42fefa39efp-1);
    EXPECT_EQ(logarithm(0.9), -0x1.af8e8210a415cp-4);
    EXPECT_EQ(logarithm(1e-310), -0x1.64e69394d9508p+9);
    EXPECT_EQ(logarithm(12345.678), 0x1.2d79559791e31p+3);
    EXPECT_EQ(power(0.5, 2.4), 0x1.8406003b2ae5dp-3);
    EXPECT_EQ(power(0.2, 1 / 2.4), 0x1.05d67ea37fcb9p-1);
    EXPECT_EQ(power(1e6, 9.9), 0x1.40221e67eb29bp+197);
    EXPECT_EQ(power(1.5, -30.25), 0x1.3c3de7eb645cep-18);
    EXPECT_EQ(arc_tangent(0.3, 1.0), 0x1.2a73a661eaf06p-2);
    EXPECT_EQ(arc_tangent(-2.0, -0.7), -0x1.e850076ee9e8ep+0);
    EXPECT_EQ(arc_tangent(1e-300, 3e-300), 0x1.4978fa3269ee1p-2);
    EXPECT_EQ(arc_cosine(0.3), 0x1.441f5ecbeef59p+0);
    EXPECT_EQ(arc_cosine(-0.99), 0x1.8001be1bc011bp+1);
    EXPECT_EQ(sine_cosine_of_turns(0.1f).sine, 0x1.2cf23p-1f);
    EXPECT_EQ(sine_cosine_of_turns(0.1f).cosine, 0x1.9e3778p-1f);
    EXPECT_EQ(sine_cosine_of_turns(-7.3f).sine, -0x1.e6f0d4p-1f);
    EXPECT_EQ(sine_cosine_of_turns(1234.56f).cosine, -0x1.dbf9e4p-1f);
    EXPECT_EQ(exponential(1.f), 0x1.5bf0a8p+1f);
    EXPECT_EQ(exponential(-0.7f), 0x1.fc80dcp-2f);
    EXPECT_EQ(exponential(-100.5f), 0x1p-145f);
    EXPECT_EQ(exponential(60.3f), 0x1.fe0e28p+86f);
    EXPECT_EQ(arc_tangent(0.3f, 1.f), 0x1.2a73a8p-2f);
    EXPECT_EQ(arc_tangent(-2.f, -0.7f), -0x1.e85008p+0f);
    EXPECT_EQ(arc_tangent(0.6f, -1.f), 0x1.4cf33ep+1f);
}

}  // namespace
}  // namespace hedgerow
