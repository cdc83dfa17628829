/// Write, then rename.
#include "output_file.h"

#include <atomic>
#include <cerrno>
#include <random>
#include <system_error>

#include <sys/types.h>

#include <hedgerow/error.h>

#include "text.h"

namespace hedgerow::detail {

namespace {
std::string unique_suffix() {
    static std::atomic<std::uint32_t> calls = 0;
    std::random_device random;
    std::string suffix(1, '.');
    append_number(suffix, random());
    append_number(suffix += '-', calls++);
    return suffix + ".part";
}
}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : path_(path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status))
        throw InputError(path.string() + ": cannot be written, it is a directory. Name a file");
    const bool straight = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    if (std::filesystem::is_symlink(path, ignored)) {  // the link stays, what it names is replaced
        const auto target = std::filesystem::weakly_canonical(path, ignored);
        if (!ignored) path_ = target;
    }
    written_ = path_;
    if (!straight) written_ += unique_suffix();
    errno = 0;
    file_ = std::fopen(written_.c_str(), straight ? "wb" : "wbx");
    if (file_ == nullptr) fail(errno);
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

void OutputFile::commit() {
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
    throw InputError(path_.string() + ": cannot be written: " +
                     (error == 0 ? "the disk may be full" : std::generic_category().message(error)) +
                     ". Check the folder, its permissions and the space left");
}

}  // namespace hedgerow::detail
