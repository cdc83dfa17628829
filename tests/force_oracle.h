/// What forces should be, by sums of the tests' own in long double: over all pairs, and in periodic cubes
/// after Ewald.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <hedgerow/nbody/potential.h>

#include "arrangements.h"

namespace hedgerow {

/// The errors of found gradients as shares of max(|gradient|, Σ|q·slope of the pair|/100), at some targets.
struct FoundErrors {
    double rms = 0, most = 0, largest = 0;
    std::size_t worst = 0;  ///< the charge with the largest error
    double potential = 0;   ///< the largest error of a potential, as a share of Σ|q|/r

    /// The errors as shares of an accuracy: at most 1 if it is kept, in the rms and 10 times over by 99.9%.
    double excess(double accuracy) const { return std::max(rms, most / 10) / accuracy; }
};

class ForceOracle {
    using Real = long double;
    struct Vector {
        Real x = 0, y = 0, z = 0;
        Real length() const { return std::sqrt(x * x + y * y + z * z); }
    };
    /// φ and −φ'/r of a unit charge.
    struct Share {
        Real potential, pull;
    };

public:
    /// Sums at about so many of the charges. The last five, which may be unlike the others, are added to what
    /// is told of the largest errors alone, unless all are asked for.
    ForceOracle(const Arrangement& all, std::size_t targets) : all_(all) {
        // An odd step, since neighbours in a list are unlike each other in pairs.
        const std::size_t n = all.size(), step = n / std::max<std::size_t>(1, targets) | 1;
        for (std::size_t i = 0; i < n; i += step) targets_.push_back(i);
        even_ = targets_.size();  // those that stand for all charges
        for (std::size_t i = n - std::min<std::size_t>(n, 5); i < n; ++i)
            if (i % step != 0) targets_.push_back(i);
        sum_all();
    }
    /// Sums at given charges.
    ForceOracle(const Arrangement& all, std::vector<std::size_t> targets)
        : all_(all), targets_(std::move(targets)), even_(targets_.size()) {
        sum_all();
    }

    FoundErrors errors_of(const std::vector<PotentialAt<double>>& found) const {
        FoundErrors errors;
        std::vector<double> shares;
        Real squares = 0;
        for (std::size_t k = 0; k < targets_.size(); ++k) {
            const PotentialAt<double>& at = found[targets_[k]];
            const Vector& want = gradients_[k];
            const Vector error{at.gradient[0] - want.x, at.gradient[1] - want.y, at.gradient[2] - want.z};
            const Real length = error.length();
            double share = static_cast<double>(length / sizes_[k]);
            if (length == 0) share = 0;
            if (std::isnan(share)) share = INFINITY;
            if (share > errors.largest) errors.largest = share, errors.worst = targets_[k];
            if (k < even_) shares.push_back(share), squares += Real(share) * share;
            if (weights_[k] > 0)
                errors.potential =
                    std::max(errors.potential,
                             static_cast<double>(std::abs(at.potential - potentials_[k]) / weights_[k]));
        }
        std::sort(shares.begin(), shares.end());
        errors.rms = static_cast<double>(std::sqrt(squares / static_cast<Real>(shares.size())));
        errors.most = shares[(shares.size() - 1) * 999 / 1000];
        return errors;
    }
    PotentialAt<double> at(std::size_t k) const {
        return {static_cast<double>(potentials_[k]),
                {static_cast<double>(gradients_[k].x), static_cast<double>(gradients_[k].y),
                 static_cast<double>(gradients_[k].z)}};
    }
    const std::vector<std::size_t>& targets() const { return targets_; }

private:
    void sum_all() {
        if (all_.period > 0) set_waves();
        for (const std::size_t t : targets_) sum(t);
    }

    static constexpr Real pi = std::numbers::pi_v<Real>;
    // Of side 1: what is summed over images falls as erfc(width·r), what is summed over waves as
    // exp(−(π·n/width)²).
    static constexpr Real width = 5.5L;
    static constexpr int most_waves = 12;

