/// The report of a round of the hunter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hedgerow::hunter {

/// The numbers of queries and of exact checks in a round, and the faults that it found as C++ tests.
struct Report {
    std::uint64_t questions = 0, checked_exactly = 0;
    std::vector<std::string> found;
};

/// Runs a round over instances (instances.cpp).
Report hunt_instances(std::uint64_t seed, std::uint64_t round);
/// Runs a round over pairs of primitives (pairs.cpp).
Report hunt_pairs(std::uint64_t seed, std::uint64_t round);
/// Runs a round over texts of every format (files.cpp).
Report hunt_files(std::uint64_t seed, std::uint64_t round);

/// Runs a round over forces between particles (particles.cpp).
Report hunt_particles(std::uint64_t seed, std::uint64_t round);

}  // namespace hedgerow::hunter
