/// Times of contenders, measured in turn.
#pragma once

#include <cstdlib>
#include <functional>
#include <vector>

#include "ray_sets.h"

namespace hedgerow::benchmark {

/// Million rays a second of each contender, as medians. A contender traces all rays and returns how many hit.
inline std::vector<double> rates(int repeats, std::size_t rays,
                                 const std::vector<std::function<std::size_t()>>& contenders) {
    std::vector<std::vector<double>> times(contenders.size());
    for (int r = 0; r < repeats; ++r)
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            const double start = seconds();
            const std::size_t found = contenders[c]();
            times[c].push_back(seconds() - start);
            if (found > rays) std::abort();
        }
    std::vector<double> result;
    for (auto& t : times) result.push_back(double(rays) / median(t) * 1e-6);
    return result;
}

template <class F>
double median_seconds(int repeats, F f) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r) {
        const double start = seconds();
        f();
        times.push_back(seconds() - start);
    }
    return median(times);
}

}  // namespace hedgerow::benchmark
