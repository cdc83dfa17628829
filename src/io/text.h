/// Words and numbers of text files, in any locale.
#pragma once

#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace hedgerow::detail {

inline bool is_space(int c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
    while (!text.empty() && is_space(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
    return text;
}

/// Removes the first word from the front of `rest` and returns it; empty if no word is left.
inline std::string_view take_word(std::string_view& rest) {
    std::size_t begin = 0;
    while (begin < rest.size() && is_space(static_cast<unsigned char>(rest[begin]))) ++begin;
    std::size_t end = begin;
    while (end < rest.size() && !is_space(static_cast<unsigned char>(rest[end]))) ++end;
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

/// A text from a file, quoted for a message: at most 40 letters, with '?' for all but printable ASCII.
inline std::string shown(std::string_view text) {
    std::string q = "'";
    for (const char c : text.substr(0, 40)) q.push_back(c >= ' ' && c <= '~' ? c : '?');
    return q + (text.size() > 40 ? "...'" : "'");
}

/// The T for a number that from_chars only reports to be out of range: infinity if it is large, else the tiny
/// number or 0.
template <std::floating_point T>
T out_of_range(std::string_view text) {
    long double wide = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), wide);
    if (error == std::errc()) {
        if (wide > std::numeric_limits<T>::max()) return std::numeric_limits<T>::infinity();
        if (wide < std::numeric_limits<T>::lowest()) return -std::numeric_limits<T>::infinity();
        return static_cast<T>(wide);
    }
    const bool tiny = text.find("e-") != text.npos || text.find("E-") != text.npos;
    const T magnitude = tiny ? T(0) : std::numeric_limits<T>::infinity();
    return text.starts_with('-') ? -magnitude : magnitude;
}

/// All of `text` as a number, correctly rounded. A number that is too large becomes infinite; "nan" and "inf"
/// are numbers.
template <std::floating_point T>
std::optional<T> parse_real(std::string_view text) {
    if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range) return out_of_range<T>(text);
    return value;
}

template <std::integral I>
std::optional<I> parse_integer(std::string_view text) {
    if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
    I value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || error != std::errc()) return std::nullopt;
    return value;
}

/// A double of a file, rounded to T. A number that is too large becomes infinite.
template <std::floating_point T>
T rounded(double x) {
    if (x > static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::infinity();
    if (x < static_cast<double>(std::numeric_limits<T>::lowest())) return -std::numeric_limits<T>::infinity();
    return static_cast<T>(x);
}

/// A coordinate of a file, rounded to T. `most` becomes how far rounding moved it, if that is more.
template <std::floating_point T>
T coordinate(double x, double& most) {
    if constexpr (std::is_same_v<T, double>) {
        return x;
    } else {
        const T near = rounded<T>(x);
        const double moved = std::abs(x - static_cast<double>(near));
        if (moved > most && std::isfinite(near)) most = moved;
        return near;
    }
}
/// All of `text` as a coordinate, correctly rounded to T, as parse_real.
template <std::floating_point T>
std::optional<T> parse_coordinate(std::string_view text, double& most) {
    const auto wide = parse_real<double>(text);
    if constexpr (std::is_same_v<T, double>) {
        return wide;
    } else {
        if (!wide) return std::nullopt;
        const T near = coordinate<T>(*wide, most);
        // A double halfway between two floats may have been rounded to there. Subnormal floats are farther
        // apart than the bits that are looked at.
        constexpr std::uint64_t lower_bits = (std::uint64_t(1) << 29) - 1, half = std::uint64_t(1) << 28;
        const bool is_halfway = (std::bit_cast<std::uint64_t>(*wide) & lower_bits) == half;
        if (is_halfway || std::abs(near) <= 2 * std::numeric_limits<T>::min() ||
            std::abs(near) >= std::numeric_limits<T>::max())
            return parse_real<T>(text);
        return near;
    }
}

/// Appends the shortest decimals that read back as the same number.
template <class T>
void append_number(std::string& text, T value) {
    char digits[64];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    text.append(digits, end);
}

template <class T>
std::string shortest_text(T value) {
    std::string text;
    append_number(text, value);
    return text;
}

}  // namespace hedgerow::detail
