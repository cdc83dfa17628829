/// Expected answers of filtered queries.
#pragma once

#include <gtest/gtest.h>

#include <hedgerow/ask.h>

namespace hedgerow {

/// All hits of every ray by an oracle, without a filter. Every filtered answer follows from them.
template <class T>
struct Expected {
    std::vector<Ray<T, 3>> rays;
    std::vector<std::vector<Hit<T>>> all;

    template <class Oracle>
    Expected(const Oracle& oracle, std::vector<Ray<T, 3>> asked) : rays(std::move(asked)), all(rays.size()) {
        for (std::size_t i = 0; i < rays.size(); ++i) all_hits(oracle, rays[i], all[i]);
    }
    /// The closest of the hits of ray i that the filter keeps.
    template <class Filter>
    Hit<T> closest(std::size_t i, const Filter& filter) const {
        for (const auto& hit : all[i])
            if (keeps(filter, i, hit)) return hit;
        return {};
    }
    bool has(std::size_t i, const Hit<T>& hit) const {
        return std::find(all[i].begin(), all[i].end(), hit) != all[i].end();
    }
};

/// A filter that fails the test if it is called with anything but an expected hit of the ray.
template <class T, class Filter>
struct Watched {
    const Expected<T>& expected;
    const Filter& filter;
    std::size_t first_ray = 0;

    bool enters(std::uint32_t mask) const { return hedgerow::enters(filter, mask); }
    bool operator()(std::size_t i, const Hit<T>& hit) const {
        EXPECT_TRUE(expected.has(first_ray + i, hit)) << "asked of what is no hit of ray " << first_ray + i;
        return keeps(filter, first_ray + i, hit);
    }
};

/// Compares the answers of batches and single rays with a filter to the expected hits. `by_hits` is the same
/// filter for a caller that knows all hits.
template <class Index, class T, class Filter, class ByHits>
void expect_filtered(const char* name, const Index& index, const Expected<T>& expected, const Filter& filter,
                     const ByHits& by_hits) {
    SCOPED_TRACE(name);
    const std::size_t count = expected.rays.size();
    std::vector<Hit<T>> batch(count);
    const std::unique_ptr<bool[]> any(new bool[count]);
    const Watched<T, Filter> watched{expected, filter};
    closest_hits(index, expected.rays, batch, {.threads = serial_executor()}, watched);
    any_hits(index, expected.rays, {any.get(), count}, {.threads = serial_executor()}, watched);
    for (std::size_t i = 0; i < count; ++i) {
        const Hit<T> want = expected.closest(i, by_hits);
        ASSERT_EQ(want, batch[i]) << "in a batch, ray " << i;
        ASSERT_EQ(bool(want), any[i]) << "any, in a batch, ray " << i;
        const Watched<T, Filter> alone{expected, filter, i};
        ASSERT_EQ(want, closest_hit(index, expected.rays[i], alone)) << "ray " << i;
        ASSERT_EQ(bool(want), any_hit(index, expected.rays[i], alone)) << "any, ray " << i;
    }
}
template <class Index, class T, class Filter>
void expect_filtered(const char* name, const Index& index, const Expected<T>& expected,
                     const Filter& filter) {
    expect_filtered(name, index, expected, filter, filter);
}

}  // namespace hedgerow
