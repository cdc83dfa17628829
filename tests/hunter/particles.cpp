/// Forces of arrangements that are drawn at random, at charges and at targets beside them, against sums in
/// long double and after Ewald.
#include <cmath>
#include <sstream>

#include <hedgerow/base/instruction_set.h>

#include "../force_questions.h"
#include "report.h"

namespace hedgerow::hunter {
namespace {

ForceQuestion drawn(std::uint64_t seed, std::uint64_t round) {
    Random random(seed, round);
    ForceQuestion q{random.bits() % kinds_of_arrangements().size(), 0, random.bits() % 1000000,
                    arranging::log_uniform(random, 1e-9, 0.1)};
    static const std::size_t open = open_arrangements().size();  // those behind them are periodic
    const bool periodic = q.kind >= open;
    q.count = static_cast<std::size_t>(arranging::log_uniform(random, 2, periodic ? 1500 : 15000));
    if (random.uniform() < 0.3) q.scale = std::exp2(std::floor(random.uniform(-40, 40)));
    if (random.uniform() < 0.2) q.offset = random.uniform(-1e3, 1e3);
    if (random.uniform() < 0.2) q.softening = arranging::log_uniform(random, 1e-9, 0.1);
    q.at_targets = random.uniform() < 0.25;
    return q;
}

}  // namespace

Report hunt_particles(std::uint64_t seed, std::uint64_t round) {
    const auto sets = instruction_sets();
    use_instruction_set(sets[round / 4 % sets.size()]);
    Report report;
    ForceQuestion q = drawn(seed, round);
    double worst = excess(q, report.questions);
    report.checked_exactly = report.questions;
    if (!(worst > 1)) return report;
    // Look for fewer charges that show it.
    for (std::size_t fewer = q.count / 2; fewer >= 2; fewer /= 2) {
        ForceQuestion smaller = q;
        smaller.count = fewer;
        if (const double share = excess(smaller, report.questions); share > 1) q = smaller, worst = share;
    }
    std::ostringstream test;
    test.precision(17);
    test << "// --particles --seed " << seed << " --round " << round << ": " << worst
         << " times the accuracy, by " << name_of(instruction_set()) << "; for force_arrangements_test:\n{"
         << q.kind << ", " << q.count << ", " << q.seed << ", " << q.accuracy << ", " << q.scale << ", "
         << q.offset << ", " << q.softening << ", " << std::boolalpha << q.at_targets << "},  // "
         << kinds_of_arrangements()[q.kind].name;
    report.found.push_back(test.str());
    return report;
}

}  // namespace hedgerow::hunter
