/// Refuses files that need more memory than there is, before the memory is taken.
#pragma once

#include <cstdint>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/io/memory.h>

namespace hedgerow::detail {

/// Bytes that the process's control group, and the groups around it, leave the process. `groups` lists the
/// process's groups (/proc/self/cgroup), and `mounted` is where their folders are (/sys/fs/cgroup). The
/// largest number if there is no limit.
std::uint64_t memory_left_to_group(const std::filesystem::path& groups, const std::filesystem::path& mounted);

/// A number of bytes for people, such as "1.5 GB".
std::string bytes_text(std::uint64_t bytes);

/// Throws InputError "NAME: WHAT need N GB of memory, but only M GB can be had. ..." if `bytes` is more than
/// the memory that is left.
void expect_memory(const std::string& name, const std::string& what, std::uint64_t bytes);

/// Returns f(). If f cannot get the memory that it needs, throws an InputError that names the file.
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
