/// Arrays that own their memory, or use memory that another object keeps alive.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include <hedgerow/base/bare_vector.h>

namespace hedgerow {

/// An array of `size` plain values. Owned memory is not cleared, and is on huge pages if it is large
/// (BareAllocator). Values of a mapped file are used in place. A copy is deep and owns its memory.
template <class T>
class Stored {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Stored() = default;
    explicit Stored(std::size_t size)
        : memory_(size > 0 ? Memory(BareAllocator<T>().allocate(size), Freed{size}) : Memory()),
          size_(size) {}
    /// Refers to `size` values in memory that `owner` keeps alive. Copies nothing.
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