    Real reach_of(std::size_t i) const {
        const double length = all_.lengths.empty() ? all_.softening.length : all_.lengths[i];
        return Real(length) * (all_.softening.kernel == SofteningKernel::wendland ? 3.0L : 2.8L);
    }
    Share softened(Real r, Real reach) const {
        if (r >= reach) return {1 / r, 1 / (r * r * r)};
        const Real u = r / reach, u2 = u * u, u3 = u2 * u, u4 = u2 * u2, u5 = u4 * u, u6 = u3 * u3,
                   u7 = u6 * u, cube = reach * reach * reach;
        if (all_.softening.kernel == SofteningKernel::wendland)
            return {(3 - 7 * u2 + 21 * u4 - 28 * u5 + 15 * u6 - 3 * u7) / reach,
                    (14 - 84 * u2 + 140 * u3 - 90 * u4 + 21 * u5) / cube};
        if (u < 0.5L)
            return {(14.0L / 5 - 16.0L / 3 * u2 + 48.0L / 5 * u4 - 32.0L / 5 * u5) / reach,
                    (32.0L / 3 - 192.0L / 5 * u2 + 32 * u3) / cube};
        return {
            (16.0L / 5 - 1 / (15 * u) - 32.0L / 3 * u2 + 16 * u3 - 48.0L / 5 * u4 + 32.0L / 15 * u5) / reach,
            (64.0L / 3 - 48 * u + 192.0L / 5 * u2 - 32.0L / 3 * u3 - 1 / (15 * u3)) / cube};
    }
    /// A charge of Ewald's real sum, without what waves do.
    static Share screened(Real r) {
        const Real one = std::erfc(width * r) / r,
                   bell = 2 * width / std::sqrt(pi) * std::exp(-width * width * r * r);
        return {one, (one + bell) / (r * r)};
    }
    /// What waves do of a charge that softening changes near by.
    static Share unscreened(Real r) {
        if (r == 0) return {2 * width / std::sqrt(pi), 4 * width * width * width / (3 * std::sqrt(pi))};
        const Real wr = width * r;
        if (wr < 0.05L) {  // series, where differences cancel
            const Real w2 = wr * wr, unit = 2 * width / std::sqrt(pi);
            return {unit * (1 - w2 / 3 + w2 * w2 / 10 - w2 * w2 * w2 / 42 + w2 * w2 * w2 * w2 / 216),
                    2 * unit * width * width *
                        (1.0L / 3 - w2 / 5 + w2 * w2 / 14 - w2 * w2 * w2 / 54 + w2 * w2 * w2 * w2 / 264)};
        }
        const Real one = std::erf(wr) / r, bell = 2 * width / std::sqrt(pi) * std::exp(-wr * wr);
        return {one, (one - bell) / (r * r)};
    }

    void sum(std::size_t t) {
        const std::size_t n = all_.size();
        Vector gradient;
        Real potential = 0, size = 0, weight = 0;
        const Real side = all_.period > 0 ? Real(all_.period) : 1;
        const int images = all_.period > 0 ? 1 : 0;
        for (std::size_t s = 0; s < n; ++s) {
            Vector apart{Real(all_.places[s][0]) - all_.places[t][0],
                         Real(all_.places[s][1]) - all_.places[t][1],
                         Real(all_.places[s][2]) - all_.places[t][2]};
            if (images > 0)
                for (Real* const x : {&apart.x, &apart.y, &apart.z}) *x -= std::round(*x / side) * side;
            const Real charge = all_.charges[s], reach = std::max(reach_of(s), reach_of(t));
            for (int x = -images; x <= images; ++x)
                for (int y = -images; y <= images; ++y)
                    for (int z = -images; z <= images; ++z) {
                        const Vector d{apart.x + x * side, apart.y + y * side, apart.z + z * side};
                        const Real r = d.length();
                        const bool itself = s == t && x == 0 && y == 0 && z == 0;
                        Share share{0, 0};
                        // As a charge alone, which its size goes by.
                        const Share bare = itself      ? Share{0, 0}
                                           : reach > 0 ? softened(r, reach)
                                           : r > 0     ? Share{1 / r, 1 / (r * r * r)}
                                                       : Share{0, 0};
                        if (images == 0) {
                            share = bare;
                        } else {
                            if (r > 1.3L * side) continue;
                            if (r < reach || r == 0) {
                                const Share waves = unscreened(r / side);
                                share = {bare.potential - waves.potential / side,
                                         bare.pull - waves.pull / (side * side * side)};
                            } else {
                                const Share near = screened(r / side);
                                share = {near.potential / side, near.pull / (side * side * side)};
                            }
                        }
                        potential += charge * share.potential;
                        gradient.x += charge * share.pull * d.x, gradient.y += charge * share.pull * d.y;
                        gradient.z += charge * share.pull * d.z;
                        if (x == 0 && y == 0 && z == 0)
                            size += std::abs(charge) * bare.pull * r,
                                weight += std::abs(charge) * bare.potential;
                    }
        }
        if (images > 0) add_waves(t, potential, gradient);
        gradients_.push_back(gradient), potentials_.push_back(potential);
        sizes_.push_back(std::max(gradient.length(), size / 100)), weights_.push_back(weight);
    }

