/// The bytes of a file, plain or gzipped, read once from front to back in bounded memory.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hedgerow/parallel/progress.h>

struct gzFile_s;

namespace hedgerow::detail {

/// Throws InputError if there is no regular, non-empty file, or only the pointer to one that Git LFS leaves
/// in its place.
void check_readable(const std::filesystem::path& path);

/// Whether a ByteSource may read pipes: "-" is then the standard input.
enum class Pipes : bool { no, yes };

/// A file or pipe that is read in pieces. Reports progress and checks for cancellation whenever its buffer is
/// filled; of a pipe no progress is known. All errors are InputError.
class ByteSource {
public:
    explicit ByteSource(const std::filesystem::path& path, const Progress& progress = {},
                        Pipes pipes = Pipes::no);
    ~ByteSource();
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;

    const std::string& name() const { return name_; }
    /// Bytes read so far, after decompression.
    std::uint64_t offset() const { return before_ + at_; }
    /// The most bytes that can follow: exact for a plain file, a bound for a compressed one (deflate packs at
    /// most 1032 to 1), the largest number for a pipe.
    std::uint64_t most_left() const;
    /// Throws Cancelled if reading was cancelled. For long work on data that are already read.
    void expect_not_cancelled() const;
    bool at_end() { return at_ == filled_ && !refill(); }
    /// The next byte, or −1.
    int peek() { return at_end() ? -1 : buffer_[at_]; }
    int next() { return at_end() ? -1 : buffer_[at_++]; }
    /// Up to `size` bytes; fewer only at the end of the file.
    std::size_t read(void* to, std::size_t size);
    /// Skips `size` bytes; false if the file ends before.
    bool skip(std::uint64_t size);
    /// The unread part of the buffer: at the start of a file its first 256 KiB, or the whole file if it is
    /// shorter.
    std::string_view ahead();
    /// Starts again at the first byte. Not of a pipe.
    void rewind();
    /// Reads a U whose bytes are in the order `order`; false if the file ends before.
    template <class U>
    bool value(U& v, std::endian order) {
        unsigned char bytes[sizeof(U)];
        if (filled_ - at_ >= sizeof(U)) {
            std::memcpy(bytes, buffer_.data() + at_, sizeof(U));
            at_ += sizeof(U);
        } else if (read(bytes, sizeof(U)) != sizeof(U)) {
            return false;
        }
        if (order != std::endian::native)
            for (std::size_t i = 0; i < sizeof(U) / 2; ++i) std::swap(bytes[i], bytes[sizeof(U) - 1 - i]);
        std::memcpy(&v, bytes, sizeof(U));
        return true;
    }

    /// Keeps the sentence "NAME: WHAT" for the report of the loader.
    void warn(const std::string& what) { warnings_.push_back(name_ + ": " + what); }
    std::vector<std::string> take_warnings() { return std::move(warnings_); }
    /// How far coordinates of the file were moved when they were rounded, at most: whoever rounds one writes
    /// it here (text.h).
    double& rounding() { return rounding_; }

    /// Throws InputError "NAME: WHAT".
    [[noreturn]] void fail(const std::string& what) const;
    /// Throws InputError "NAME, byte OFFSET: WHAT".
    [[noreturn]] void fail_here(const std::string& what) const;

private:
    bool refill();
    /// Reads up to as many bytes as the buffer has: what zlib unpacks, or what a pipe has. 0 at the end.
    std::size_t load(unsigned char* to);
    std::size_t load_from_file(unsigned char* to);
    std::size_t load_from_pipe(unsigned char* to);

    std::string name_;
    Progress progress_;
    std::uint64_t total_ = 0, before_ = 0;
    gzFile_s* file_ = nullptr;
    int pipe_ = -1;
    std::vector<unsigned char> buffer_;
    std::size_t at_ = 0, filled_ = 0;
    bool ended_ = false;
    std::vector<std::string> warnings_;
    double rounding_ = 0;
};

}  // namespace hedgerow::detail
