/// Forces of arrangements that are drawn at random, at charges and at targets beside them, against sums in
/// long double and after Ewald.
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/nbody/forces.h>

#include "../arrangements.h"
#include "../force_oracle.h"
#include "report.h"

namespace hedgerow::hunter {
namespace {

/// What a round asks: which arrangement, how many charges, of which size and place, how precisely.
struct Question {
    std::size_t kind, count;
    std::uint64_t seed;
    double accuracy, scale = 1, offset = 0, softening = 0;
    bool at_targets = false;  ///< at other places than those of the charges, most of them close to one
};

const std::vector<NamedArrangement>& kinds() {
    static const std::vector<NamedArrangement> all = [] {
        std::vector<NamedArrangement> both = open_arrangements();
        for (auto& one : periodic_arrangements()) both.push_back(one);
        return both;
    }();
    return all;
}
Question drawn(std::uint64_t seed, std::uint64_t round) {
    Random random(seed, round);
    Question q{random.bits() % kinds().size(), 0, random.bits() % 1000000,
               arranging::log_uniform(random, 1e-9, 0.1)};
    const bool periodic = kinds()[q.kind].name.find("peri") != std::string::npos ||
                          kinds()[q.kind].name.find(" a ") != std::string::npos;
    q.count = static_cast<std::size_t>(arranging::log_uniform(random, 2, periodic ? 1500 : 15000));
    if (random.uniform() < 0.3) q.scale = std::exp2(std::floor(random.uniform(-40, 40)));
    if (random.uniform() < 0.2) q.offset = random.uniform(-1e3, 1e3);
    if (random.uniform() < 0.2) q.softening = arranging::log_uniform(random, 1e-9, 0.1);
    q.at_targets = random.uniform() < 0.25;
    return q;
}
Arrangement made(const Question& q) {
    Arrangement all = kinds()[q.kind].make(q.count, q.seed);
    for (Vec3d& p : all.places) p = p * q.scale + Vec3d::all(all.period > 0 ? 0 : q.offset * q.scale);
    all.period *= q.scale;
    if (all.softening.length == 0 && all.lengths.empty()) all.softening.length = q.softening * q.scale;
    all.softening.length =
        all.period > 0 ? std::min(all.softening.length, all.period / 4) : all.softening.length;
    return all;
}
/// The errors as shares of the accuracy: the rms, and a tenth of the largest but a thousandth.
double excess(const Question& q, std::uint64_t& questions) {
    Arrangement all = made(q);
    const std::size_t charges = all.size();
    if (charges == 0) return 0;
    std::vector<PotentialAt<double>> found(charges);
    std::optional<ForceOracle> oracle;
    if (q.at_targets) {
        std::vector<Vec3d> places;
        std::vector<std::size_t> numbers;
        for (std::uint64_t i = 0; i < 300; ++i) {
            Random random(q.seed + 7, i);
            const Vec3d apart = random.direction<3>();
            places.push_back(all.places[random.bits() % charges] +
                             apart * (arranging::log_uniform(random, 1e-12, 1) * q.scale));
            numbers.push_back(charges + i);
        }
        found.resize(charges + places.size());
        forces<double>(all.view(), Targets<double>(places), std::span(found).subspan(charges),
                       {.accuracy = q.accuracy}, serial_executor());
        for (const Vec3d& place : places) all.add(place, 0);
        if (!all.lengths.empty()) all.lengths.resize(all.size());
        Arrangement with_lengths = all;  // targets of no length leave it to the charges
        if (all.lengths.empty() && all.softening.length > 0) {
            with_lengths.lengths.assign(charges, all.softening.length);
            with_lengths.lengths.resize(all.size());
        }
        all = with_lengths;
        oracle.emplace(all, numbers);
    } else {
        forces<double>(all.view(), found, {.accuracy = q.accuracy}, serial_executor());
        oracle.emplace(all, all.period > 0 ? 40 : 100);
    }
    questions += found.size();
    const FoundErrors errors = oracle->errors_of(found);
    return std::max(errors.rms, errors.most / 10) / q.accuracy;
}

}  // namespace

Report hunt_particles(std::uint64_t seed, std::uint64_t round) {
    const auto sets = instruction_sets();
    use_instruction_set(sets[round / 4 % sets.size()]);
    Report report;
    Question q = drawn(seed, round);
    double worst = excess(q, report.questions);
    report.checked_exactly = report.questions;
    // One of a few targets may err as a few of many may.
    if (!(worst > 1)) return report;
    // Look for fewer charges that show it.
    for (std::size_t fewer = q.count / 2; fewer >= 2; fewer /= 2) {
        Question smaller = q;
        smaller.count = fewer;
        if (const double share = excess(smaller, report.questions); share > 1) q = smaller, worst = share;
    }
    report.found.push_back(
        fmt::format("// {} {}: {:.3g} times the accuracy, by {}\n"
                    "expect_found(\"{}\", {}, {}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {});",
                    seed, round, worst, sets[round / 4 % sets.size()], kinds()[q.kind].name, q.count, q.seed,
                    q.accuracy, q.scale, q.offset, q.softening, q.at_targets));
    return report;
}

}  // namespace hedgerow::hunter
