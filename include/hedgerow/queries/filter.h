/// How filters are asked: of one ray or of many, by the walks and by the kernels.
#pragma once

#include <concepts>

#include <hedgerow/queries/hit.h>

namespace hedgerow {

/// Whether a filter keeps a hit of ray number `ray` of a batch (0 for a ray alone). It is called with both if
/// it takes both, else with the hit.
template <class Filter, class H>
constexpr bool keeps(const Filter& filter, std::size_t ray, const H& hit) {
    if constexpr (std::invocable<const Filter&, std::size_t, const H&>)
        return static_cast<bool>(filter(ray, hit));
    else
        return static_cast<bool>(filter(hit));
}

/// A batch's filter, for one of its rays.
template <class Filter>
struct FilterOfRay {
    const Filter* filter;
    std::size_t ray;

    template <class H>
    bool operator()(const H& hit) const {
        return keeps(*filter, ray, hit);
    }
};
template <class Filter>
FilterOfRay<Filter> filter_of_ray(const Filter& filter, std::size_t ray) {
    return {&filter, ray};
}
inline KeepAll filter_of_ray(const KeepAll&, std::size_t) {
    return {};
}

/// A filter as the kernels ask it: a plain function, and what it is given. Without a function all is kept.
struct HitFilter {
    bool (*keeps)(const void* filter, std::size_t ray, const Hit<float>& hit) = nullptr;
    const void* filter = nullptr;
};
/// Looks at the filter, which has to outlive it.
template <class Filter>
HitFilter hit_filter(const Filter& filter) {
    if constexpr (std::same_as<Filter, KeepAll>)
        return {};
    else
        return {[](const void* asked, std::size_t ray, const Hit<float>& hit) {
                    return keeps(*static_cast<const Filter*>(asked), ray, hit);
                },
                static_cast<const void*>(&filter)};
}

}  // namespace hedgerow
