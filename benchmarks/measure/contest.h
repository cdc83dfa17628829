/// Times of contenders, measured in turn.
#pragma once

#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/compare/clock.h>
#include <hedgerow/compare/measure.h>

namespace hedgerow::benchmark {

using compare::Clock;
using compare::median;

/// Seconds on the wall clock.
inline double seconds() {
    return compare::now(Clock::wall);
}

/// Does its work once. Returns the number of rays that hit, or any other number.
using Contender = std::function<std::size_t()>;

/// The times of several rounds.
struct Times {
    double median = 0;
    double spread = 0;  ///< slowest minus fastest round, as a share of the median
};
Times times_of(const std::vector<double>& seconds);

struct Contest {
    std::vector<Contender> contenders;
    std::vector<std::string> names;  // by contender

    void add(std::string name, Contender contender) {
        names.push_back(std::move(name));
        contenders.push_back(std::move(contender));
    }
};

/// Each round runs all contenders in turn, so that other load on the machine affects them alike. Calls
/// `go_on(name)` before each run; returns nothing once that is false.
std::vector<Times> measured_in_turn(int rounds, const Contest& contest, Clock clock,
                                    const std::function<bool(const std::string&)>& go_on);

/// Million rays a second of each contender, as medians. A contender traces all rays and returns how many hit.
std::vector<double> rates(int repeats, std::size_t rays, const std::vector<Contender>& contenders);

template <class F>
double median_seconds(int repeats, F f, Clock clock = Clock::wall) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r) times.push_back(compare::seconds_of(f, clock));
    return median(times);
}

}  // namespace hedgerow::benchmark
