/// Helpers that run the tool as its user does.
#pragma once

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <hedgerow/io/image.h>

namespace hedgerow {

struct ToolResult {
    int code;
    std::string output;
};

/// Runs a shell command. Returns its exit code and what it prints to stdout.
inline ToolResult run_shell(const std::string& command) {
    FILE* pipe = popen(command.c_str(), "r");
    ToolResult result{-1, {}};
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) result.output.append(buffer, n);
    result.code = WEXITSTATUS(pclose(pipe));
    return result;
}
/// Runs the tool. Returns its exit code and what it prints to both streams.
inline ToolResult run(const std::string& arguments) {
    return run_shell(HEDGEROW_TOOL_PATH " " + arguments + " 2>&1");
}

/// Runs the tool and sends it a signal after so many milliseconds. Returns the exit code as a shell reports
/// it: 130 also if SIGINT killed the process before it handled signals.
inline int run_interrupted(std::vector<std::string> arguments, int milliseconds = 1500, int signal = SIGINT) {
    const pid_t child = fork();
    if (child == 0) {
        for (const int each : {SIGINT, SIGTERM, SIGUSR1}) std::signal(each, SIG_DFL);
        std::vector<char*> all = {const_cast<char*>(HEDGEROW_TOOL_PATH)};
        for (auto& a : arguments) all.push_back(a.data());
        all.push_back(nullptr);
        execv(HEDGEROW_TOOL_PATH, all.data());
        _exit(127);
    }
    if (child < 0) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Runs the tool, whose exit code must be 0. Returns the most memory that it took, in KiB.
inline long peak_memory(const std::string& arguments) {
    const pid_t child = fork();
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", ("exec " HEDGEROW_TOOL_PATH " " + arguments).c_str(), nullptr);
        _exit(127);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << arguments;
    return usage.ru_maxrss;
}

/// Renders a picture of 1600 x 1200 and interrupts it once some of its rows are done. Returns the exit code.
inline int run_interrupted_render(const std::string& output) {
    std::filesystem::path unfinished = output;
    unfinished.replace_extension(".unfinished" + unfinished.extension().string());
    // Wait longer and longer until the tool leaves an unfinished picture.
    for (int milliseconds = 1500;; milliseconds *= 4) {
        const int code = run_interrupted({"render", "gen:teapot:6000", "--structure", "brute-force", "--size",
                                          "1600x1200", "--quiet", "-o", output},
                                         milliseconds);
        if (std::filesystem::exists(unfinished) || code != 130 || milliseconds > 30000) return code;
    }
}

inline std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream all;
    all << std::ifstream(path, std::ios::binary).rdbuf();
    return all.str();
}

/// The size and the pixels of a PNG, whose other bytes say how it was made.
inline std::string pixels_of(const std::filesystem::path& path) {
    const hedgerow::Image image = hedgerow::load_png(path);
    std::string all = std::to_string(image.width) + "x" + std::to_string(image.height) + ":";
    for (const auto& pixel : image.pixels) all.append(pixel.begin(), pixel.end());
    return all;
}

/// A test with a folder of its own.
class ToolTest : public testing::Test {
protected:
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hedgerow-cli-" + std::to_string(getpid()));
    void SetUp() override { std::filesystem::create_directories(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::string file(const std::string& name) const { return (folder / name).string(); }
    /// Expects that the tool exits with `code` and that its output contains `said`.
    static void expect_failure(int code, const std::string& arguments, const std::string& said) {
        const auto r = run(arguments);
        EXPECT_EQ(r.code, code) << arguments << "\n" << r.output;
        EXPECT_NE(r.output.find(said), std::string::npos) << arguments << "\n" << r.output;
    }
    static void expect_usage(const std::string& arguments, const std::string& said) {
        expect_failure(2, arguments, said);
    }
    static void expect_bad(const std::string& arguments, const std::string& said) {
        expect_failure(3, arguments, said);
    }
};

}  // namespace hedgerow
