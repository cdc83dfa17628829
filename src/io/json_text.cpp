/// Parses JSON through nlohmann-json, after a check of the memory that its values need.
#include "json_text.h"

#include <hedgerow/base/error.h>

#include "memory.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

constexpr int deepest = 64;
/// The most bytes that a value takes: as a member of an object with a short key.
constexpr std::uint64_t bytes_a_value = 128;
/// The most bytes that a letter of a string takes: in the string, and in the parser's buffer, which doubles.
constexpr std::uint64_t bytes_a_letter = 3;

/// An upper bound on the number of values: counts the commas and opening brackets outside of strings. Throws
/// if brackets are nested too deep.
std::uint64_t count_values(std::string_view text, const std::string& name) {
    std::uint64_t values = 1;
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            ++values;
            if (++depth > deepest)
                throw InputError(name + ", byte " + std::to_string(i) + " of its JSON: is nested more than " +
                                 std::to_string(deepest) + " deep, as no scene is. Write the file again");
        } else if (c == ']' || c == '}') {
            --depth;
        } else if (c == ',') {
            ++values;
        }
    }
    return values;
}

/// The parser's message without its number, cut to 160 letters, with '?' for bytes that no message should
/// hold.
std::string reason(std::string_view what) {
    if (what.starts_with('[')) what.remove_prefix(std::min(what.find(']') + 1, what.size()));
    std::string text;
    for (const char c : trimmed(what).substr(0, 160)) text.push_back(c >= ' ' && c <= '~' ? c : '?');
    return text;
}

}  // namespace

nlohmann::json parse_json(std::string_view text, const std::string& name) {
    const std::uint64_t values = count_values(text, name);
    expect_memory(name, "its " + std::to_string(values) + " JSON values",
                  values * bytes_a_value + text.size() * bytes_a_letter);
    try {
        return nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& error) {
        throw InputError(name + ": its JSON cannot be read (" + reason(error.what()) +
                         "). Was the file cut off or altered?");
    }
}

}  // namespace hedgerow::detail
