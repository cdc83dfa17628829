/// The limit on the items of a structure in which a primitive may be in several cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <hedgerow/base/error.h>

namespace hedgerow {

/// The largest limit that an option gives, which limits nothing.
inline constexpr double most_items_per_primitive = 1e9;

/// The most items for `count` primitives. From 2^31 items a primitive on there is no limit, and the result is
/// 2^63. Throws UsageError for less than one item a primitive.
inline std::uint64_t most_items(double items_per_primitive, std::size_t count) {
    if (!(items_per_primitive >= 1))
        throw UsageError("items_per_primitive=" + std::to_string(items_per_primitive) +
                         " is not at least 1: each primitive is an item of some cell");
    if (!(items_per_primitive < 0x1p31)) return std::uint64_t{1} << 63;
    return static_cast<std::uint64_t>(items_per_primitive * static_cast<double>(count));
}

}  // namespace hedgerow
