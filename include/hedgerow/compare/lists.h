/// The lists that a comparison is told: structures, values of an option, sizes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::compare {

/// "grid,bvh:builder=sweep,bins=8,kdtree" is three structures: a part with '=' but no ':' is one more option
/// of the structure before it. Throws UsageError for empty parts and for an option before any structure.
std::vector<std::string> structures_of(std::string_view list);

/// One option of a structure at several values.
struct Sweep {
    std::string structure, option;        ///< "grid" with its other options, and "resolution"
    std::vector<std::string> values;      ///< "8", "16", ...
    std::vector<std::string> structures;  ///< "grid:resolution=8", ...
};
/// "grid:resolution=8..256" or "bvh:bins=8,builder=binned,sweep,lbvh": the option that has several values, or
/// a range (see `range_of`). Throws UsageError if it is not exactly one.
Sweep sweep_of(std::string_view text);

/// The values of "from..to": doubled from one to the next where the ends are a factor of 8 or more apart,
/// else up to nine in even steps; both ends are among them. Whole numbers if both ends are. A letter k, M or
/// G multiplies. Throws UsageError for what is no range or goes down.
std::vector<double> range_of(std::string_view text);
/// Sizes: a range, or a list of whole numbers, ascending. Throws UsageError.
std::vector<std::uint64_t> sizes_of(std::string_view text);

/// Structures worth comparing among sets of `dimension` with `size` primitives, points or others: each by its
/// standard options, and variants that are known for something. What takes long to build at that size is left
/// out and named in `left_out`.
std::vector<std::string> usual_structures(int dimension, bool points, std::size_t size,
                                          std::vector<std::string>& left_out);

}  // namespace hedgerow::compare
