/// The folder of a run: what verbs that move particles leave behind, and go on from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace hedgerow::cli {

/// The --size of a run without pictures.
inline constexpr std::string_view no_pictures = "0x0";

/// Throws UsageError for options that run.json has of a run that goes on, and that would be ignored.
void expect_no_options_of_a_run(const CLI::App& verb);

/// The files of a run: its options, its log, and snapshots and pictures by the number of their step.
class RunFolder {
public:
    explicit RunFolder(const std::string& path) : path_(path) {}
    /// Sets the format of snapshots, "npy" or "hdf5". They are .npy files unless told otherwise.
    void hold(const std::string& snapshots) { ending_ = "." + snapshots; }

    std::filesystem::path options() const { return path_ / "run.json"; }
    std::filesystem::path log() const { return path_ / "log.csv"; }
    std::filesystem::path snapshot(std::uint64_t step) const;
    std::filesystem::path picture(std::uint64_t step) const;

    /// Throws UsageError if a run is in the folder already.
    void expect_none() const;
    /// Makes the folder. Throws OutputError if that fails.
    void make() const;
    std::filesystem::path file(std::string_view name) const { return path_ / name; }

    /// The steps of all snapshots, ascending.
    std::vector<std::uint64_t> steps() const;
    /// The step of the last snapshot. Throws InputError if there is none.
    std::uint64_t last_step() const;

    /// Writes run.json. It comes after the first snapshot, so that a folder with options has a snapshot to go
    /// on from. Throws OutputError.
    void save_options(const nlohmann::ordered_json& options) const;
    /// Calls `read` with the options of run.json. Throws InputError if there are none, and with the file's
    /// name for what `read` does not find in them.
    void read_options(const std::function<void(const nlohmann::ordered_json&)>& read) const;
    /// Throws InputError for lengths of time in run.json that no run goes on with: each is above 0.
    void expect_lengths(std::initializer_list<double> lengths) const;

private:
    std::filesystem::path path_;
    std::string ending_ = ".npy";
};

/// The log of a run: a line with the names of columns, then a line for each step, which begins with the
/// step's number.
class RunLog {
public:
    /// Goes on after the line of a step, and removes later lines. Without a step it makes the folder, and
    /// begins anew. Throws OutputError.
    RunLog(const RunFolder& folder, std::string_view names, std::optional<std::uint64_t> after);
    /// Appends a line of a step. Throws OutputError.
    void line(std::string_view text);

private:
    std::filesystem::path path_;
    std::ofstream file_;
};

/// How a run steps.
struct RunSteps {
    const char* doing;  ///< in words, for the line of progress
    std::function<bool()> finished;
    /// Makes the step of a number, with its line of the log. Returns whether a snapshot is due.
    std::function<bool(std::uint64_t)> step;
    std::function<void(std::uint64_t)> snapshot;
    std::function<double()> share;  ///< of the way from where it began to its end, 0 to 1
};
/// Goes on from a step until the run is finished or interrupted. The last step has a snapshot. Returns its
/// number.
std::uint64_t go_on(const RunSteps& run, std::uint64_t step, bool quiet);

}  // namespace hedgerow::cli
