/// Files that need more memory than there is are refused before it is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include <hedgerow/error.h>
#include <hedgerow/io/memory.h>

namespace hedgerow::detail {

/// Bytes that the process's control group, or one around it, leaves it. `groups` lists the process's groups
/// (/proc/self/cgroup), and `mounted` is where their folders are (/sys/fs/cgroup). The largest number where
/// there is no limit.
std::uint64_t memory_left_to_group(const std::filesystem::path& groups, const std::filesystem::path& mounted);

/// "1.5 GB": a number of bytes as a person reads it.
std::string bytes_text(std::uint64_t bytes);

/// Throws InputError "NAME: WHAT need N GB of memory, but only M GB can be had. ..." if they do.
void expect_memory(const std::string& name, const std::string& what, std::uint64_t bytes);

/// What f returns. Memory that could not be had is an InputError that names the file.
template <class F>
auto within_memory(const std::filesystem::path& path, F f) {
    const auto fail = [&] {
        throw InputError(path.string() + ": what it holds needs more memory than the " +
                         bytes_text(memory_left()) +
                         " that can be had. Split the file, or read it where there is more");
    };
    try {
        return f();
    } catch (const std::bad_alloc&) {
        fail();
    } catch (const std::length_error&) {
        fail();
    }
    throw std::bad_alloc();  // not reached
}

}  // namespace hedgerow::detail
