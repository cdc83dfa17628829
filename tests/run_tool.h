/// Tests of verbs that leave a folder of a run behind.
#pragma once

#include <algorithm>

#include "tool.h"

namespace hedgerow {

/// A test of runs in its folder.
class RunTest : public ToolTest {
protected:
    /// The names in the folder of a run that begin so, sorted.
    std::vector<std::string> named(const std::string& run, const std::string& first) const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder / run))
            if (entry.path().filename().string().starts_with(first))
                names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    /// The log without the times that steps took.
    std::string log_of(const std::string& run) const {
        std::ifstream log(folder / run / "log.csv");
        std::string all, line;
        while (std::getline(log, line)) all += line.substr(0, line.rfind(',')) + "\n";
        return all;
    }
};

}  // namespace hedgerow
