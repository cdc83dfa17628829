/// Arrangements of charges that are hard on sums of forces: close pairs, strings, shells, clumps at the faces
/// of periodic cubes, unlike masses, bodies that are far out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <hedgerow/nbody/direct_sum.h>
#include <hedgerow/scenes/particles.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow {

/// Charges and what is asked of them.
struct Arrangement {
    std::vector<Vec3d> places;
    std::vector<double> charges;
    Softening softening = {};
    std::vector<double> lengths = {};
    double period = 0;

    void add(const Vec3d& place, double charge) { places.push_back(place), charges.push_back(charge); }
    std::size_t size() const { return places.size(); }
    Charges<double> view() const { return {places, charges, softening, lengths, period}; }
};
/// An arrangement of about n charges; the seed chooses all that is random.
struct NamedArrangement {
    std::string name;
    std::function<Arrangement(std::size_t n, std::uint64_t seed)> make;
};

namespace arranging {

/// Charges at places that a function tells of the number of each and of random numbers of its own.
inline Arrangement each(std::size_t n, std::uint64_t seed,
                        const std::function<void(Arrangement&, std::size_t, Random&)>& add) {
    Arrangement all;
    for (std::uint64_t i = 0; i < n; ++i) {
        Random random(seed, i);
        add(all, i, random);
    }
    return all;
}
inline double charge(Random& random) {
    return 0.5 + random.uniform();
}
inline double log_uniform(Random& random, double low, double high) {
    return low * std::pow(high / low, random.uniform());
}
inline Vec3d in_ball(Random& random) {
    const Vec3d direction = random.direction<3>();
    return direction * std::cbrt(random.uniform());
}
/// Pairs in a cube, so far apart as a function says. Charges of the second members are `second` times as
/// large.
inline Arrangement pairs(std::size_t n, std::uint64_t seed, const std::function<double(Random&)>& separation,
                         double second = 1) {
    return each(n / 2, seed, [&](Arrangement& all, std::size_t, Random& random) {
        const Vec3d middle = random.in_cube<3>(), direction = random.direction<3>();
        const double q = charge(random);
        all.add(middle, q);
        all.add(middle + direction * separation(random), q * second);
    });
}
inline Arrangement pairs(std::size_t n, std::uint64_t seed, double separation, double second = 1) {
    return pairs(
        n, seed, [=](Random&) { return separation; }, second);
}
inline Arrangement of(const Particles& all) {
    return {all.places, all.masses};
}
inline Vec3d helix(double t, double turns) {
    const double angle = 2 * std::numbers::pi * turns * t;
    return {std::cos(angle), std::sin(angle), 4 * t};
}
/// Evenly spread places on a sphere (Fibonacci's lattice).
inline Vec3d on_shell(std::size_t i, std::size_t n) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(n),
                 angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0)),
                 r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}
/// A lattice of `axes` dimensions.
inline Arrangement lattice(std::size_t n, int axes, bool neutral) {
    const auto side = static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(n), 1.0 / axes)));
    Arrangement all;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t x = i % side, y = axes > 1 ? i / side % side : 0,
                          z = axes > 2 ? i / side / side : 0;
        all.add(Vec3d(double(x), double(y), double(z)), neutral && (x + y + z) % 2 == 1 ? -1 : 1);
    }
    return all;
}
/// A clump of a size around a place, and even dust, in a periodic cube of side 1.
inline Arrangement clump(std::size_t n, std::uint64_t seed, const Vec3d& at, double size, double share,
                         double heavier) {
    Arrangement all = each(n, seed, [&](Arrangement& into, std::size_t i, Random& random) {
        const bool in_clump = static_cast<double>(i) < share * static_cast<double>(n);
        Vec3d p = in_clump ? at + in_ball(random) * size : random.in_cube<3>();
        for (int k = 0; k < 3; ++k) p[k] -= std::floor(p[k]);
        into.add(p, charge(random) * (in_clump ? heavier : 1));
    });
    all.period = 1;
    return all;
}
inline Arrangement in_period(Arrangement all, double period) {
    all.period = period;
    return all;
}
inline Arrangement softened(Arrangement all, double length,
                            SofteningKernel kernel = SofteningKernel::wendland) {
    all.softening = {kernel, length};
    return all;
}
inline Arrangement with(Arrangement all, const Vec3d& place, double charge) {
    all.add(place, charge);
    return all;
}
/// Random charges in a cube.
inline Arrangement cube(std::size_t n, std::uint64_t seed, bool neutral = false) {
    return each(n, seed, [&](Arrangement& all, std::size_t i, Random& random) {
        const Vec3d p = random.in_cube<3>();
        all.add(p, (neutral && i % 2 == 1 ? -1 : 1) * charge(random));
    });
}

}  // namespace arranging

