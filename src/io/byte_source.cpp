/// Reads files through zlib, which reads plain files too, and pipes directly.
#include "byte_source.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include <hedgerow/base/error.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow::detail {

namespace {
constexpr std::size_t buffer_size = std::size_t(1) << 18;
/// A file that unpacks to more than this, at more than this ratio, repeats itself without an end. Scenes
/// reach about 50 to 1.
constexpr std::uint64_t bomb_size = std::uint64_t(1) << 28, bomb_ratio = 500;

/// Git LFS leaves a text of about 130 bytes where a file was not fetched.
bool is_lfs_pointer(const std::filesystem::path& path) {
    constexpr std::string_view beginning = "version https://git-lfs.github.com/spec/";
    char start[beginning.size()];
    std::ifstream file(path, std::ios::binary);
    return file.read(start, sizeof start) && std::string_view(start, sizeof start) == beginning;
}
}  // namespace

void check_readable(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        const bool missing = status.type() == std::filesystem::file_type::not_found;
        throw InputError(name + ": " + (missing ? "there is no such file. Check the path" : error.message()));
    }
    if (std::filesystem::is_directory(status)) throw InputError(name + ": is a directory. Name a file in it");
    if (!std::filesystem::is_regular_file(status))
        throw InputError(name + ": is not a regular file. Copy what it yields to a file first");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (size == 0 && !error) throw InputError(name + ": the file is empty. Write it again");
    if (size < 1024 && is_lfs_pointer(path))
        throw InputError(name + ": is a pointer of Git LFS, and not the file itself. Fetch it: git lfs pull");
}

namespace {
/// A descriptor to read a pipe by: of the standard input, a named pipe or a device. −1 for other paths.
int opened_pipe(const std::filesystem::path& path) {
    if (path == "-") return ::dup(STDIN_FILENO);
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    const bool is_pipe = std::filesystem::is_fifo(status) || std::filesystem::is_character_file(status);
    // Opening must not wait for a writer, since nothing could cancel that. Reading waits for data by poll.
    return is_pipe ? ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK) : -1;
}
}  // namespace

ByteSource::ByteSource(const std::filesystem::path& path, const Progress& progress, Pipes pipes)
    : name_(path.string()), progress_(progress) {
    buffer_.resize(buffer_size);
    if (pipes == Pipes::yes) {
        pipe_ = opened_pipe(path);
        if (path == "-") name_ = "the standard input";
        if (pipe_ >= 0) return;
        if (path == "-") fail("is closed. Pipe rows to it, or name a file");
    }
    check_readable(path);
    std::error_code error;
    total_ = std::filesystem::file_size(path, error);
    if (error) total_ = 0;
    errno = 0;
    file_ = gzopen(path.c_str(), "rb");
    if (file_ == nullptr) fail("cannot be opened: " + std::generic_category().message(errno));
    gzbuffer(file_, 1u << 17);
}

ByteSource::~ByteSource() {
    if (file_ != nullptr) gzclose(file_);
    if (pipe_ >= 0) ::close(pipe_);
}

std::uint64_t ByteSource::most_left() const {
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max(), ratio = 1032;
    if (pipe_ >= 0) return most;
    if (gzdirect(file_) != 0) return total_ - std::min(total_, offset());
    return total_ > most / ratio ? most : total_ * ratio - std::min(total_ * ratio, offset());
}

void ByteSource::expect_not_cancelled() const {
    if (progress_.cancelled()) throw Cancelled(name_ + ": reading was cancelled");
}

bool ByteSource::refill() {
    if (ended_) return false;
    before_ += filled_;
    at_ = filled_ = 0;
    filled_ = load(buffer_.data());
    return !ended_;
}

std::size_t ByteSource::load(unsigned char* to) {
    expect_not_cancelled();
    const std::size_t got = pipe_ >= 0 ? load_from_pipe(to) : load_from_file(to);
    ended_ = got == 0;
    return got;
}

std::size_t ByteSource::load_from_file(unsigned char* to) {
    // Report damaged data.
    const int got = gzread(file_, to, static_cast<unsigned>(buffer_.size()));
    int code = Z_OK;
    const std::string message = gzerror(file_, &code);
    if (code == Z_ERRNO) fail_here("cannot be read: " + std::generic_category().message(errno));
    if (code == Z_BUF_ERROR) fail_here("the compressed data end early. The file was cut off: fetch it again");
    if (got < 0 || code < 0)
        fail_here("the compressed data are damaged (" + message + "). Fetch the file again");
    // Refuse a file that unpacks to far more than a scene does.
    const auto done = gzoffset(file_);
    if (gzdirect(file_) == 0 && before_ > bomb_size &&
        before_ / bomb_ratio > static_cast<std::uint64_t>(done))
        fail_here("unpacks to more than " + std::to_string(bomb_ratio) +
                  " times its size, as no scene does. If it is one, unpack it first and read that");
    // Report the progress in bytes of the file, compressed or not.
    if (got == 0)
        progress_(total_, total_);
    else
        progress_(std::min(static_cast<std::uint64_t>(done < 0 ? 0 : done), total_), total_);
    return static_cast<std::size_t>(got);
}

std::size_t ByteSource::load_from_pipe(unsigned char* to) {
    ssize_t got = 0;
    do {
        // Wait for data, and look at times and after each signal whether reading was cancelled meanwhile.
        pollfd waiting{pipe_, POLLIN, 0};
        while (::poll(&waiting, 1, 100) <= 0) expect_not_cancelled();
        got = ::read(pipe_, to, buffer_.size());
    } while (got < 0 && (errno == EINTR || errno == EAGAIN));
    if (got < 0) fail_here("cannot be read: " + std::generic_category().message(errno));
    return static_cast<std::size_t>(got);
}

std::size_t ByteSource::read(void* to, std::size_t size) {
    auto* const bytes = static_cast<unsigned char*>(to);
    std::size_t done = 0;
    while (done < size) {
        if (at_ == filled_ && !ended_ && size - done >= buffer_.size()) {
            // Past the buffer, without a copy.
            before_ += filled_;
            at_ = filled_ = 0;
            const std::size_t got = load(bytes + done);
            before_ += got, done += got;
        } else {
            if (at_end()) break;
            const std::size_t n = std::min(size - done, filled_ - at_);
            std::memcpy(bytes + done, buffer_.data() + at_, n);
            at_ += n, done += n;
        }
    }
    return done;
}

bool ByteSource::skip(std::uint64_t size) {
    while (size > 0 && !at_end()) {
        const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(size, filled_ - at_));
        at_ += n, size -= n;
    }
    return size == 0;
}

std::string_view ByteSource::ahead() {
    if (at_end()) return {};
    return {reinterpret_cast<const char*>(buffer_.data()) + at_, filled_ - at_};
}

void ByteSource::rewind() {
    errno = 0;
    if (gzrewind(file_) != 0) fail("cannot be read again: " + std::generic_category().message(errno));
    before_ = 0, at_ = filled_ = 0;
    ended_ = false;
}

void ByteSource::fail(const std::string& what) const {
    throw InputError(name_ + ": " + what);
}

void ByteSource::fail_here(const std::string& what) const {
    throw InputError(name_ + ", byte " + std::to_string(offset()) + ": " + what);
}

}  // namespace hedgerow::detail
