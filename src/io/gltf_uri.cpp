/// Data URIs (RFC 2397) and relative references (RFC 3986), as far as glTF uses them, and relative paths.
#include "gltf_uri.h"

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include <hedgerow/base/error.h>

#include "text.h"

namespace hedgerow::detail {

namespace {

constexpr std::uint8_t no_digit = 0xFF;

/// The value of each base64 digit (RFC 4648).
constexpr std::array<std::uint8_t, 256> base64_values() {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(no_digit);
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = static_cast<std::uint8_t>(i);
    return values;
}

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// Replaces each %XX by its character. Nothing if a %XX is broken or there is a control character.
std::optional<std::string> percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        char c = uri[i];
        if (c == '%') {
            const int high = i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
            const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
            if (high < 0 || low < 0) return std::nullopt;
            c = static_cast<char>(high * 16 + low);
            i += 2;
        }
        if (static_cast<unsigned char>(c) < ' ') return std::nullopt;
        text.push_back(c);
    }
    return text;
}

/// Whether a file is in a folder once all links are followed. The folder's path is not empty.
bool holds(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const auto whole_folder = std::filesystem::weakly_canonical(folder, error);
    if (error) return false;
    const auto whole = std::filesystem::weakly_canonical(file, error);
    if (error) return false;
    const auto [at, rest] =
        std::mismatch(whole_folder.begin(), whole_folder.end(), whole.begin(), whole.end());
    return at == whole_folder.end();
}

[[noreturn]] void fail_name(std::string_view text, const std::string& name, const std::string& what,
                            const std::string& why) {
    throw InputError(name + ": its " + what + " " + shown(text) + " " + why + ". A " + what +
                     " is read from the scene's own folder: put the file there");
}

}  // namespace

std::string bytes_of_data_uri(std::string_view uri, const std::string& name) {
    static constexpr auto values = base64_values();
    const auto comma = uri.find(',');
    if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
        throw InputError(name + ": a data URI, " + shown(uri) + ", is not base64. Export the file again");
    std::string_view digits = uri.substr(comma + 1);
    while (digits.ends_with('=')) digits.remove_suffix(1);
    std::string bytes;
    bytes.reserve(digits.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    // Each digit adds 6 bits; take out a byte whenever there are 8.
    for (std::size_t i = 0; i < digits.size(); ++i) {
        const std::uint8_t value = values[static_cast<unsigned char>(digits[i])];
        if (value == no_digit)
            throw InputError(name + ": letter " + std::to_string(i) +
                             " of a data URI's data is no base64 digit. Fetch or export the file again");
        bits = bits << 6 | value;
        if ((held += 6) >= 8) bytes.push_back(static_cast<char>(bits >> (held -= 8)));
    }
    return bytes;
}

std::filesystem::path file_of_uri(std::string_view uri, const std::filesystem::path& scene,
                                  const std::string& name, const std::string& what) {
    const auto text = percent_decoded(uri);
    if (!text) fail_name(uri, name, what, "is no name of a file");
    if (text->find('\\') != text->npos) fail_name(uri, name, what, "has a backslash");
    return file_beside(*text, scene, name, what);
}

std::filesystem::path file_beside(std::string_view path, const std::filesystem::path& scene,
                                  const std::string& name, const std::string& what) {
    const auto fail = [&](const std::string& why) { fail_name(path, name, what, why); };
    // The path of a scene may have no folder: the scene is then in the current one.
    const std::filesystem::path folder = scene.has_parent_path() ? scene.parent_path() : ".";
    std::string text(path);
    std::replace(text.begin(), text.end(), '\\', '/');
    if (text.empty() || text.find('\0') != text.npos) fail("is no name of a file");
    if (text.find(':') != text.npos) fail("has a scheme or a drive");
    const std::filesystem::path relative(text);
    if (relative.is_absolute()) fail("is an absolute path");
    if (std::find(relative.begin(), relative.end(), "..") != relative.end()) fail("leaves the folder");
    if (!holds(folder, folder / relative)) fail("is a link that leaves the folder");
    return folder / relative;
}

}  // namespace hedgerow::detail
