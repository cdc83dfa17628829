/// Filters as the kernels call them.
#pragma once

#include <hedgerow/queries/filter.h>

namespace hedgerow {

/// A filter as plain functions, called with `filter`. A null `keeps` keeps every hit. A null `enters` lets
/// rays search every instance.
struct HitFilter {
    bool (*keeps)(const void* filter, std::size_t ray, const Hit<float>& hit) = nullptr;
    const void* filter = nullptr;
    bool (*enters)(const void* filter, std::uint32_t mask) = nullptr;
};

/// A view of a filter. The filter has to outlive the view.
template <class Filter>
HitFilter hit_filter(const Filter& filter) {
    if constexpr (std::same_as<Filter, KeepAll>) return {};
    HitFilter seen{[](const void* of, std::size_t ray, const Hit<float>& hit) {
                       return keeps(*static_cast<const Filter*>(of), ray, hit);
                   },
                   static_cast<const void*>(&filter)};
    if constexpr (requires(std::uint32_t mask) { filter.enters(mask); })
        seen.enters = [](const void* of, std::uint32_t mask) {
            return enters(*static_cast<const Filter*>(of), mask);
        };
    return seen;
}

/// A view of the filter of a ray query. The query has to outlive the view.
template <class Q>
HitFilter filter_of_query(const Q& query) {
    if constexpr (Q::keeps_all) return {};
    return {[](const void* of, std::size_t, const Hit<float>& hit) {
                return static_cast<const Q*>(of)->keeps(hit);
            },
            static_cast<const void*>(&query)};
}

}  // namespace hedgerow
