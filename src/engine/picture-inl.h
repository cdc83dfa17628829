/// The order in which the rays of a batch make packets. Rays of a picture are taken in blocks of 8 by 8,
/// since these share more of their path than the rays of a row.
#if defined(HEDGEROW_ENGINE_PICTURE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_PICTURE_INL_H
#undef HEDGEROW_ENGINE_PICTURE_INL_H
#else
#define HEDGEROW_ENGINE_PICTURE_INL_H
#endif

#include <algorithm>
#include <cmath>

#include <hwy/highway.h>

#include <hedgerow/probes/ray_array.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A block is 8 runs of 8 rays, one run a row. If rows are 8 long, a block is 64 consecutive rays.
inline constexpr std::size_t block_side = 8, block_size = block_side * block_side;

// Guesses the width of the picture: rays a row. Returns 8 if the rays do not look like a picture. The second
// row begins with a ray that is as near to the first ray as the first ray's neighbours in its row.
inline std::size_t picture_row(const RayArray<float, 3>& rays) {
    constexpr std::size_t none = block_side, longest = 8192, some = 4;
    // The squared distance between two rays, over origins and directions.
    const auto apart2 = [&](std::size_t i, std::size_t j) {
        float sum = 0;
        for (std::size_t w = 0; w < 6; ++w) {
            const float d = rays.word(i, w) - rays.word(j, w);
            sum += d * d;
        }
        return sum;
    };
    // A picture has at least 16 rows. Near is up to 2.5 times the distance of neighbours, measured over 4 of
    // them.
    const std::size_t most = std::min(rays.size() / 16, longest);
    if (most <= none) return none;
    const float along2 = apart2(0, some), near2 = along2 * (2.5f * 2.5f / (some * some));
    if (!(near2 > 0)) return none;
    if (apart2(0, 2 * some) < 2 * along2) return none;  // there is no row, or rows are 8 long
    const float near = std::sqrt(near2);
    // Find the first ray that is near. Comparing one number first is cheap.
    for (std::size_t row = none; row <= most; ++row) {
        if (!(std::abs(rays.word(row, 3) - rays.word(0, 3)) <= near) || !(apart2(0, row) <= near2)) continue;
        // Accept it if the next row is as near, and its rays are as far apart within a factor of 2; and if
        // few rays would be answered twice (by blocks of 8 in a row that is not a multiple of 8).
        const float next2 = apart2(row, row + some);
        const bool again = apart2(row, 2 * row) <= near2 && next2 <= 4 * along2 && along2 <= 4 * next2;
        const bool few_twice = row % block_side == 0 || row >= 16 * block_side;
        if (again && few_twice) return row;
    }
    return none;
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
