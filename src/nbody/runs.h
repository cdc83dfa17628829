/// Runs in lists of numbers.
#pragma once

#include <cstddef>
#include <span>

namespace hedgerow::detail {

/// Calls f(first, count) for numbers of an ascending list that follow each other.
template <class F>
void for_each_run(std::span<const std::size_t> numbers, F f) {
    for (std::size_t k = 0, next = k; k < numbers.size(); k = next) {
        while (next < numbers.size() && numbers[next] - numbers[k] == next - k) ++next;
        f(numbers[k], next - k);
    }
}

}  // namespace hedgerow::detail