/// In open space.
inline std::vector<NamedArrangement> open_arrangements() {
    using namespace arranging;
    using N = std::size_t;
    using S = std::uint64_t;
    std::vector<NamedArrangement> all;
    const auto add = [&](std::string name, auto make) { all.push_back({std::move(name), make}); };
    add("cube", [](N n, S s) { return cube(n, s); });
    add("neutral cube", [](N n, S s) { return cube(n, s, true); });
    add("plummer", [](N n, S s) { return of(plummer(n, s)); });
    add("hernquist", [](N n, S s) { return of(hernquist(n, s)); });
    add("disc", [](N n, S s) { return of(disc(n, s)); });
    add("lattice", [](N n, S) { return lattice(n, 3, false); });
    add("salt", [](N n, S) { return lattice(n, 3, true); });
    add("plane lattice", [](N n, S) { return lattice(n, 2, false); });
    add("row", [](N n, S) { return lattice(n, 1, false); });
    add("random line", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N, Random& r) { a.add(Vec3d(1, 2, 3) * r.uniform(), 1); });
    });
    add("roots on a line", [](N n, S s) {
        return each(n, s,
                    [](Arrangement& a, N i, Random&) { a.add(Vec3d(1, 2, 3) * std::sqrt(double(i)), 1); });
    });
    add("helix", [](N n, S s) {
        return each(n, s, [n](Arrangement& a, N i, Random&) { a.add(helix(double(i) / double(n), 5), 1); });
    });
    add("neutral helix", [](N n, S s) {
        return each(n, s, [n](Arrangement& a, N i, Random&) {
            a.add(helix(double(i) / double(n), 5), i % 2 == 0 ? 1 : -1);
        });
    });
    add("shell",
        [](N n, S s) { return each(n, s, [n](Arrangement& a, N i, Random&) { a.add(on_shell(i, n), 1); }); });
    add("shells of both signs", [](N n, S s) {
        return each(n, s, [n](Arrangement& a, N i, Random&) {
            a.add(on_shell(i, n) * (i % 2 == 0 ? 1 : 1.001), i % 2 == 0 ? 1 : -1);
        });
    });
    add("filament", [](N n, S s) {
        Vec3d at;
        return each(n, s,
                    [&](Arrangement& a, N, Random& r) { a.add(at += r.direction<3>() * 0.01, charge(r)); });
    });
    add("Cantor dust", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N, Random& r) {
            Vec3d p;
            for (int k = 0; k < 3; ++k) {
                double share = 1;
                for (int digit = 0; digit < 20; ++digit) p[k] += (share /= 3) * (r.uniform() < 0.5 ? 0 : 2);
            }
            a.add(p, charge(r));
        });
    });
    for (const double apart : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13})
        add("pairs " + std::to_string(std::ilogb(apart)) + " bits apart",
            [=](N n, S s) { return pairs(n, s, apart); });
    add("pairs of any separation",
        [](N n, S s) { return pairs(n, s, [](Random& r) { return log_uniform(r, 1e-12, 1e-1); }); });
    add("dipoles", [](N n, S s) { return pairs(n, s, 1e-6, -1); });
    add("unlike pairs", [](N n, S s) {
        return pairs(
            n, s, [](Random& r) { return log_uniform(r, 1e-10, 1e-2); }, 1e-12);
    });
    add("one close pair", [](N n, S s) {
        return with(with(cube(n - std::min<N>(n, 2), s), {0.7, 0.6, 0.5}, 1), {0.7 + 1e-9, 0.6, 0.5}, 1);
    });
    add("triples", [](N n, S s) {
        return each(std::max<N>(1, n / 3), s, [](Arrangement& a, N, Random& r) {
            const Vec3d p = r.in_cube<3>();
            const double outer = log_uniform(r, 1e-6, 1e-2), inner = outer * log_uniform(r, 1e-5, 1e-1);
            const Vec3d q = p + r.direction<3>() * outer;
            a.add(p, charge(r)), a.add(q, charge(r)), a.add(q + r.direction<3>() * inner, charge(r));
        });
    });
    add("masses up to 1e12", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N, Random& r) {
            const Vec3d p = r.in_cube<3>();
            a.add(p, log_uniform(r, 1, 1e12));
        });
    });
    add("sun and planets", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N i, Random& r) {
            const Vec3d direction = r.direction<3>();
            if (i == 0)
                a.add(Vec3d(), 1e9);
            else
                a.add(direction * log_uniform(r, 1e-6, 1), log_uniform(r, 1e-3, 1));
        });
    });
    add("distances of any size", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N, Random& r) {
            const Vec3d direction = r.direction<3>();
            a.add(direction * log_uniform(r, 1e-60, 1), charge(r));
        });
    });
    add("ring around a mass", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N i, Random& r) {
            const double angle = 2 * std::numbers::pi * r.uniform();
            if (i == 0)
                a.add(Vec3d(), 1e6);
            else
                a.add({std::cos(angle), std::sin(angle), 1e-3 * r.uniform()}, 1);
        });
    });
    for (const double size : {1e-6, 1e-9})
        add("clusters of sizes 1 : " + std::to_string(std::ilogb(size)) + " bits", [=](N n, S s) {
            return each(n, s, [=](Arrangement& a, N i, Random& r) {
                const Vec3d p = r.direction<3>() * r.uniform();
                i % 2 == 0 ? a.add(p * size, 1e6) : a.add(p + Vec3d(5, 1, 2), 1);
            });
        });
    add("nested clusters", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N i, Random& r) {
            a.add(Vec3d(0.3, 0.4, 0.7) + in_ball(r) * std::pow(1e-2, double(i % 6)), charge(r));
        });
    });
    add("many clumps", [](N n, S s) {
        return each(n, s, [s](Arrangement& a, N i, Random& r) {
            Random clump(s + 1, i / 50);
            a.add(clump.in_cube<3>() + in_ball(r) * 1e-6, charge(r));
        });
    });
    add("piles", [](N n, S s) {
        return each(n, s, [s](Arrangement& a, N i, Random& r) {
            Random pile(s + 1, i / 3);
            a.add(pile.in_cube<3>(), charge(r));
        });
    });
    add("noisy sheet", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N, Random& r) {
            const double x = r.uniform(), y = r.uniform();
            a.add({x, y, 0.1 + 1e-16 * r.uniform()}, charge(r));
        });
    });
    add("far from the origin", [](N n, S s) {
        Arrangement a = cube(n, s);
        for (Vec3d& p : a.places) p = p + Vec3d(500000, 5000000, 100);
        return a;
    });
    add("a body at 1e10", [](N n, S s) { return with(cube(n - 1, s), Vec3d(1e10, 2e10, 0), 1); });
    add("a body at 1e100", [](N n, S s) { return with(cube(n - 1, s), Vec3d(-1e100, 2e97, 0), 1); });
    add("bodies on the way out", [](N n, S s) {
        return each(n, s, [](Arrangement& a, N i, Random& r) {
            a.add(r.direction<3>() * (i % 10 == 0 ? log_uniform(r, 1, 1e15) : r.uniform()), charge(r));
        });
    });
    add("softened cube", [](N n, S s) { return softened(cube(n, s), 0.02); });
    add("softened pairs", [](N n, S s) {
        return softened(pairs(n, s, [](Random& r) { return log_uniform(r, 1e-12, 1e-2); }), 1e-3,
                        SofteningKernel::spline);
    });
    add("softened piles", [](N n, S s) {
        Arrangement a = each(n, s, [s](Arrangement& into, N i, Random& r) {
            Random pile(s + 1, i / 3);
            into.add(pile.in_cube<3>(), charge(r)), into.lengths.push_back(0.01 * r.uniform());
        });
        return a;
    });
    add("light bodies within a shell", [](N n, S s) {
        return each(n, s, [](Arrangement& into, N i, Random& r) {
            const Vec3d out = r.direction<3>();
            i % 2 == 0 ? into.add(out, 1) : into.add(out * 0.8 * std::cbrt(r.uniform()), 1e-9);
        });
    });
    return all;
}

