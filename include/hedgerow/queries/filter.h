/// How filters are asked: of one ray or of many, by the walks and by the kernels.
#pragma once

#include <concepts>

#include <hedgerow/queries/hit.h>

namespace hedgerow {

namespace detail {
template <class F, class... Args>
concept Asks = std::invocable<const F&, const Args&...>;
}  // namespace detail

/// What may refuse hits (queries/hit.h): callable with a hit, or with a ray's number and its hit.
template <class F, class T>
concept FilterOf = detail::Asks<F, Hit<T>> || detail::Asks<F, std::size_t, Hit<T>>;

/// Whether a filter keeps a hit of ray number `ray` of a batch (0 for a ray alone). It is called with both if
/// it takes both, else with the hit.
template <class Filter, class H>
constexpr bool keeps(const Filter& filter, std::size_t ray, const H& hit) {
    if constexpr (std::invocable<const Filter&, std::size_t, const H&>)
        return static_cast<bool>(filter(ray, hit));
    else
        return static_cast<bool>(filter(hit));
}

/// Whether a filter lets an instance of this mask be looked into.
template <class Filter>
constexpr bool enters(const Filter& filter, std::uint32_t mask) {
    if constexpr (requires { filter.enters(mask); })
        return static_cast<bool>(filter.enters(mask));
    else
        return true;
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
    bool enters(std::uint32_t mask) const { return hedgerow::enters(*filter, mask); }
};
template <class Filter>
FilterOfRay<Filter> filter_of_ray(const Filter& filter, std::size_t ray) {
    return {&filter, ray};
}
inline KeepAll filter_of_ray(const KeepAll&, std::size_t) {
    return {};
}

/// A filter as the kernels ask it: plain functions, and what they are given. Without them all is kept, and
/// every instance entered.
struct HitFilter {
    bool (*keeps)(const void* filter, std::size_t ray, const Hit<float>& hit) = nullptr;
    const void* filter = nullptr;
    bool (*enters)(const void* filter, std::uint32_t mask) = nullptr;
};
/// Looks at the filter, which has to outlive it.
template <class Filter>
HitFilter hit_filter(const Filter& filter) {
    if constexpr (std::same_as<Filter, KeepAll>) return {};
    HitFilter asked{[](const void* of, std::size_t ray, const Hit<float>& hit) {
                        return keeps(*static_cast<const Filter*>(of), ray, hit);
                    },
                    static_cast<const void*>(&filter)};
    if constexpr (requires(std::uint32_t mask) { filter.enters(mask); })
        asked.enters = [](const void* of, std::uint32_t mask) {
            return enters(*static_cast<const Filter*>(of), mask);
        };
    return asked;
}

}  // namespace hedgerow
