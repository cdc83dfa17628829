// Which of these integers is the closest to k? By looking at each, by sorting them first, and by a kd-tree in
// one dimension: what one question costs, and what a question costs when there are many.
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

/// O(n) a question. Of two that are equally close the lower.
long closest_by_scan(const Integers& all, long k) {
    return *std::min_element(all.begin(), all.end(), [k](long a, long b) {
        return std::labs(a - k) != std::labs(b - k) ? std::labs(a - k) < std::labs(b - k) : a < b;
    });
}

/// O(log n) a question, once they are sorted.
long closest_by_bisection(const Integers& sorted, long k) {
    const auto above = std::lower_bound(sorted.begin(), sorted.end(), k);
    if (above == sorted.begin()) return *above;
    if (above == sorted.end()) return sorted.back();
    return k - *(above - 1) <= *above - k ? *(above - 1) : *above;
}

/// Sixteen integers and k = 18: what is compared by scan, and what by bisection once they are sorted. Returns
/// whether both find 20.
bool show_sixteen() {
    const Integers all = {10, 123, 2, 100, 6, 25, 64, 11, 200, 30, 950, 111, 20, 8, 1, 80};
    constexpr long k = 18;
    Integers sorted = all;
    std::sort(sorted.begin(), sorted.end());
    std::printf("sorted:");
    for (const long i : sorted) std::printf(" %ld", i);
    std::printf("\nk = %ld: ", k);
    std::size_t low = 0, high = sorted.size(), steps = 0;  // the first that is not less than k
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        std::printf("%ld%s k, ", sorted[middle], sorted[middle] < k ? " <" : " >=");
        if (sorted[middle] < k)
            low = middle + 1;
        else
            high = middle;
        ++steps;
    }
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

/// Prints a line of the table and returns the answers.
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
    hedgerow::Random random(1, 1);
    const auto some = [&](std::size_t count) {
        Integers integers(count);
        for (long& i : integers) i = static_cast<long>(random.bits() >> 24);  // a double holds it
        return integers;
    };
    const Integers integers = some(n), questions = some(100);

    std::printf("%zu integers, in seconds\n", n);
    std::printf("%-8s %14s %14s %14s %22s\n", "", "preparation", "a question", "the first",
                "one of a million");
    const Integers by_scan =
        report("scan", 0, questions, [&](long k) { return closest_by_scan(integers, k); });

    Integers sorted = integers;
    const double sorting = seconds_of([&] { std::sort(sorted.begin(), sorted.end()); });
    const Integers by_bisection =
        report("sort", sorting, questions, [&](long k) { return closest_by_bisection(sorted, k); });

    hedgerow::PointCloud<double, 1> line;
    for (const long i : integers) line.points.emplace_back(static_cast<double>(i));
    auto tree = hedgerow::build<hedgerow::PointKdTree>(line);
    const double building = seconds_of([&] { tree = hedgerow::build<hedgerow::PointKdTree>(line); });
    hedgerow::Visits visits;
    const Integers by_tree = report("kd-tree", building, questions, [&](long k) {
        const hedgerow::Vec<double, 1> at(static_cast<double>(k));
        constexpr double anywhere = std::numeric_limits<double>::max();
        return static_cast<long>(hedgerow::closest_point(tree, at, anywhere, visits)->point[0]);
    });
    std::printf("looked at: %zu by scan, %.1f by kd-tree\n", n,
                static_cast<double>(visits.primitives) / static_cast<double>(questions.size()));

    if (by_scan != by_bisection || by_scan != by_tree) {
        std::fputs("the answers differ\n", stderr);
        return 1;
    }
    return 0;
}
