#include "run_folder.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <hedgerow/base/error.h>
#include <hedgerow/io/text_file.h>

#include "common.h"

namespace hedgerow::cli {

namespace fs = std::filesystem;

void expect_no_options_of_a_run(const CLI::App& verb) {
    constexpr std::string_view others[] = {"--resume",  "--output", "--until", "--check",
                                           "--threads", "--json",   "--quiet", "--help"};
    for (const CLI::Option* option : verb.get_options())
        if (option->count() > 0 && std::ranges::find(others, option->get_name()) == std::end(others))
            throw UsageError(fmt::format("{} is that of the run, which --resume goes on with: leave it out",
                                         option->get_name()));
}

fs::path RunFolder::snapshot(std::uint64_t step) const {
    return path_ / fmt::format("snapshot-{:07}{}", step, ending_);
}
fs::path RunFolder::picture(std::uint64_t step) const {
    return path_ / fmt::format("picture-{:07}.png", step);
}

void RunFolder::expect_lengths(std::initializer_list<double> lengths) const {
    for (const double length : lengths)
        if (!(length > 0 && length < 1e300))
            throw InputError(fmt::format("{}: a step or the time between snapshots is {} long: it is above 0",
                                         options().string(), length));
}
void RunFolder::expect_none() const {
    if (fs::exists(options()))
        throw UsageError(path_.string() + " holds a run; go on with it by --resume, or name another folder");
}
void RunFolder::make() const {
    std::error_code failed;
    fs::create_directories(path_, failed);
    if (failed) throw OutputError(path_.string() + ": this folder cannot be made: " + failed.message());
}
std::vector<std::uint64_t> RunFolder::steps() const {
    std::vector<std::uint64_t> all;
    std::error_code failed;
    for (const auto& file : fs::directory_iterator(path_, failed)) {
        const std::string name = file.path().filename().string();
        unsigned long long step = 0;
        int length = 0;
        if (std::sscanf(name.c_str(), "snapshot-%llu%n", &step, &length) == 1 &&
            name.substr(static_cast<std::size_t>(length)) == ending_)
            all.push_back(step);
    }
    std::sort(all.begin(), all.end());
    return all;
}
std::uint64_t RunFolder::last_step() const {
    const auto all = steps();
    if (all.empty()) throw InputError(path_.string() + ": there is no snapshot to go on from");
    return all.back();
}

void RunFolder::save_options(const nlohmann::ordered_json& all) const {
    save_text(options(), all.dump(2) + "\n");
}
void RunFolder::read_options(const std::function<void(const nlohmann::ordered_json&)>& read) const {
    std::ifstream file(options());
    if (!file) throw InputError(options().string() + ": there is no run to go on with");
    try {
        read(nlohmann::ordered_json::parse(file));
    } catch (const nlohmann::json::exception& fault) {
        throw InputError(options().string() + ": " + fault.what());
    }
}

RunLog::RunLog(const RunFolder& folder, std::string_view names, std::optional<std::uint64_t> after)
    : path_(folder.log()) {
    std::string kept, line;
    if (!after) {
        folder.make();
    } else {
        std::ifstream old(path_);
        while (std::getline(old, line)) {
            const bool head = line == names;
            // A last line without its end was cut off when the run was killed.
            if (head || (!old.eof() && std::strtoull(line.c_str(), nullptr, 10) <= *after))
                kept += line + "\n";
        }
    }
    save_text(path_, kept.empty() ? std::string(names) + "\n" : kept);
    file_.open(path_, std::ios::app);
}
void RunLog::line(std::string_view text) {
    file_ << text << '\n';
    file_.flush();
    if (!file_) throw OutputError(path_.string() + " cannot be written");
}

std::uint64_t go_on(const RunSteps& run, std::uint64_t step, bool quiet) {
    ProgressLine line(run.doing, quiet);
    const Progress progress = line.progress();
    bool saved = true;
    while (!run.finished() && !interrupted) {
        saved = run.step(++step);
        if (saved) run.snapshot(step);
        constexpr std::uint64_t whole = 1000000;
        progress(static_cast<std::uint64_t>(run.share() * whole), whole);
    }
    if (!saved) run.snapshot(step);
    return step;
}

}  // namespace hedgerow::cli
