/// Counts of the parts of a cell on the sides of a plane, four parts at once.
#pragma once

#include <hedgerow/geometry/number_lanes.h>
#include <hedgerow/structures/bsp/parts.h>

namespace hedgerow {

/// How many parts are in the low cell of a plane, and how many in the high one, of `all`.
struct BspCounts {
    std::uint32_t low = 0, high = 0, all = 0;

    std::uint32_t smaller() const { return std::min(low, high); }
};

/// Every stride-th part of a cell, with the corners of four parts side by side. Heights are rounded to T,
/// relative to one of the parts, so a part within a rounding of a plane may count on either side of it.
template <std::floating_point T, int D>
class BspPartLanes {
public:
    BspPartLanes(const BspParts<D>& parts, std::uint32_t stride)
        : origin_(parts[0].bounds.low), size_((parts.size() + stride - 1) / stride) {
        for (std::uint32_t first = 0; first < size_; first += width) {
            const std::uint32_t used = std::min(width, size_ - first);
            const auto part = [&](std::uint32_t lane) -> const BspPart<D>& {
                return parts[std::size_t{first + lane} * stride];
            };
            std::uint32_t most = 0;
            for (std::uint32_t i = 0; i < used; ++i) most = std::max(most, parts.corner_count(part(i)));
            corner_counts_.push_back(most);
            for (std::uint32_t k = 0; k < most; ++k) {
                // A part of fewer corners repeats its last one. A lane without a part is on no side.
                std::array<Vec<T, D>, width> four;
                for (std::uint32_t i = 0; i < width; ++i)
                    for (int axis = 0; axis < D; ++axis) four[i][axis] = std::numeric_limits<T>::quiet_NaN();
                for (std::uint32_t i = 0; i < used; ++i)
                    four[i] = Vec<T, D>(parts.corner(part(i), std::min(k, parts.corner_count(part(i)) - 1)) -
                                        origin_);
                Corners& corners = corners_.emplace_back();
                for (int axis = 0; axis < D; ++axis)
                    corners[axis] =
                        Number::each([&](int i) { return four[static_cast<std::size_t>(i)][axis]; });
            }
        }
    }
    std::uint32_t size() const { return size_; }

    /// The counts for a plane, where heights up to `on` count as on it. Fewer once `enough` are on both
    /// sides.
    BspCounts count(const CutPlane<D>& plane, double on, std::uint32_t enough) const {
        Corners normal;
        for (int axis = 0; axis < D; ++axis) normal[axis] = static_cast<T>(plane.normal[axis]);
        const Number start = static_cast<T>(plane.height(origin_)), near = static_cast<T>(on);
        BspCounts counts{0, 0, size_};
        Number on_low, on_high;
        const Corners* at = corners_.data();
        for (const std::uint32_t corner_count : corner_counts_) {
            Number low = start + dot(normal, *at), high = low;
            for (const Corners* const end = at++ + corner_count; at < end; ++at) {
                const Number h = start + dot(normal, *at);
                low = lesser(low, h), high = greater(high, h);
            }
            on_low += only(low < -near || high <= near, Number(1));
            on_high += only(high > near, Number(1));
            counts.low = sum(on_low), counts.high = sum(on_high);
            if (counts.smaller() >= enough) break;
        }
        return counts;
    }

private:
    using Number = NumberLanes<T>;
    using Corners = Vec<Number, D>;
    static constexpr std::uint32_t width = Number::count;

    static std::uint32_t sum(const Number& a) {
        return static_cast<std::uint32_t>(a[0] + a[1] + a[2] + a[3]);
    }

    Vec<double, D> origin_;
    std::uint32_t size_;
    /// How many corners each four parts have, and these corners.
    std::vector<std::uint32_t> corner_counts_;
    std::vector<Corners> corners_;
};

}  // namespace hedgerow
