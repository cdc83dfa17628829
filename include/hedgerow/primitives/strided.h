/// A view of the caller's own array, whatever the distance between its elements.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace hedgerow {

/// `size` elements of type T, the next `stride` bytes after the one before. Copies nothing, owns nothing; an
/// element need not be aligned.
template <class T>
class Strided {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Strided() = default;
    Strided(const void* first, std::size_t size, std::size_t stride = sizeof(T))
        : data_(static_cast<const std::byte*>(first)), size_(size), stride_(stride) {}
    /// A span, a vector or an array: one element after the other.
    template <class R>
    requires std::convertible_to<const R&, std::span<const T>> Strided(const R& all)
        : Strided(std::span<const T>(all).data(), std::span<const T>(all).size()) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t stride() const { return stride_; }
    /// Where an element lies; it need not be aligned.
    const std::byte* at(std::size_t i) const { return data_ + i * stride_; }
    T operator[](std::size_t i) const {
        assert(i < size_);
        T element;
        const std::byte* const from = at(i);
        if constexpr (requires { element[0]; }) {
            // Number by number: of one copy g++ 12 takes each back from the stack, and waits for it there.
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
