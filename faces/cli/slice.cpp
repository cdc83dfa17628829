#include "slice.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <hedgerow/base/error.h>

namespace hedgerow::cli {

Slice slice_of(const std::string& slice) {
    const std::string_view text = slice;
    const auto bad = [&] {
        return UsageError(
            fmt::format("--slice {}: write x, y or z, then = and a fraction from 0 to 1, as z=0.5, or @ and "
                        "a position, as "
                        "z=@12.5",
                        slice));
    };
    if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != '=') throw bad();
    const int axis = text[0] - 'x';
    const bool position = text[2] == '@';
    const std::string_view digits = text.substr(position ? 3 : 2);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) throw bad();
    if (!position && !(value >= 0 && value <= 1)) throw bad();
    return {axis, position, value};
}

Section<3> section_across(int axis, double position, const Upright& upright) {
    Section<3> section;
    section.origin[axis] = section.within.low[axis] = section.within.high[axis] = position;
    const int up = axis != upright.axis ? upright.axis : (axis == 2 ? 1 : 2);
    section.right[3 - axis - up] = 1;
    section.up[up] = 1;
    return section;
}

}  // namespace hedgerow::cli
