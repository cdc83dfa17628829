#include "common.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/index_file.h>

#include "memory.h"

namespace hedgerow::cli {

std::string generated_name(const Common& c) {
    return c.scene.starts_with("gen:") ? parse_scene_spec(c.scene).name : std::string();
}

std::optional<SceneSize> known_size(const Common& c) {
    if (c.scene.starts_with("gen:")) return size_of(parse_scene_spec(c.scene));
    return size_in_header(c.scene);
}

void check_memory(const SceneSpec& spec) {
    for (const SceneInfo& info : scene_list()) {
        if (info.name != spec.name) continue;
        const std::uint64_t size = spec.size.value_or(info.default_size);
        expect_memory(fmt::format("gen:{}:{}", info.name, size), info.bytes * static_cast<double>(size),
                      "ask for a smaller scene");
    }
}

Executor& interruptible_executor() {
    static WatchedExecutor watched(default_executor(), {{}, &interrupted});
    return watched;
}

std::string precision_of(const Common& c) {
    if (names_index_file(c.scene)) return std::string(index_file_info(c.scene).scalar);
    return c.precision == "double" ? "double" : "float";
}

std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

double shortest(float number) {
    return std::stod(fmt::format("{}", number));
}

namespace {
std::uint64_t all_dropped = 0;
}  // namespace

void tell(const Common& c, const LoadReport& report) {
    if (report.loses_detail && c.precision == "auto") {
        if (!c.quiet)
            fmt::print(
                stderr,
                "hedgerow: {}: is read in double, since floats would move its coordinates by up to {:.2g}. "
                "--precision float reads it in float all the same\n",
                c.scene, report.rounding);
        throw DoublesNeeded();
    }
    for (const std::string& warning : report.warnings) fmt::print(stderr, "hedgerow: {}\n", warning);
    if (report.loses_detail)
        fmt::print(stderr, "hedgerow: {}: floats move its coordinates by up to {:.2g}, which matters\n",
                   c.scene, report.rounding);
    if (report.dropped_faces > 0)
        fmt::print(stderr, "hedgerow: {}: {} faces were left out, with {} vertices\n", c.scene,
                   report.dropped_faces, report.dropped_points);
    else if (report.dropped_points > 0)
        fmt::print(stderr, "hedgerow: {}: {} points were left out\n", c.scene, report.dropped_points);
    all_dropped += report.dropped_faces > 0 ? report.dropped_faces : report.dropped_points;
}

void print_json(const nlohmann::ordered_json& results) {
    using nlohmann::ordered_json;
    ordered_json all = results;
    if (all_dropped > 0 && all.is_object()) all["dropped"] = all_dropped;
    fmt::print("{}\n", all.dump(2, ' ', false, ordered_json::error_handler_t::replace));
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

std::string unfinished_name(const std::string& path) {
    const std::filesystem::path whole(path);
    return (whole.parent_path() / (whole.stem().string() + ".unfinished" + whole.extension().string()))
        .string();
}

}  // namespace hedgerow::cli
