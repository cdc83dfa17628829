/// How filters are called: for one ray or for many, by the walks and by the kernels.
#pragma once

#include <concepts>

#include <hedgerow/queries/hit.h>

namespace hedgerow {

namespace detail {
template <class F, class... Args>
concept Asks = std::invocable<const F&, const Args&...>;
}  // namespace detail

/// A filter, which may refuse hits (queries/hit.h): callable with a hit, or with a ray's number and its hit.
template <class F, class T>
concept FilterOf = detail::Asks<F, Hit<T>> || detail::Asks<F, std::size_t, Hit<T>>;

/// Whether a filter keeps a hit of ray number `ray` of a batch (0 for a ray alone). The filter is called with
/// number and hit if it takes both, else with the hit.
template <class Filter, class H>
constexpr bool keeps(const Filter& filter, std::size_t ray, const H& hit) {
    if constexpr (std::invocable<const Filter&, std::size_t, const H&>)
        return static_cast<bool>(filter(ray, hit));
    else
        return static_cast<bool>(filter(hit));
}

/// Whether a filter lets an instance with this mask be queried. True for a filter without a member `enters`.
template <class Filter>
constexpr bool enters(const Filter& filter, std::uint32_t mask) {
    if constexpr (requires { filter.enters(mask); })
        return static_cast<bool>(filter.enters(mask));
    else
        return true;
}

/// The filter of a batch, for one of the batch's rays.
template <class Filter>
struct FilterOfRay {
    const Filter* filter;
    std::size_t ray;

    template <class H>
    bool operator()(const H& hit) const {
        return keeps(*filter, ray, hit);
    }
    bool enters(std::uint32_t mask) const { return hedgerow::enters(*filter, mask); }
};
template <class Filter>
FilterOfRay<Filter> filter_of_ray(const Filter& filter, std::size_t ray) {
    return {&filter, ray};
}
inline KeepAll filter_of_ray(const KeepAll&, std::size_t) {
    return {};
}

}  // namespace hedgerow
