/// A file that appears whole or not at all.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hedgerow::detail {

/// Writes beside `path`, under another name, and renames that in `commit`; what was not committed is removed.
/// What is no regular file (a pipe, a device) is written straight. All errors are InputError.
class OutputFile {
public:
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view bytes);
    template <class U>
    void little(U v) {
        char bytes[sizeof(U)];
        std::memcpy(bytes, &v, sizeof(U));
        if constexpr (std::endian::native != std::endian::little)
            for (std::size_t i = 0; i < sizeof(U) / 2; ++i) std::swap(bytes[i], bytes[sizeof(U) - 1 - i]);
        write({bytes, sizeof(U)});
    }
    std::FILE* stream() const { return file_; }
    /// The next byte's place, for formats that go back to fill in what they did not know. Pipes have none.
    std::uint64_t tell() const;
    void seek(std::uint64_t place);
    void commit();

private:
    [[noreturn]] void fail(int error) const;

    std::filesystem::path path_, written_;
    std::FILE* file_ = nullptr;
};

}  // namespace hedgerow::detail
