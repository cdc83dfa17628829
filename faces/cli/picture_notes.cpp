#include "picture_notes.h"

#include <string>
#include <string_view>

#include <hedgerow/version.h>

namespace hedgerow::cli {

namespace {

std::string command;

/// A word as a shell takes it: in quotes, if it has to be.
std::string quoted(std::string_view word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,=+@%";
    if (!word.empty() && word.find_first_not_of(plain) == word.npos) return std::string(word);
    std::string q = "'";
    for (const char c : word)
        if (c == '\'')
            q += "'\\''";
        else
            q += c;
    return q + "'";
}

}  // namespace

void remember_command(int count, const char* const* arguments) {
    command = "hedgerow";
    for (int i = 1; i < count; ++i) command += ' ' + quoted(arguments[i]);
}

Notes picture_notes(std::uint64_t seed) {
    return {{"Software", std::string("hedgerow ") + version},
            {"Command", command},
            {"Seed", std::to_string(seed)}};
}

}  // namespace hedgerow::cli
