/// Texts of which each is told once.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace hedgerow::detail {

/// Collects texts in the order in which each comes first.
class NamedOnce {
public:
    void add(const std::string& text) {
        if (known_.insert(text).second) texts_.push_back(text);
    }
    std::vector<std::string> take() { return std::move(texts_); }

private:
    std::set<std::string> known_;
    std::vector<std::string> texts_;
};

}  // namespace hedgerow::detail
