/// Files in which long work keeps what it needs to go on after an interruption.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hedgerow {

/// What work has come to, and what it is of. All that the result depends on is a line of `of`: its name and
/// its value, such as ("seed", "7").
struct WorkState {
    std::vector<std::pair<std::string, std::string>> of;
    std::vector<std::byte> bytes;
};

/// Writes a state of some kind of work ("paths") in a version of its layout, with a checksum, under another
/// name beside `path`, and renames it: so `path` holds the state before or this one, whenever the program is
/// killed. Its bytes are those of `parts`, one after the other, and no copy of them is made. Numbers among
/// them are in the processor's order, which is checked when they are read. Throws OutputError if it cannot be
/// written.
void save_state(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                std::span<const std::pair<std::string, std::string>> of,
                std::span<const std::span<const std::byte>> parts);

/// Reads a state. Throws InputError for a file that is no state of this kind and version, that is cut short
/// or damaged, and for the first line that differs from `expected`, which it names with both values.
WorkState load_state(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                     std::span<const std::pair<std::string, std::string>> expected);

}  // namespace hedgerow
