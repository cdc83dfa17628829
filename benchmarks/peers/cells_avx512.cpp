/// The list by hand in vectors of sixteen. Compiled for AVX-512: nothing of the standard library is in here.
#include <immintrin.h>

#include "cells_by_hand.h"

namespace hedgerow::by_hand {

template <int D>
std::size_t list_avx512(const Cells& cells, float radius2, std::uint32_t* offsets, std::uint32_t* ids) {
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    return list(cells, radius2, offsets, ids,
                [lanes](const Cells& c, std::uint32_t i, std::uint32_t first, std::uint32_t last, float r2,
                        std::uint32_t* to) {
                    std::size_t size = 0;
                    for (std::uint32_t j = first; j < last; j += 16) {
                        __m512 d2 = _mm512_setzero_ps();
                        for (int k = 0; k < D; ++k) {
                            const __m512 away =
                                _mm512_sub_ps(_mm512_loadu_ps(c.at[k] + j), _mm512_set1_ps(c.at[k][i]));
                            d2 = _mm512_fmadd_ps(away, away, d2);
                        }
                        unsigned near = _mm512_cmp_ps_mask(d2, _mm512_set1_ps(r2), _CMP_LE_OQ);
                        if (last - j < 16) near &= (1u << (last - j)) - 1;
                        if (i - j < 16) near &= ~(1u << (i - j));
                        const __m512i id = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(j)), lanes);
                        _mm512_storeu_si512(to + size,
                                            _mm512_maskz_compress_epi32(static_cast<__mmask16>(near), id));
                        size += static_cast<std::size_t>(_mm_popcnt_u32(near));
                    }
                    return size;
                });
}
template std::size_t list_avx512<2>(const Cells&, float, std::uint32_t*, std::uint32_t*);
template std::size_t list_avx512<3>(const Cells&, float, std::uint32_t*, std::uint32_t*);

}  // namespace hedgerow::by_hand
