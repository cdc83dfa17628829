/// The list by hand in vectors of eight. Compiled for AVX2: nothing of the standard library is in here.
#include <immintrin.h>

#include "cells_by_hand.h"

namespace hedgerow::by_hand {

namespace {

/// Where the lanes of each mask go.
struct Moves {
    alignas(32) std::uint32_t of[256][8] = {};
    constexpr Moves() {
        for (unsigned mask = 0; mask < 256; ++mask)
            for (std::uint32_t lane = 0, to = 0; lane < 8; ++lane)
                if ((mask >> lane & 1) != 0) of[mask][to++] = lane;
    }
};
constexpr Moves moves;

}  // namespace

template <int D>
std::size_t list_avx2(const Cells& cells, float radius2, std::uint32_t* offsets, std::uint32_t* ids) {
    const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    return list(cells, radius2, offsets, ids,
                [lanes](const Cells& c, std::uint32_t i, std::uint32_t first, std::uint32_t last, float r2,
                        std::uint32_t* to) {
                    std::size_t size = 0;
                    for (std::uint32_t j = first; j < last; j += 8) {
                        __m256 d2 = _mm256_setzero_ps();
                        for (int k = 0; k < D; ++k) {
                            const __m256 away =
                                _mm256_sub_ps(_mm256_loadu_ps(c.at[k] + j), _mm256_set1_ps(c.at[k][i]));
                            d2 = _mm256_fmadd_ps(away, away, d2);
                        }
                        unsigned near = static_cast<unsigned>(
                            _mm256_movemask_ps(_mm256_cmp_ps(d2, _mm256_set1_ps(r2), _CMP_LE_OQ)));
                        if (last - j < 8) near &= (1u << (last - j)) - 1;
                        if (i - j < 8) near &= ~(1u << (i - j));
                        const __m256i id = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(j)), lanes);
                        const __m256i move =
                            _mm256_load_si256(reinterpret_cast<const __m256i*>(moves.of[near]));
                        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + size),
                                            _mm256_permutevar8x32_epi32(id, move));
                        size += static_cast<std::size_t>(_mm_popcnt_u32(near));
                    }
                    return size;
                });
}
template std::size_t list_avx2<2>(const Cells&, float, std::uint32_t*, std::uint32_t*);
template std::size_t list_avx2<3>(const Cells&, float, std::uint32_t*, std::uint32_t*);

}  // namespace hedgerow::by_hand
