/// The sizes of the parts that scenes are made of, in triangles.
#pragma once

#include <array>
#include <cstdint>

namespace hedgerow::detail {

/// The size of the ground below grass, which comes first.
inline std::uint64_t ground_size_of_grass(std::uint64_t size) {
    return size / 8;
}

/// The size of the teapot in a stadium, which comes last.
inline std::uint64_t teapot_size_of_stadium(std::uint64_t size) {
    constexpr std::uint64_t default_total = 54'056, default_teapot = 6'320;
    return size * default_teapot / default_total;
}

/// The triangles of the Cornell box's floor, ceiling, back, right and left wall, and light. The blocks have
/// the rest.
std::array<std::uint64_t, 6> parts_of_cornell_box(std::uint64_t size);

}  // namespace hedgerow::detail
