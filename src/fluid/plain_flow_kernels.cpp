/// The kernels of flows without vectors, for processors and builds that have none.
#include "flow_kernels.h"

#include <algorithm>
#include <cmath>

#ifndef HWY_INLINE
#define HWY_INLINE inline
#define HWY_ATTR
#endif

namespace hedgerow {
namespace {

/// Sixteen floats side by side.
struct Sixteen {
    float lane[16];

    Sixteen() : Sixteen(0.0f) {}
    static Sixteen all(float x) { return Sixteen(x); }
    template <class F>
    static Sixteen each(F f) {
        Sixteen result;
        for (std::size_t k = 0; k < 16; ++k) result.lane[k] = f(k);
        return result;
    }
    friend Sixteen operator+(const Sixteen& a, const Sixteen& b) {
        return each([&](std::size_t k) { return a.lane[k] + b.lane[k]; });
    }
    friend Sixteen operator-(const Sixteen& a, const Sixteen& b) {
        return each([&](std::size_t k) { return a.lane[k] - b.lane[k]; });
    }
    friend Sixteen operator*(const Sixteen& a, const Sixteen& b) {
        return each([&](std::size_t k) { return a.lane[k] * b.lane[k]; });
    }
    friend Sixteen operator/(const Sixteen& a, const Sixteen& b) {
        return each([&](std::size_t k) { return a.lane[k] / b.lane[k]; });
    }
    friend Sixteen larger(const Sixteen& a, const Sixteen& b) {
        return each([&](std::size_t k) { return a.lane[k] > b.lane[k] ? a.lane[k] : b.lane[k]; });
    }
    friend Sixteen root(const Sixteen& a) {
        return each([&](std::size_t k) { return std::sqrt(a.lane[k]); });
    }
    // Adds number k to number k + 8, then k to k + 4, k + 2 and k + 1.
    float sum() const {
        Sixteen s = *this;
        for (std::size_t n = 8; n > 0; n /= 2)
            for (std::size_t k = 0; k < n; ++k) s.lane[k] += s.lane[k + n];
        return s.lane[0];
    }

private:
    explicit Sixteen(float x) { std::fill_n(lane, 16, x); }
};

/// The numbers of up to sixteen neighbours; others are 0.
struct SixteenIds {
    std::uint32_t lane[16] = {};
    std::size_t count;

    SixteenIds(const std::uint32_t* from, std::size_t left) : count(std::min<std::size_t>(left, 16)) {
        std::copy_n(from, count, lane);
    }
    Sixteen or_else(const Sixteen& a, float other) const {
        return Sixteen::each([&](std::size_t k) { return k < count ? a.lane[k] : other; });
    }
};

Sixteen gathered(const float* from, const SixteenIds& ids) {
    return Sixteen::each([&](std::size_t k) { return from[ids.lane[k]]; });
}
Sixteen differences(std::uint32_t one, const std::uint32_t* from, const SixteenIds& ids) {
    return Sixteen::each([&](std::size_t k) {
        return static_cast<float>(static_cast<std::int32_t>(one - from[ids.lane[k]]));
    });
}

#include "pair_sums-inl.h"

}  // namespace

const detail::FlowKernels& detail::flow_kernels() {
    static constexpr FlowKernels plain{flow_kernels_of<2>, flow_kernels_of<3>};
    const FlowKernels* const vectors = in_use<FlowKernels>();
    return vectors != nullptr ? *vectors : plain;
}

}  // namespace hedgerow