/// In cubes that repeat.
inline std::vector<NamedArrangement> periodic_arrangements() {
    using namespace arranging;
    using N = std::size_t;
    using S = std::uint64_t;
    std::vector<NamedArrangement> all;
    const auto add = [&](std::string name, auto make) { all.push_back({std::move(name), make}); };
    add("periodic cube", [](N n, S s) { return in_period(cube(n, s), 1); });
    add("periodic neutral cube", [](N n, S s) { return in_period(cube(n, s, true), 1); });
    add("periodic lattice", [](N n, S) {
        Arrangement a = lattice(n, 3, false);
        return in_period(std::move(a), std::ceil(std::cbrt(double(n)) - 1e-9));
    });
    const std::pair<const char*, Vec3d> corners[] = {
        {"corner", {0, 0, 0}}, {"edge", {0, 1, 0.3}}, {"face", {0.6, 0, 0.2}}, {"middle", {0.5, 0.5, 0.5}}};
    for (const auto& corner : corners) {
        const std::string name = corner.first;
        const Vec3d at = corner.second;
        add("clump at a " + name, [at](N n, S s) { return clump(n, s, at, 1e-3, 0.5, 1); });
        add("heavy clump at a " + name, [at](N n, S s) { return clump(n, s, at, 3e-3, 0.9, 100); });
        add("clump at a " + name + " and one", [at](N n, S s) {
            Arrangement a = clump(n - 1, s, at, 3e-3, 1, 1);
            a.add({0.49, 0.1, 0.51}, 0.01);
            return a;
        });
    }
    add("pairs across faces", [](N n, S s) {
        return in_period(each(n / 2, s,
                              [](Arrangement& a, N, Random& r) {
                                  Vec3d p = r.in_cube<3>(), q = p;
                                  const double apart = log_uniform(r, 1e-10, 1e-2);
                                  p[0] = apart * r.uniform(), q[0] = 1 - apart;
                                  a.add(p, charge(r)), a.add(q, charge(r));
                              }),
                         1);
    });
    add("periodic masses up to 1e12", [](N n, S s) {
        return in_period(each(n, s,
                              [](Arrangement& a, N, Random& r) {
                                  const Vec3d p = r.in_cube<3>();
                                  a.add(p, log_uniform(r, 1, 1e12));
                              }),
                         1);
    });
    return all;
}

}  // namespace hedgerow
