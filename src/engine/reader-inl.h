/// Reads the rays of a batch for the kernels, whatever their layout.
#if defined(HEDGEROW_ENGINE_READER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_READER_INL_H
#undef HEDGEROW_ENGINE_READER_INL_H
#else
#define HEDGEROW_ENGINE_READER_INL_H
#endif

#include <algorithm>
#include <cstring>

#include <hwy/highway.h>

#include <hedgerow/probes/ray_array.h>

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Reads rays one by one. Rays whose numbers lie together are read in place. Other rays are copied some at a
// time, ahead of their use: a vector that is loaded from what was just stored in parts has to wait for the
// stores.
class RayReader {
public:
    HWY_INLINE explicit RayReader(const RayArray<float, 3>& rays) : rays_(rays) {}

    // The 8 numbers of ray i. From call to call i must not descend.
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

// Reads as many rays as F has lanes: half of them from `first` on, the others from `second` on. Row w gets
// number w of each ray.
template <class F, int lanes>
HWY_INLINE void read_rows(F f, const RayArray<float, 3>& rays, std::size_t first, std::size_t second,
                          float (&rows)[8][lanes]) {
    constexpr std::size_t half = lanes / 2;
    if (rays.together() && rays.stride() == sizeof(Ray<float, 3>)) {
        // a[w] and b[w] get every fourth number of their rays: in turn numbers w and w + 4 of a ray.
        hn::Vec<F> a[4], b[4];
        hn::LoadInterleaved4(f, reinterpret_cast<const float*>(rays.at(first)), a[0], a[1], a[2], a[3]);
        hn::LoadInterleaved4(f, reinterpret_cast<const float*>(rays.at(second)), b[0], b[1], b[2], b[3]);
        for (int w = 0; w < 4; ++w) {
            hn::Store(hn::ConcatEven(f, b[w], a[w]), f, rows[w]);
            hn::Store(hn::ConcatOdd(f, b[w], a[w]), f, rows[w + 4]);
        }
        return;
    }
    // Any other layout: number by number, and as a run where a number has an array of its own.
    for (std::size_t w = 0; w < 8; ++w) {
        if (rays.stride(w) == sizeof(float)) {
            std::memcpy(rows[w], rays.at(first, w), half * sizeof(float));
            std::memcpy(rows[w] + half, rays.at(second, w), half * sizeof(float));
        } else
            for (std::size_t i = 0; i < half; ++i)
                rows[w][i] = rays.word(first + i, w), rows[w][half + i] = rays.word(second + i, w);
    }
}

// Prefetches what comes next, while a packet computes.
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

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
