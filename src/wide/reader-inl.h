// The rays of a batch as the kernels read them, whatever their layout. (Read once for each instruction set.)

// One after the other. Those whose numbers lie together are read where they lie. Others are put together some
// at a time, ahead of their use: a vector loaded from what was just stored in parts would have to wait for
// it.
class RayReader {
public:
    HWY_INLINE explicit RayReader(const RayArray<float, 3>& rays) : rays_(rays) {}

    // The 8 numbers of ray i; i never descends.
    HWY_INLINE const std::byte* at(std::size_t i) {
        if (rays_.together()) return rays_.at(i);
        if (i >= first_ + count_) fill(i);
        return reinterpret_cast<const std::byte*>(&ahead_[i - first_]);
    }

private:
    static constexpr std::size_t most = 32;

    HWY_NOINLINE void fill(std::size_t from) {
        first_ = from;
        count_ = std::min(most, rays_.size() - from);
        for (std::size_t i = 0; i < count_; ++i) ahead_[i] = rays_[from + i];
    }

    const RayArray<float, 3>& rays_;
    std::size_t first_ = 0, count_ = 0;
    Ray<float, 3> ahead_[most];
};

// The 8 numbers of as many rays as F has lanes, a row each: half of them from `first` on, the others from
// `second` on.
template <class F, int lanes>
HWY_INLINE void read_rows(F f, const RayArray<float, 3>& rays, std::size_t first, std::size_t second,
                          float (&rows)[8][lanes]) {
    constexpr std::size_t half = lanes / 2;
    if (rays.together() && rays.stride() == sizeof(Ray<float, 3>)) {
        // Every fourth number of half the rays is by turns number w and w + 4.
        hn::Vec<F> a[4], b[4];
        hn::LoadInterleaved4(f, reinterpret_cast<const float*>(rays.at(first)), a[0], a[1], a[2], a[3]);
        hn::LoadInterleaved4(f, reinterpret_cast<const float*>(rays.at(second)), b[0], b[1], b[2], b[3]);
        for (int w = 0; w < 4; ++w) {
            hn::Store(hn::ConcatEven(f, b[w], a[w]), f, rows[w]);
            hn::Store(hn::ConcatOdd(f, b[w], a[w]), f, rows[w + 4]);
        }
        return;
    }
    for (std::size_t w = 0; w < 8; ++w) {
        if (rays.stride(w) == sizeof(float)) {
            std::memcpy(rows[w], rays.at(first, w), half * sizeof(float));
            std::memcpy(rows[w] + half, rays.at(second, w), half * sizeof(float));
        } else
            for (std::size_t i = 0; i < half; ++i)
                rows[w][i] = rays.word(first + i, w), rows[w][half + i] = rays.word(second + i, w);
    }
}

// What comes next, asked of the memory while a packet computes.
template <class T>
HWY_INLINE void prefetch_all(const T* from, std::size_t count) {
    for (std::size_t at = 0; at < count * sizeof(T); at += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(from) + at);
}
HWY_INLINE void prefetch_rays(const RayArray<float, 3>& rays, std::size_t first, std::size_t count) {
    if (rays.together() && rays.stride() == sizeof(Ray<float, 3>))
        return prefetch_all(rays.at(first), count * rays.stride());
    for (std::size_t w = 0; w < 8; ++w)
        if (rays.stride(w) == sizeof(float)) prefetch_all(rays.at(first, w), count * sizeof(float));
}
