/// Arrays that answers are written to: memory of their own, or the caller's.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/base/error.h>

namespace hedgerow {

/// An array of T whose size changes. Its memory is its own and is used again, or it is an array of the
/// caller's, which must stay where it is and is never outgrown. New elements are uncleared.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Buffer() = default;
    Buffer(const Buffer&) = default;
    Buffer& operator=(const Buffer&) = default;
    /// Leaves `other` empty; if its array is the caller's, both write there.
    Buffer(Buffer&& other) noexcept
        : own_(std::move(other.own_)),
          callers_(other.callers_),
          borrows_(other.borrows_),
          size_(std::exchange(other.size_, 0)) {}
    Buffer& operator=(Buffer&& other) noexcept {
        own_ = std::move(other.own_);
        callers_ = other.callers_, borrows_ = other.borrows_;
        size_ = std::exchange(other.size_, 0);
        return *this;
    }
    ~Buffer() = default;
    /// An empty buffer in the caller's array.
    Buffer(std::span<T> callers)
        : callers_(callers), borrows_(true) {}  // NOLINT(google-explicit-constructor)

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    /// Whether the memory is the caller's.
    bool borrows() const { return borrows_; }
    T* data() { return borrows_ ? callers_.data() : own_.data(); }
    const T* data() const { return borrows_ ? callers_.data() : own_.data(); }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }
    T& operator[](std::size_t i) {
        assert(i < size_);
        return data()[i];
    }
    const T& operator[](std::size_t i) const {
        assert(i < size_);
        return data()[i];
    }
    const T& back() const { return (*this)[size_ - 1]; }

    void clear() { size_ = 0; }
    /// Throws InputError, and changes nothing, if the caller's array has less room.
    void resize(std::size_t size) {
        if (borrows_ && size > callers_.size())
            throw InputError("answers need an array of " + std::to_string(size) + " elements, not of " +
                             std::to_string(callers_.size()) + ": make it as long");
        if (!borrows_ && size > own_.size()) {
            if (own_.capacity() < size) own_.reserve(std::max(size, 2 * own_.capacity()));
            own_.resize(size);
        }
        size_ = size;
    }
    void push_back(const T& element) {
        resize(size_ + 1);
        data()[size_ - 1] = element;
    }
    void append(std::span<const T> more) {
        const std::size_t before = size_;
        resize(before + more.size());
        std::copy(more.begin(), more.end(), data() + before);
    }
    friend bool operator==(const Buffer& a, const Buffer& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

private:
    BareVector<T> own_;
    std::span<T> callers_;
    bool borrows_ = false;
    std::size_t size_ = 0;
};

}  // namespace hedgerow
