// In which order the rays of a batch make packets: those of a picture by blocks of 8 by 8, whose rays share
// more of their way than those of a row do. (Read once for each instruction set.)

// A block is 8 runs of 8 rays, a row apart; in rows of 8, that is 64 rays as they come.
inline constexpr std::size_t block_side = 8, block_size = block_side * block_side;

// How many rays a row of the picture has whose rays these seem to be, 8 if they seem to be of none: a ray
// that is as near to the first as the first's neighbours in its row begins the second row.
inline std::size_t picture_row(const RayArray<float, 3>& rays) {
    constexpr std::size_t none = block_side, longest = 8192, some = 4;
    const auto apart2 = [&](std::size_t i, std::size_t j) {
        float sum = 0;
        for (std::size_t w = 0; w < 6; ++w) {
            const float d = rays.word(i, w) - rays.word(j, w);
            sum += d * d;
        }
        return sum;
    };
    const std::size_t most = std::min(rays.size() / 16, longest);
    if (most <= none) return none;
    const float along2 = apart2(0, some), near2 = along2 * (2.5f * 2.5f / (some * some));
    if (!(near2 > 0)) return none;
    if (apart2(0, 2 * some) < 2 * along2) return none;  // no row, or one of 8
    const float near = std::sqrt(near2);
    for (std::size_t row = none; row <= most; ++row) {
        if (!(std::abs(rays.word(row, 3) - rays.word(0, 3)) <= near) || !(apart2(0, row) <= near2)) continue;
        const float next2 = apart2(row, row + some);
        const bool again = apart2(row, 2 * row) <= near2 && next2 <= 4 * along2 && along2 <= 4 * next2;
        const bool few_twice = row % block_side == 0 || row >= 16 * block_side;
        if (again && few_twice) return row;
    }
    return none;
}
