/// A cell list that is written by hand for the processor's vectors, as programs of particles have them: the
/// peer of neighbours_benchmark and fluid_benchmark.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hedgerow::by_hand {

/// Points sorted into dense cells whose sides are the radius: coordinates (with room for 16 more), how many
/// cells there are along each axis, and where each begins.
struct Cells {
    const float* at[3];
    int count[3];
    const std::uint32_t* start;
};

/// Writes the lists of all points, each without the point itself, and where they begin; there must be room
/// for 16 numbers more than they have. Returns how many these are.
using List = std::size_t (*)(const Cells&, float radius2, std::uint32_t* offsets, std::uint32_t* ids);
template <int D>
std::size_t list_avx512(const Cells&, float radius2, std::uint32_t* offsets, std::uint32_t* ids);
template <int D>
std::size_t list_avx2(const Cells&, float radius2, std::uint32_t* offsets, std::uint32_t* ids);

/// Lists by list_row(cells, i, first, last, radius2, to), which tests points from `first` to `last` and
/// returns how many it has written.
template <class ListRow>
std::size_t list(const Cells& cells, float radius2, std::uint32_t* offsets, std::uint32_t* ids,
                 ListRow list_row) {
    const int wide = cells.count[0], high = cells.count[1], deep = cells.count[2];
    std::size_t size = 0, c = 0;
    for (int z = 0; z < deep; ++z)
        for (int y = 0; y < high; ++y)
            for (int x = 0; x < wide; ++x, ++c) {
                if (cells.start[c] == cells.start[c + 1]) continue;
                std::uint32_t rows[18];
                int count = 0;
                for (int k = z > 0 ? z - 1 : 0; k <= z + 1 && k < deep; ++k)
                    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < high; ++j) {
                        const std::uint32_t* const row =
                            cells.start +
                            (std::size_t(k) * std::size_t(high) + std::size_t(j)) * std::size_t(wide);
                        rows[count++] = row[x > 0 ? x - 1 : 0];
                        rows[count++] = row[(x + 1 < wide ? x + 1 : x) + 1];
                    }
                for (std::uint32_t i = cells.start[c]; i < cells.start[c + 1]; ++i) {
                    offsets[i] = static_cast<std::uint32_t>(size);
                    for (int r = 0; r < count; r += 2)
                        size += list_row(cells, i, rows[r], rows[r + 1], radius2, ids + size);
                }
            }
    offsets[cells.start[c]] = static_cast<std::uint32_t>(size);
    return size;
}

}  // namespace hedgerow::by_hand
