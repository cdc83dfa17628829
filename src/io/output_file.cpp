/// Files that are written under another name and then renamed.
#include "output_file.h"

#include <atomic>
#include <cerrno>
#include <random>
#include <system_error>

#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/writable.h>

#include "text.h"

namespace hedgerow {

namespace {

std::string unique_suffix() {
    static std::atomic<std::uint32_t> calls = 0;
    std::random_device random;
    std::string suffix(1, '.');
    detail::append_number(suffix, random());
    detail::append_number(suffix += '-', calls++);
    return suffix + ".part";
}

/// The file that a link names: that file is replaced, and the link stays.
std::filesystem::path followed(const std::filesystem::path& path) {
    std::error_code failed;
    if (!std::filesystem::is_symlink(path, failed)) return path;
    const auto target = std::filesystem::weakly_canonical(path, failed);
    return failed ? path : target;
}

/// Whether a file is read-only. Renaming would replace a read-only file, since it needs permission only for
/// the folder.
bool read_only(const std::filesystem::path& path, const std::filesystem::file_status& status) {
    using std::filesystem::perms;
    const auto writers = perms::owner_write | perms::group_write | perms::others_write;
    return (status.permissions() & writers) == perms::none || ::access(path.c_str(), W_OK) != 0;
}

[[noreturn]] void cannot_write(const std::filesystem::path& path, const std::string& why) {
    throw OutputError(path.string() + ": cannot be written" + why);
}

/// Throws OutputError as check_writable does, for a path that is not a link.
void check(const std::filesystem::path& path) {
    if (path.empty()) throw OutputError("the output has no name. Name a file");
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status)) cannot_write(path, ", it is a directory. Name a file");
    if (std::filesystem::exists(status)) {
        if (read_only(path, status))
            cannot_write(path, ", it is read-only. Choose another output, or permit writing it");
        if (!std::filesystem::is_regular_file(status)) return;
    }
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (!std::filesystem::is_directory(folder, ignored))
        cannot_write(path, ": there is no folder " + folder.string() + ". Make it first");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        cannot_write(path, ": the folder " + folder.string() + " is read-only. Choose another output");
}

}  // namespace

void check_writable(const std::filesystem::path& path) {
    check(followed(path));
}

namespace detail {

OutputFile::OutputFile(const std::filesystem::path& path, Progress progress)
    : path_(followed(path)), progress_(std::move(progress)) {
    check(path_);
    std::error_code ignored;
    const auto status = std::filesystem::status(path_, ignored);
    // Devices and pipes cannot be replaced by renaming, so they are written directly.
    const bool straight = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    written_ = path_;
    if (!straight) written_ += unique_suffix();
    errno = 0;
    file_ = std::fopen(written_.c_str(), straight ? "wb" : "wbx");
    if (file_ == nullptr) fail(errno);
}

std::unique_ptr<OutputFile> OutputFile::standard_output() {
    std::unique_ptr<OutputFile> output(new OutputFile());
    output->path_ = output->written_ = "the standard output";
    errno = 0;
    output->file_ = ::fdopen(::dup(STDOUT_FILENO), "wb");
    if (output->file_ == nullptr) output->fail(errno);
    return output;
}

OutputFile::~OutputFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::error_code ignored;
    if (written_ != path_) std::filesystem::remove(written_, ignored);
}

void OutputFile::write(std::string_view bytes) {
    errno = 0;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

std::uint64_t OutputFile::tell() const {
    errno = 0;
    const auto place = ::ftello(file_);
    if (place < 0) fail(errno);
    return static_cast<std::uint64_t>(place);
}

void OutputFile::seek(std::uint64_t place) {
    errno = 0;
    if (::fseeko(file_, static_cast<off_t>(place), SEEK_SET) != 0) fail(errno);
}

bool OutputFile::seekable() const {
    struct stat status {};
    return ::fstat(::fileno(file_), &status) == 0 && S_ISREG(status.st_mode);
}

void OutputFile::commit_as(const std::filesystem::path& path) {
    if (written_ != path_) path_ = path;
    progress_ = {};
    commit();
}

void OutputFile::commit() {
    progress_.look();
    errno = 0;
    if (std::fflush(file_) != 0 || std::ferror(file_) != 0) fail(errno);
    const int closed = std::fclose(file_);
    file_ = nullptr;
    std::error_code error, ignored;
    if (closed != 0) error = {errno, std::generic_category()};
    if (!error && written_ != path_) std::filesystem::rename(written_, path_, error);
    if (!error) return;
    if (written_ != path_) std::filesystem::remove(written_, ignored);
    fail(error.value());
}

void OutputFile::fail(int error) const {
    cannot_write(path_, ": " +
                            (error == 0 ? "the disk may be full" : std::generic_category().message(error)) +
                            ". Check the folder, its permissions and the space left");
}

}  // namespace detail
}  // namespace hedgerow
