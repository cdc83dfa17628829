/// A state file is a line "hedgerow state KIND VERSION BYTE-ORDER LINES BYTES", the lines "NAME=VALUE", an
/// empty line, the bytes, and the checksum of all before it in eight bytes.
#include <hedgerow/io/state_file.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>
#include <string_view>

#include <hedgerow/base/error.h>

#include "checksum.h"
#include "file_bytes.h"
#include "output_file.h"

namespace hedgerow {

namespace {

constexpr const char* byte_order = std::endian::native == std::endian::little ? "little" : "big";

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
    throw InputError(path.string() + ": " + what + "; name another file, or remove this one and start anew");
}
std::string head_of(const std::string& kind, std::uint32_t version,
                    std::span<const std::pair<std::string, std::string>> of, std::size_t bytes) {
    std::string head = "hedgerow state " + kind + " " + std::to_string(version) + " " + byte_order + " " +
                       std::to_string(of.size()) + " " + std::to_string(bytes) + "\n";
    for (const auto& [name, value] : of) head += name + "=" + value + "\n";
    return head + "\n";
}
/// The text up to the next line break, which is passed over. Nothing if there is none.
std::string_view next_line(std::string_view& rest) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) return rest = {}, std::string_view();
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    return line;
}

}  // namespace

void save_state(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                std::span<const std::pair<std::string, std::string>> of,
                std::span<const std::span<const std::byte>> parts) {
    for (const auto& [name, value] : of)
        if ((name + value).find('\n') != std::string::npos || name.find('=') != std::string::npos)
            throw InputError("a line of a state has no line breaks, and its name no =");
    std::size_t bytes = 0;
    for (const auto& part : parts) bytes += part.size();
    detail::OutputFile file(path);
    detail::RunningChecksum checksum;
    const auto write = [&](std::string_view text) {
        checksum.add(text.data(), text.size());
        file.write(text);
    };
    write(head_of(kind, version, of, bytes));
    for (const auto& part : parts) write({reinterpret_cast<const char*>(part.data()), part.size()});
    file.little(checksum.value());
    file.commit();
}

WorkState load_state(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                     std::span<const std::pair<std::string, std::string>> expected) {
    const detail::FileBytes file = detail::read_file(path);
    const std::string_view all(reinterpret_cast<const char*>(file.data), file.size);
    std::string_view rest = all;
    std::istringstream head{std::string(next_line(rest))};
    std::string words[2], of_kind, order;
    std::uint64_t of_version = 0, lines = 0, bytes = 0;
    head >> words[0] >> words[1] >> of_kind >> of_version >> order >> lines >> bytes;
    if (!head || words[0] != "hedgerow" || words[1] != "state")
        refuse(path, "is no state of interrupted work");
    if (of_kind != kind) refuse(path, "is a state of other work: " + of_kind + ", not " + kind);
    if (of_version != version) refuse(path, "was written by another version of this program");
    if (order != byte_order) refuse(path, "was written by a processor with another byte order");
    WorkState state;
    for (std::uint64_t i = 0; i < lines && !rest.empty(); ++i) {
        const std::string_view line = next_line(rest);
        const std::size_t equals = std::min(line.find('='), line.size());
        state.of.emplace_back(line.substr(0, equals), line.substr(std::min(equals + 1, line.size())));
    }
    if (!next_line(rest).empty() || rest.size() < 8 || rest.size() - 8 != bytes)
        refuse(path, "is cut short or damaged");
    std::uint64_t stored = 0;
    for (std::size_t i = 0; i < 8; ++i)
        stored |= static_cast<std::uint64_t>(static_cast<unsigned char>(rest[rest.size() - 8 + i]))
                  << (8 * i);
    if (detail::checksum(all.data(), all.size() - 8) != stored)
        refuse(path, "is damaged: its checksum differs");
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto& [name, value] = expected[i];
        const bool there = i < state.of.size() && state.of[i].first == name;
        if (!there) refuse(path, "does not say what its " + name + " is");
        if (state.of[i].second != value)
            refuse(path, "has another " + name + ": " + state.of[i].second + ", not " + value);
    }
    state.bytes.resize(bytes);
    std::memcpy(state.bytes.data(), rest.data(), bytes);
    return state;
}

}  // namespace hedgerow
