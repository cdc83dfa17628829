/// A view of the caller's array, with any distance between its elements.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace hedgerow {

/// A view of `size` elements of type T that start `stride` bytes apart. Copies nothing, owns nothing; an
/// element need not be aligned.
template <class T>
class Strided {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Strided() = default;
    Strided(const void* first, std::size_t size, std::size_t stride = sizeof(T))
        : data_(static_cast<const std::byte*>(first)), size_(size), stride_(stride) {}
    /// A view of a span, a vector or an array, whose elements are contiguous.
    template <class R>
    requires std::convertible_to<const R&, std::span<const T>> Strided(const R& all)
        : Strided(std::span<const T>(all).data(), std::span<const T>(all).size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t stride() const { return stride_; }
    /// The address of element i, which need not be aligned.
    const std::byte* at(std::size_t i) const { return data_ + i * stride_; }
    /// `count` elements from number `first` on.
    Strided part(std::size_t first, std::size_t count) const { return {at(first), count, stride_}; }
    T operator[](std::size_t i) const {
        assert(i < size_);
        T element;
        const std::byte* const from = at(i);
        if constexpr (requires { element[0]; }) {
            // Copy number by number: after one copy of the whole, g++ 12 loads each number back from the
            // stack and waits for it there.
            using Number = std::remove_reference_t<decltype(element[0])>;
            Number* const numbers = &element[0];
            for (std::size_t k = 0; k < sizeof(T) / sizeof(Number); ++k)
                std::memcpy(numbers + k, from + k * sizeof(Number), sizeof(Number));
        } else {
            std::memcpy(static_cast<void*>(&element), from, sizeof(T));
        }
        return element;
    }

private:
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t stride_ = sizeof(T);
};

}  // namespace hedgerow
