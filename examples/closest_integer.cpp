// Finds the integer closest to k in three ways: a scan, bisection of the sorted integers, and a kd-tree in
// one dimension. Prints the cost of a single query, and the cost of a query when there are many.
//
//   closest_integer [HOW_MANY]     1,000,000 integers unless said otherwise
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/random.h>

namespace {

using Integers = std::vector<long>;

/// Tests every integer: O(n) a query. Returns the lower of two that are equally close.
long closest_by_scan(const Integers& all, long k) {
    return *std::min_element(all.begin(), all.end(), [k](long a, long b) {
        return std::labs(a - k) != std::labs(b - k) ? std::labs(a - k) < std::labs(b - k) : a < b;
    });
}

/// Bisects sorted integers: O(log n) a query. Returns the lower of two that are equally close.
long closest_by_bisection(const Integers& sorted, long k) {
    const auto above = std::lower_bound(sorted.begin(), sorted.end(), k);
    if (above == sorted.begin()) return *above;
    if (above == sorted.end()) return sorted.back();
    return k - *(above - 1) <= *above - k ? *(above - 1) : *above;
}

/// Prints the comparisons of a bisection for k = 18 among sixteen integers, and the number of distances that
/// a scan takes. Returns whether both find 20.
bool show_sixteen() {
    const Integers all = {10, 123, 2, 100, 6, 25, 64, 11, 200, 30, 950, 111, 20, 8, 1, 80};
    constexpr long k = 18;
    Integers sorted = all;
    std::sort(sorted.begin(), sorted.end());
    std::printf("sorted:");
    for (const long i : sorted) std::printf(" %ld", i);
    std::printf("\nk = %ld: ", k);
    // Bisect for the first integer that is not less than k, and print each comparison.
    std::size_t low = 0, high = sorted.size(), steps = 0;
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        std::printf("%ld%s k, ", sorted[middle], sorted[middle] < k ? " <" : " >=");
        if (sorted[middle] < k)
            low = middle + 1;
        else
            high = middle;
        ++steps;
    }
    // Compare the two integers around k, and check both functions.
    const long closest = closest_by_bisection(sorted, k);
    std::printf("so it lies between %ld and %ld: %ld\n", sorted[low - 1], sorted[low], closest);
    std::printf("%zu steps and 2 distances, instead of %zu distances\n\n", steps, all.size());
    return closest == 20 && closest_by_scan(all, k) == 20;
}

double seconds_of(auto work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Times the queries, prints a line of the table and returns the answers.
Integers report(const char* way, double preparation, const Integers& questions, auto answer) {
    constexpr double many = 1e6;
    Integers answers;
    const double asking = seconds_of([&] {
        for (const long k : questions) answers.push_back(answer(k));
    });
    const double each = asking / static_cast<double>(questions.size());
    std::printf("%-8s %14.6f %14.9f %14.6f %22.9f\n", way, preparation, each, preparation + each,
                preparation / many + each);
    return answers;
}

}  // namespace

int main(int argc, char** argv) {
    const std::size_t n = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000;
    if (n == 0) {
        std::fputs("usage: closest_integer [HOW_MANY, from 1]\n", stderr);
        return 2;
    }
    if (!show_sixteen()) {
        std::fputs("the closest of the sixteen is not 20\n", stderr);
        return 1;
    }
    // Draw random integers and random values of k.
    hedgerow::Random random(1, 1);
    const auto some = [&](std::size_t count) {
        Integers integers(count);
        for (long& i : integers) i = static_cast<long>(random.bits() >> 24);  // 40 bits, exact in a double
        return integers;
    };
    const Integers integers = some(n), questions = some(100);

    // Time the scan, which needs no preparation.
    std::printf("%zu integers, in seconds\n", n);
    std::printf("%-8s %14s %14s %14s %22s\n", "", "preparation", "a question", "the first",
                "one of a million");
    const Integers by_scan =
        report("scan", 0, questions, [&](long k) { return closest_by_scan(integers, k); });

    // Time bisection, prepared by a sort.
    Integers sorted = integers;
    const double sorting = seconds_of([&] { std::sort(sorted.begin(), sorted.end()); });
    const Integers by_bisection =
        report("sort", sorting, questions, [&](long k) { return closest_by_bisection(sorted, k); });

    // Time the kd-tree, prepared by its build, over points in one dimension.
    hedgerow::PointCloud<double, 1> line;
    for (const long i : integers) line.points.emplace_back(static_cast<double>(i));
    auto tree = hedgerow::build<hedgerow::PointKdTree>(line);
    const double building = seconds_of([&] { tree = hedgerow::build<hedgerow::PointKdTree>(line); });
    hedgerow::Visits visits;
    const Integers by_tree = report("kd-tree", building, questions, [&](long k) {
        const hedgerow::Vec<double, 1> at(static_cast<double>(k));
        return static_cast<long>(hedgerow::closest_point(tree, at, {}, hedgerow::KeepAll(), visits).point[0]);
    });
    std::printf("looked at: %zu by scan, %.1f by kd-tree\n", n,
                static_cast<double>(visits.primitives) / static_cast<double>(questions.size()));

    // Check that all three give the same answers.
    if (by_scan != by_bisection || by_scan != by_tree) {
        std::fputs("the answers differ\n", stderr);
        return 1;
    }
    return 0;
}
