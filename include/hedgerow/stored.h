/// Arrays that are their own, or lie in memory that somebody else keeps.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include <hedgerow/bare_vector.h>

namespace hedgerow {

/// `size` plain values. Its own are not cleared, and on huge pages where they are many (BareAllocator); those
/// of a file that is mapped are used where they lie. A copy is deep, and its own.
template <class T>
class Stored {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Stored() = default;
    explicit Stored(std::size_t size)
        : memory_(size > 0 ? Memory(BareAllocator<T>().allocate(size), Freed{size}) : Memory()),
          size_(size) {}
    /// Values that lie in what `owner` keeps alive.
    Stored(const std::shared_ptr<void>& owner, T* values, std::size_t size)
        : memory_(owner, values), size_(size) {}

    Stored(const Stored& other) : Stored(other.size_) { std::copy_n(other.data(), size_, data()); }
    Stored(Stored&& other) noexcept
        : memory_(std::move(other.memory_)), size_(std::exchange(other.size_, 0)) {}
    Stored& operator=(Stored other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(size_, other.size_);
        return *this;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t bytes() const { return size_ * sizeof(T); }
    T* data() { return memory_.get(); }
    const T* data() const { return memory_.get(); }
    T& operator[](std::size_t i) { return data()[i]; }
    const T& operator[](std::size_t i) const { return data()[i]; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }

private:
    using Memory = std::shared_ptr<T[]>;
    struct Freed {
        std::size_t size;
        void operator()(T* values) const { BareAllocator<T>().deallocate(values, size); }
    };

    Memory memory_;
    std::size_t size_ = 0;
};

}  // namespace hedgerow
