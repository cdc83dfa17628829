/// The options of a structure, told once. A struct of options lists its members with their ranges and
/// meanings; help, parsers, tests and bindings read that list.
#pragma once

#include <charconv>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hedgerow {

/// The names of an option that is on or off.
inline constexpr std::string_view flag_names[] = {"off", "on"};

/// An option, for people. `values` and `standard` (the default) read as one would write them.
struct OptionInfo {
    std::string_view name;
    std::string values;                         ///< "off|on", "sah|binned|median", "2..256"
    std::string standard;                       ///< "on", "sah", "32"
    std::string_view meaning;                   ///< a line
    std::span<const std::string_view> choices;  ///< the values of an enumeration or a flag; empty for numbers
};

/// Collects what a struct of options lists:
///
///     OptionInfos infos;
///     KdOptions().list(infos);
///
/// `list(option)` calls `option` for each member: (name, number, least, most, meaning), (name, flag, meaning)
/// or (name, enumerator, names, meaning), where the names are in the order of the enumeration. The values are
/// the defaults. Other callables read text into the members or check them.
struct OptionInfos {
    std::vector<OptionInfo> all;

    template <class N>
    void operator()(std::string_view name, const N& value, std::type_identity_t<N> least,
                    std::type_identity_t<N> most, std::string_view meaning) {
        all.push_back({name, text(least) + ".." + text(most), text(value), meaning, {}});
    }
    template <class E>
    void operator()(std::string_view name, const E& value, std::span<const std::string_view> names,
                    std::string_view meaning) {
        std::string values;
        for (const auto n : names) values += (values.empty() ? "" : "|") + std::string(n);
        all.push_back({name, values, std::string(names[static_cast<std::size_t>(value)]), meaning, names});
    }
    void operator()(std::string_view name, const bool& value, std::string_view meaning) {
        (*this)(name, value, flag_names, meaning);
    }

    /// The fewest digits that read back as the number.
    template <class N>
    static std::string text(N number) {
        char digits[64];
        return {digits, std::to_chars(std::begin(digits), std::end(digits), number).ptr};
    }
};

}  // namespace hedgerow
