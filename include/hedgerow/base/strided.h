/// A view of the caller's array, with any distance between its elements.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace hedgerow {

namespace detail {
/// The type of the numbers of T, and how many it has: 0 for what is no row of numbers.
template <class T>
struct NumbersOf {
    using Type = void;
    static constexpr std::size_t count = 0;
};
template <class T>
requires requires(T element) {
    element[0];
}
struct NumbersOf<T> {
    using Type = std::remove_cvref_t<decltype(std::declval<T&>()[0])>;
    static constexpr std::size_t count = sizeof(T) / sizeof(Type);
};
}  // namespace detail

/// What an array of elements T may consist of: T, or arrays of as many numbers as a T has.
template <class E, class T>
concept ElementOf = std::same_as<E, T> ||
    (std::is_bounded_array_v<E>&& std::rank_v<E> == 1 && std::extent_v<E> == detail::NumbersOf<T>::count &&
     std::same_as<std::remove_extent_t<E>, typename detail::NumbersOf<T>::Type>);

/// A view of `size` elements of type T that start `stride` bytes apart. Copies nothing, owns nothing; an
/// element need not be aligned.
template <class T>
class Strided {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Strided() = default;
    /// A view of elements in the caller's array; `stride` is from one to the next, in bytes. A Vec may be an
    /// array of its numbers, such as the member `float position[3]` of a vertex:
    ///
    ///   Strided<Vec3f>(&vertices[0].position, vertices.size(), sizeof(Vertex))
    template <ElementOf<T> E>
    Strided(const E* first, std::size_t size, std::size_t stride = sizeof(E))
        : Strided(reinterpret_cast<const std::byte*>(first), size, stride, Bytes()) {}
    /// A view of elements at an address, which the caller knows to be of type T.
    static Strided in_bytes(const void* first, std::size_t size, std::size_t stride = sizeof(T)) {
        return {static_cast<const std::byte*>(first), size, stride, Bytes()};
    }
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
    Strided part(std::size_t first, std::size_t count) const { return {at(first), count, stride_, Bytes()}; }
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
    struct Bytes {};
    Strided(const std::byte* first, std::size_t size, std::size_t stride, Bytes)
        : data_(first), size_(size), stride_(stride) {}

    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t stride_ = sizeof(T);
};

}  // namespace hedgerow