    // Waves of half of space, each with its structure factor.
    struct Wave {
        int x, y, z;
        Real size;
        std::complex<Real> factor;
    };
    void set_waves() {
        const Real side = all_.period;
        for (int x = 0; x <= most_waves; ++x)
            for (int y = x > 0 ? -most_waves : 0; y <= most_waves; ++y)
                for (int z = x > 0 || y > 0 ? -most_waves : 1; z <= most_waves; ++z) {
                    const Real n2 = Real(x * x + y * y + z * z);
                    const Real size = std::exp(-pi * pi * n2 / (width * width)) / (pi * n2);
                    if (size < 1e-21L) continue;
                    waves_.push_back({x, y, z, size, 0});
                }
        for (std::size_t i = 0; i < all_.size(); ++i)
            for_each_wave(i, side, [&](Wave& wave, std::complex<Real> phase) {
                wave.factor += Real(all_.charges[i]) * phase;
            });
        for (const double charge : all_.charges) whole_ += charge;
    }
    template <class F>
    void for_each_wave(std::size_t i, Real side, F f) {
        constexpr std::size_t count = 2 * most_waves + 1;
        std::complex<Real> powers[3][count];
        for (int k = 0; k < 3; ++k)
            for (int n = -most_waves; n <= most_waves; ++n) {
                const Real angle =
                    2 * pi * std::remainder(n * std::remainder(Real(all_.places[i][k]) / side, 1), 1);
                powers[k][n + most_waves] = {std::cos(angle), std::sin(angle)};
            }
        for (Wave& wave : waves_)
            f(wave, powers[0][wave.x + most_waves] * powers[1][wave.y + most_waves] *
                        powers[2][wave.z + most_waves]);
    }
    void add_waves(std::size_t t, Real& potential, Vector& gradient) {
        const Real side = all_.period;
        potential -= whole_ * pi / (width * width) / side;
        for_each_wave(t, side, [&](Wave& wave, std::complex<Real> phase) {
            // Re(factor · conj(phase)), and its slope at the target.
            const std::complex<Real> both = wave.factor * std::conj(phase);
            const Real twice = 2 * wave.size / side;
            potential += twice * both.real();
            const Real slope = twice * 2 * pi / side * both.imag();
            gradient.x += slope * wave.x, gradient.y += slope * wave.y, gradient.z += slope * wave.z;
        });
    }

    const Arrangement& all_;
    std::vector<std::size_t> targets_;
    std::size_t even_ = 0;
    std::vector<Vector> gradients_;
    std::vector<Real> potentials_, sizes_, weights_;
    std::vector<Wave> waves_;
    Real whole_ = 0;
};

/// The errors of forces at the charges that are summed, or at thousands where those are too large: a few of
/// many charges may err by more than the rest, and count too much if they are among a hundred.
inline FoundErrors errors_at_some_or_many(const ForceOracle& some, const Arrangement& all,
                                          const std::vector<PotentialAt<double>>& found, double accuracy) {
    const FoundErrors errors = some.errors_of(found);
    return errors.excess(accuracy) <= 1 ? errors : ForceOracle(all, 4000).errors_of(found);
}

}  // namespace hedgerow
