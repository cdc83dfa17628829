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

// Rays `first` and on, as many as there are lanes, a row each of their 8 numbers.
template <int lanes>
HWY_INLINE void read_rows(const RayArray<float, 3>& rays, std::size_t first, float (&rows)[8][lanes]) {
    if (rays.together() && rays.stride() == sizeof(Ray<float, 3>)) {
        const std::byte* const from = rays.at(first);
        for (std::size_t i = 0; i < lanes; ++i)
            for (std::size_t w = 0; w < 8; ++w)
                std::memcpy(&rows[w][i], from + (8 * i + w) * sizeof(float), sizeof(float));
        return;
    }
    for (std::size_t w = 0; w < 8; ++w) {
        if (rays.stride(w) == sizeof(float))
            std::memcpy(rows[w], rays.at(first, w), sizeof rows[w]);
        else
            for (std::size_t i = 0; i < lanes; ++i) rows[w][i] = rays.word(first + i, w);
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
