/// Questions about forces that the hunter draws and tests repeat: an arrangement, its size and place, the
/// accuracy.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <hedgerow/nbody/forces.h>

#include "arrangements.h"
#include "force_oracle.h"

namespace hedgerow {

/// Which arrangement, how many charges, of which size and place, how precisely.
struct ForceQuestion {
    std::size_t kind, count;
    std::uint64_t seed;
    double accuracy, scale = 1, offset = 0, softening = 0;
    bool at_targets = false;  ///< at other places than those of the charges, most of them close to one
};

inline const std::vector<NamedArrangement>& kinds_of_arrangements() {
    static const std::vector<NamedArrangement> all = [] {
        std::vector<NamedArrangement> both = open_arrangements();
        for (auto& one : periodic_arrangements()) both.push_back(one);
        return both;
    }();
    return all;
}
inline Arrangement made(const ForceQuestion& q) {
    Arrangement all = kinds_of_arrangements()[q.kind].make(q.count, q.seed);
    for (Vec3d& p : all.places) p = p * q.scale + Vec3d::all(all.period > 0 ? 0 : q.offset * q.scale);
    all.period *= q.scale;
    if (all.softening.length == 0 && all.lengths.empty()) all.softening.length = q.softening * q.scale;
    all.softening.length =
        all.period > 0 ? std::min(all.softening.length, all.period / 4) : all.softening.length;
    return all;
}
/// The errors of the forces that are asked for, as shares of the accuracy: the greatest of the rms, a tenth
/// of the largest but a thousandth and, in open space, a thirtieth of the largest of potentials. Adds the
/// number of forces to `questions`.
inline double excess(const ForceQuestion& q, std::uint64_t& questions) {
    Arrangement all = made(q);
    const std::size_t charges = all.size();
    if (charges == 0) return 0;
    const auto share = [&](const FoundErrors& errors) {
        const double potential = all.period > 0 ? 0 : errors.potential;  // those of neutral cubes cancel
        return std::max(errors.excess(q.accuracy), potential / 30 / q.accuracy);
    };
    std::vector<PotentialAt<double>> found(charges);
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
                       {.accuracy = q.accuracy, .threads = serial_executor()});
        for (const Vec3d& place : places) all.add(place, 0);
        if (!all.lengths.empty()) all.lengths.resize(all.size());
        Arrangement with_lengths = all;  // targets of no length leave it to the charges
        if (all.lengths.empty() && all.softening.length > 0) {
            with_lengths.lengths.assign(charges, all.softening.length);
            with_lengths.lengths.resize(all.size());
        }
        questions += places.size();
        return share(ForceOracle(with_lengths, numbers).errors_of(found));
    }
    forces<double>(all.view(), found, {.accuracy = q.accuracy, .threads = serial_executor()});
    questions += charges;
    const ForceOracle some(all, all.period > 0 ? 40 : 100);
    return share(errors_at_some_or_many(some, all, found, q.accuracy));
}

}  // namespace hedgerow
