/// Parses the lists of a comparison: structures, values of an option, sizes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow::measure {

/// Splits a list of structures. "grid,bvh:builder=sweep,bins=8,kdtree" is three structures: a part with '='
/// but no ':' is one more option of the structure before it. Throws UsageError for empty parts and for an
/// option before any structure.
std::vector<std::string> structures_of(std::string_view list);

/// One option of a structure at several values.
struct Sweep {
    std::string structure, option;        ///< "grid" with its fixed options, and "resolution"
    std::vector<std::string> values;      ///< "8", "16", ...
    std::vector<std::string> structures;  ///< "grid:resolution=8", ...
};
/// Parses a structure in which exactly one option has several values or a range (see `range_of`):
/// "grid:resolution=8..256" or "bvh:bins=8,builder=binned,sweep,lbvh". Throws UsageError for anything else.
Sweep sweep_of(std::string_view text);

/// Returns the values of "from..to", both ends included. They double if the ends are positive and a factor of
/// 8 or more apart; else they are up to nine in even steps. They are whole if both ends are. A suffix k, M or
/// G multiplies. Throws UsageError if the text is no range or does not go up.
std::vector<double> range_of(std::string_view text);
/// Parses sizes: a range, or an ascending list of whole numbers. Throws UsageError for anything else.
std::vector<std::uint64_t> sizes_of(std::string_view text);

/// Returns the structures worth comparing on sets of `dimension` with `size` primitives, which are points or
/// others. Each has its standard options; some have useful variants too. Structures whose build takes too
/// long at that size are stored in `left_out` instead.
std::vector<std::string> usual_structures(int dimension, bool points, std::size_t size,
                                          std::vector<std::string>& left_out);

}  // namespace hedgerow::measure
