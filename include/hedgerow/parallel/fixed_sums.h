/// Sums over many items that have the same bits for any number of threads and any order of the items.
#pragma once

#include <array>
#include <mutex>

#include <hedgerow/geometry/fixed_point.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// The sums of `share(i)`, N numbers, over i from 0 to n. They are in fixed point, each by its largest term,
/// so `share` is called twice for each item. A sum of a term that is not finite is not a number. O(n).
template <std::size_t N, class F>
std::array<double, N> fixed_sums(std::size_t n, Executor& executor, F share) {
    std::array<double, N> largest{};
    std::array<FixedPoint::Sum, N> sums;
    std::mutex joining;
    executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
        std::array<double, N> here{};
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<double, N> terms = share(i);
            for (std::size_t k = 0; k < N; ++k) here[k] = FixedPoint::larger(here[k], terms[k]);
        }
        const std::lock_guard lock(joining);
        for (std::size_t k = 0; k < N; ++k) largest[k] = FixedPoint::larger(largest[k], here[k]);
    });
    const auto points = [&]<std::size_t... k>(std::index_sequence<k...>) {
        return std::array<FixedPoint, N>{FixedPoint(largest[k])...};
    }
    (std::make_index_sequence<N>());
    executor.for_each_piece(n, worth_a_task, [&](std::size_t begin, std::size_t end) {
        std::array<FixedPoint::Sum, N> here;
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<double, N> terms = share(i);
            for (std::size_t k = 0; k < N; ++k) here[k] += points[k].integer(terms[k]);
        }
        const std::lock_guard lock(joining);
        for (std::size_t k = 0; k < N; ++k) sums[k] += here[k];
    });
    std::array<double, N> values;
    for (std::size_t k = 0; k < N; ++k) values[k] = points[k].value(sums[k]);
    return values;
}

}  // namespace hedgerow
