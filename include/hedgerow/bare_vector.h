/// Vectors of plain values that are filled right after: not cleared, and on huge pages where they are large.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace hedgerow {

/// A fresh page costs the kernel as much as a build spends on the primitives that fit in it: of the 170 ms
/// that a linear BVH of the dragon took, 40 ms. Large arrays therefore ask for huge ones, where the system
/// has them.
template <class T, bool huge = true>
struct BareAllocator {
    using value_type = T;
    template <class U>
    struct rebind {
        using other = BareAllocator<U, huge>;
    };

    BareAllocator() = default;
    template <class U>
    BareAllocator(const BareAllocator<U, huge>&) {}  // NOLINT: allocators convert

    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        void* p = ::operator new(bytes, alignment(bytes));
#if defined(__linux__)
        if (huge && bytes >= large) madvise(p, bytes, MADV_HUGEPAGE);  // a refusal changes nothing
#endif
        return static_cast<T*>(p);
    }
    void deallocate(T* p, std::size_t n) {
        ::operator delete(p, alignment(n * sizeof(T)));
    }

    template <class U, class... Args>
    void construct(U* p, Args&&... args) {
        if constexpr (sizeof...(Args) == 0)
            ::new (static_cast<void*>(p)) U;
        else
            ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
    }
    friend bool operator==(const BareAllocator&, const BareAllocator&) {
        return true;
    }

private:
    static constexpr std::size_t huge_page = std::size_t(1) << 21, large = 2 * huge_page;
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t(huge && bytes >= large ? huge_page : alignof(T) < 16 ? 16 : alignof(T));
    }
};

template <class T>
requires std::is_trivially_destructible_v<T>
using BareVector = std::vector<T, BareAllocator<T>>;
/// The same on ordinary pages, for lists with gaps: memory is spent on what is written alone.
template <class T>
requires std::is_trivially_destructible_v<T>
using SparseVector = std::vector<T, BareAllocator<T, false>>;

}  // namespace hedgerow
