#include "file_bytes.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <hedgerow/base/error.h>
#include <hedgerow/base/stored.h>

#include "byte_source.h"

#if __has_include(<sys/mman.h>)
#define HEDGEROW_HAS_MMAP 1
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#else
#define HEDGEROW_HAS_MMAP 0
#endif

namespace hedgerow::detail {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
    throw InputError(path.string() + ": cannot be " + what + ": " +
                     (error == 0 ? "it ends early" : std::generic_category().message(error)) +
                     ". Check its permissions, and that nothing else writes to it");
}

struct alignas(64) CacheLine {
    std::byte bytes[64];
};

}  // namespace

FileBytes read_file(const std::filesystem::path& path) {
    check_readable(path);
    errno = 0;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) fail(path, "opened", errno);
    std::error_code error;
    const auto size = static_cast<std::size_t>(std::filesystem::file_size(path, error));
    if (error) fail(path, "read", error.value());
    const auto memory =
        std::make_shared<Stored<CacheLine>>((size + sizeof(CacheLine) - 1) / sizeof(CacheLine));
    std::byte* const data = reinterpret_cast<std::byte*>(memory->data());
    errno = 0;
    if (std::fread(data, 1, size, file.get()) != size) fail(path, "read", errno);
    return {memory, data, size};
}

#if HEDGEROW_HAS_MMAP
FileBytes mapped_file(const std::filesystem::path& path) {
    check_readable(path);
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail(path, "opened", errno);
    struct stat facts {};
    void* data = MAP_FAILED;
    std::size_t size = 0;
    if (::fstat(file, &facts) == 0 && facts.st_size > 0) {
        size = static_cast<std::size_t>(facts.st_size);
        data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, file, 0);
    }
    const int error = errno;
    ::close(file);
    if (data == MAP_FAILED) fail(path, "mapped", error);
    return {{data, [size](void* mapping) { ::munmap(mapping, size); }}, static_cast<std::byte*>(data), size};
}
#else
FileBytes mapped_file(const std::filesystem::path& path) {
    return read_file(path);
}
#endif

}  // namespace hedgerow::detail
