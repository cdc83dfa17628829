#include <hedgerow/measure/contest.h>

#include <algorithm>

namespace hedgerow::measure {

double median(std::vector<double> all) {
    std::sort(all.begin(), all.end());
    const std::size_t middle = all.size() / 2;
    return all.size() % 2 == 1 ? all[middle] : (all[middle - 1] + all[middle]) / 2;
}

std::vector<std::vector<double>> seconds_in_turn(int rounds, const Contest& contest, Clock clock,
                                                 const std::function<bool(const std::string&)>& go_on) {
    std::vector<std::vector<double>> seconds(contest.contenders.size());
    std::size_t answers = 0;  // used below, so that the compiler keeps the work
    for (int r = 0; r < rounds; ++r)
        for (std::size_t c = 0; c < contest.contenders.size(); ++c) {
            if (!go_on(contest.names[c])) return seconds;
            seconds[c].push_back(seconds_of([&] { answers += contest.contenders[c](); }, clock));
        }
    asm volatile("" : : "r"(answers));
    return seconds;
}

Times times_of(const std::vector<double>& seconds) {
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    const double middle = median(seconds);
    return {middle, middle > 0 ? (*most - *least) / middle : 0};
}

std::vector<Times> measured_in_turn(int rounds, const Contest& contest, Clock clock,
                                    const std::function<bool(const std::string&)>& go_on) {
    std::vector<Times> all;
    for (const auto& seconds : seconds_in_turn(rounds, contest, clock, go_on)) {
        if (seconds.size() < static_cast<std::size_t>(rounds)) return {};
        all.push_back(times_of(seconds));
    }
    return all;
}

std::vector<double> rates(int repeats, std::size_t rays, const std::vector<Contender>& contenders) {
    Contest contest;
    for (const Contender& c : contenders) contest.add("", c);
    std::vector<double> result;
    for (const Times& t :
         measured_in_turn(repeats, contest, Clock::wall, [](const std::string&) { return true; }))
        result.push_back(static_cast<double>(rays) / t.median * 1e-6);
    return result;
}

}  // namespace hedgerow::measure
