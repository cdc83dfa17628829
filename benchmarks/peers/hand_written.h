/// The list by hand in use: the sort of points into its cells, and the kernel for an instruction set.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <hedgerow/geometry/vec.h>

#include "cells_by_hand.h"

namespace hedgerow::by_hand {

template <int D>
std::size_t list_plain(const Cells& all_cells, float all_radius2, std::uint32_t* offsets,
                       std::uint32_t* ids) {
    return list(all_cells, all_radius2, offsets, ids,
                [](const Cells& cells, std::uint32_t i, std::uint32_t first, std::uint32_t last,
                   float radius2, std::uint32_t* to) {
                    std::size_t size = 0;
                    for (std::uint32_t j = first; j < last; ++j) {
                        float d2 = 0;
                        for (int k = 0; k < D; ++k) {
                            const float away = cells.at[k][j] - cells.at[k][i];
                            d2 += away * away;
                        }
                        to[size] = j;
                        size += d2 <= radius2 && j != i;
                    }
                    return size;
                });
}
/// The kernel for an instruction set of the library (base/instruction_set.h).
template <int D>
List list_for([[maybe_unused]] std::string_view set) {
#if HEDGEROW_HAS_CELLS_BY_HAND
    if (set == "avx512") return list_avx512<D>;
    if (set == "avx2") return list_avx2<D>;
#endif
    return list_plain<D>;
}

/// The sort of a list by hand, and its arrays, which are used again.
template <int D>
class HandWritten {
public:
    /// Room for so many neighbours.
    explicit HandWritten(std::size_t neighbours) : ids_(neighbours + neighbours / 8 + 64) {}

    /// Returns how many neighbours all points have.
    std::size_t run(const std::vector<Vec<float, D>>& points, float radius, List list) {
        const std::size_t n = points.size();
        Vec<float, D> low = points[0], high = points[0];
        for (const auto& p : points)
            for (int k = 0; k < D; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        Cells cells{{}, {1, 1, 1}, nullptr};
        std::size_t all = 1;
        for (int k = 0; k < D; ++k) {
            cells.count[k] = static_cast<int>((high[k] - low[k]) / radius) + 1;
            all *= static_cast<std::size_t>(cells.count[k]);
        }
        const float per_cell = 1 / radius;
        start_.assign(all + 1, 0), cell_.resize(n), offsets_.resize(n + 1);
        for (std::size_t i = 0; i < n; ++i) {
            int c = 0;
            for (int k = D; k-- > 0;) {
                const int last = cells.count[k] - 1;
                c = c * (last + 1) + std::min(last, static_cast<int>((points[i][k] - low[k]) * per_cell));
            }
            cell_[i] = static_cast<std::uint32_t>(c);
            ++start_[static_cast<std::size_t>(c) + 1];
        }
        for (std::size_t c = 0; c < all; ++c) start_[c + 1] += start_[c];
        next_.assign(start_.begin(), start_.end() - 1);
        for (auto& row : at_) row.resize(n + 16);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t to = next_[cell_[i]]++;
            for (int k = 0; k < D; ++k) at_[static_cast<std::size_t>(k)][to] = points[i][k];
        }
        for (std::size_t k = 0; k < 3; ++k) cells.at[k] = at_[k].data();
        cells.start = start_.data();
        return list(cells, radius * radius, offsets_.data(), ids_.data());
    }

private:
    std::array<std::vector<float>, 3> at_;
    std::vector<std::uint32_t> start_, cell_, next_, offsets_, ids_;
};

}  // namespace hedgerow::by_hand
