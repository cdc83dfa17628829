/// The sizes that a benchmark of points is asked for.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>

namespace hedgerow {

/// The numbers of points that the arguments of a program name, or the usual ones if there are none. Throws
/// UsageError for a number that is not from 1000 to 1e8.
inline std::vector<std::size_t> sizes_of(int count, const char* const* arguments,
                                         std::vector<std::size_t> usual) {
    std::vector<std::size_t> sizes;
    for (int i = 1; i < count; ++i) {
        const double size = std::atof(arguments[i]);
        if (!(size >= 1000 && size <= 1e8))
            throw UsageError(std::string(arguments[i]) + " is not from 1000 to 1e8");
        sizes.push_back(static_cast<std::size_t>(size));
    }
    return sizes.empty() ? usual : sizes;
}

}  // namespace hedgerow
