/// A file that appears whole or not at all.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/parallel/progress.h>

#include "little.h"

namespace hedgerow::detail {

/// Writes a file beside `path`, with a name that no other writer has, and renames it in `commit`. A file that
/// is not committed is removed. A device or pipe is written directly, and so is the standard output. Throws
/// OutputError, and Cancelled once the progress is cancelled.
class OutputFile {
public:
    explicit OutputFile(const std::filesystem::path& path, Progress progress = {});
    static std::unique_ptr<OutputFile> standard_output();
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view bytes);
    /// Writes the bytes of a number in little-endian order.
    template <class U>
    void little(U v) {
        const auto bytes = little_bytes(v);
        write({bytes.data(), bytes.size()});
    }
    /// `expect` announces how much there is to write, in the writer's unit, and `advance` adds what has been
    /// written. The progress is reported and checked for cancellation about once in 4096 units.
    void expect(std::uint64_t total) { total_ = total; }
    void advance(std::uint64_t more = 1) {
        done_ += more;
        if (done_ - reported_ < 4096) return;
        reported_ = done_;
        progress_.look();
        progress_(done_, total_);
    }
    /// How far coordinates were moved when they were rounded to what the format has, at most: whoever rounds
    /// one writes it.
    double& rounding() { return rounding_; }
    std::FILE* stream() const { return file_; }
    /// The place of the next byte, for formats that go back to fill in values. Throws OutputError for a pipe,
    /// which has no places.
    std::uint64_t tell() const;
    void seek(std::uint64_t place);
    /// Whether places can be gone back to, as in all but pipes and devices.
    bool seekable() const;
    void commit();
    /// Commits the file under another name. What was written directly stays where it is.
    void commit_as(const std::filesystem::path& path);

private:
    OutputFile() = default;
    [[noreturn]] void fail(int error) const;

    std::filesystem::path path_, written_;
    Progress progress_;
    std::uint64_t done_ = 0, reported_ = 0, total_ = 0;
    double rounding_ = 0;
    std::FILE* file_ = nullptr;
};

}  // namespace hedgerow::detail
