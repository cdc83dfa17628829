/// Times of contenders, measured in turn.
#pragma once

#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/measure/clock.h>

namespace hedgerow::measure {

/// The median; of an even number of values, the mean of the middle two. There must be at least one value.
double median(std::vector<double> all);

/// Does its work once. Returns the number of rays that hit, or any other number.
using Contender = std::function<std::size_t()>;

struct Contest {
    std::vector<Contender> contenders;
    std::vector<std::string> names;  // by contender

    void add(std::string name, Contender contender) {
        names.push_back(std::move(name));
        contenders.push_back(std::move(contender));
    }
};

/// Seconds of each contender in each round. Each round runs all contenders in turn, so that other load on the
/// machine affects them alike. Calls `go_on(name)` before each run; once that is false, returns what was
/// timed before, so the last round may lack some contenders.
std::vector<std::vector<double>> seconds_in_turn(int rounds, const Contest& contest, Clock clock,
                                                 const std::function<bool(const std::string&)>& go_on);

/// The times of several rounds.
struct Times {
    double median = 0;
    double spread = 0;  ///< slowest minus fastest round, as a share of the median
};
Times times_of(const std::vector<double>& seconds);

/// The times of all rounds, or nothing if `go_on` was false once.
std::vector<Times> measured_in_turn(int rounds, const Contest& contest, Clock clock,
                                    const std::function<bool(const std::string&)>& go_on);

/// Million rays a second of each contender, as medians. A contender traces all rays and returns how many hit.
std::vector<double> rates(int repeats, std::size_t rays, const std::vector<Contender>& contenders);

template <class F>
double median_seconds(int repeats, F f, Clock clock = Clock::wall) {
    std::vector<double> times;
    for (int r = 0; r < repeats; ++r) times.push_back(seconds_of(f, clock));
    return median(times);
}

}  // namespace hedgerow::measure
