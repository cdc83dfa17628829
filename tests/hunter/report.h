/// What a round of the hunter reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hedgerow::hunter {

/// What a round has done, and as C++ what went wrong in it.
struct Report {
    std::uint64_t questions = 0, checked_exactly = 0;
    std::vector<std::string> found;
};

/// A round over instances (instances.cpp).
Report hunt_instances(std::uint64_t seed, std::uint64_t round);

}  // namespace hedgerow::hunter
