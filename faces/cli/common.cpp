#include "common.h"

#include <chrono>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <fmt/format.h>

#include <hedgerow/error.h>
#include <hedgerow/io/index_file.h>

namespace hedgerow::cli {

std::atomic<bool> interrupted{false};

double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

ProgressLine::ProgressLine(std::string what, bool quiet)
    : what_(std::move(what)), shown_(!quiet && isatty(2)), start_(now()) {}
ProgressLine::~ProgressLine() {
    if (shown_) fmt::print(stderr, "\r\033[K");
}
Progress ProgressLine::progress() {
    return {[this](std::uint64_t done, std::uint64_t total) { show(done, total); }, &interrupted};
}
void ProgressLine::show(std::uint64_t done, std::uint64_t total) {
    const std::lock_guard lock(mutex_);
    if (!shown_ || now() - last_ < 0.1) return;
    last_ = now();
    const double rate = double(done) / (last_ - start_ + 1e-9);
    if (total > 0)
        fmt::print(stderr, "\r\033[K{} {:3.0f}%  {:.3g}/s  {:.0f} s left", what_,
                   100.0 * double(done) / double(total), rate, double(total - done) / (rate + 1e-9));
    else
        fmt::print(stderr, "\r\033[K{} {}  {:.3g}/s", what_, done, rate);
}

void ProgressLine::say(const std::string& doing) {
    const std::lock_guard lock(mutex_);
    if (shown_) fmt::print(stderr, "\r\033[K{} {}", what_, doing);
}

std::string generated_name(const Common& c) {
    return c.scene.starts_with("gen:") ? parse_scene_spec(c.scene).name : std::string();
}

std::string precision_of(const Common& c) {
    return names_index_file(c.scene) ? std::string(index_file_info(c.scene).scalar) : c.precision;
}

void check_writable(const std::string& path) {
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (!std::filesystem::is_directory(folder))
        throw InputError(fmt::format("{}: there is no folder {}; make it first", path, folder.string()));
    if (std::filesystem::is_directory(path) || access(folder.c_str(), W_OK) != 0)
        throw InputError(path + ": cannot be written; choose another output");
}

void save_text(const std::string& path, const std::string& text) {
    const std::string beside = path + ".part";
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.close();
    std::error_code failed;
    if (out) std::filesystem::rename(beside, path, failed);
    if (!out || failed) throw InputError(path + ": cannot be written; choose another output");
}

std::vector<std::string> wrapped(std::string_view text, std::size_t letters) {
    std::vector<std::string> lines;
    while (text.size() > letters) {
        auto blank = text.rfind(' ', letters);
        if (blank == text.npos) blank = text.find(' ');
        if (blank == text.npos) break;
        lines.emplace_back(text.substr(0, blank));
        text.remove_prefix(blank + 1);
    }
    lines.emplace_back(text);
    return lines;
}

}  // namespace hedgerow::cli
