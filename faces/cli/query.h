/// What the files of `hedgerow query` share.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hedgerow/columns.h>
#include <hedgerow/io/rows.h>

#include "common.h"

namespace hedgerow::cli {

/// The numbers that the points of a scene have in its file, where --drop-bad left some out. Else numbers are
/// what they are.
class FileNumbers {
public:
    FileNumbers() = default;
    explicit FileNumbers(std::vector<std::uint32_t> of_points) : of_points_(std::move(of_points)) {}

    std::span<const std::uint32_t> all() const { return of_points_; }
    std::uint32_t operator()(std::uint32_t number) const {
        return number < of_points_.size() ? of_points_[number] : number;
    }

private:
    std::vector<std::uint32_t> of_points_;
};
struct QueryArguments : Common {
    std::string kind, from, with, format, output_format, structure = "wide", by;
    std::uint64_t count = 0;
    double radius = -1, factor = 1, error = 1e-3, tolerance = 1e-3;
    std::vector<double> periods;
    bool feature = false;
    unsigned threads = 0;
    FileNumbers numbers, numbers_with;  // of the scene, and of the one of --with
};

/// What a query is done with.
struct QueryReport {
    std::string output;  // the file that was written; empty for none
    std::size_t primitives = 0;
    bool loaded = false;  // the index was loaded, not built
    double build_seconds = 0, seconds = 0;
    std::uint64_t asked = 0;                         // rows that were read; 0 for pairs
    std::uint64_t answered = 0;                      // rows that were written
    std::uint64_t unusable = 0, first_unusable = 0;  // rows read that can have no answer
    bool finished = true;
};
/// Prints the report, and returns the exit code.
int print_report(const QueryArguments& a, const QueryReport& report);

/// The kinds of queries between two scenes, or a scene and itself, and what each answers.
struct PairKind {
    std::string_view name, meaning;
    enum class Scenes : unsigned char { one, two, either } scenes;
    bool takes_radius = false;
};
std::span<const PairKind> pair_kinds();
/// Runs a query of pairs. Returns the exit code.
int query_pairs(const QueryArguments& a);

}  // namespace hedgerow::cli
