#include <hedgerow/measure/quantity.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace hedgerow::measure {
namespace {

/// Separates thousands by commas.
std::string grouped(std::string digits) {
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), ",");
    return digits;
}

struct Unit {
    double least;
    const char* name;
};
template <std::size_t N>
std::string in_units(double value, const Unit (&units)[N]) {
    for (const Unit& u : units)
        if (std::fabs(value) >= 0.9995 * u.least) return number_text(value / u.least) + " " + u.name;
    return number_text(value / units[N - 1].least) + " " + units[N - 1].name;
}

}  // namespace

std::string number_text(double value) {
    if (!std::isfinite(value)) return value > 0 ? "inf" : value < 0 ? "-inf" : "nan";
    if (value < 0) return "-" + number_text(-value);
    char text[64];
    // Write a number in full if it is whole up to rounding errors: 1e-5 s are 10 us.
    if (std::fabs(value - std::round(value)) <= 1e-12 * value && value < 1e15) {
        std::snprintf(text, sizeof text, "%.0f", value);
        return grouped(text);
    }
    // Write three significant digits, with an exponent only for very small and very large numbers.
    std::snprintf(text, sizeof text, "%.2e", value);
    const int exponent = std::atoi(std::strchr(text, 'e') + 1);
    if (exponent < -4 || exponent >= 15) return text;
    std::snprintf(text, sizeof text, "%.*f", std::max(0, 2 - exponent), value);
    return exponent > 2 ? grouped(text) : text;
}

std::string count_text(double count) {
    for (const auto& [least, name] : {std::pair{1e9, "G"}, {1e6, "M"}, {1e3, "k"}})
        if (count >= 0.9995 * least && std::isfinite(count)) return number_text(count / least) + name;
    return number_text(count);
}
std::string seconds_text(double seconds) {
    return in_units(seconds, {{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}});
}
std::string bytes_text(double bytes) {
    return in_units(bytes, {{1e9, "GB"}, {1e6, "MB"}, {1e3, "kB"}, {1, "B"}});
}

}  // namespace hedgerow::measure
