/// Vectors that leave new plain values uncleared, since the caller fills them at once. Large vectors lie on
/// huge pages.
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

/// Leaves new values uncleared, and requests huge pages for arrays of at least `large` bytes where the system
/// has them. The kernel spends as much time on a fresh page as a build spends on the primitives that fit in
/// it: fresh pages took 40 ms of the 170 ms of a linear BVH of the dragon.
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
    // In bytes: a huge page, and the smallest array that is put on huge pages.
    static constexpr std::size_t huge_page = std::size_t(1) << 21, large = 2 * huge_page;
    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t(huge && bytes >= large ? huge_page : alignof(T) < 16 ? 16 : alignof(T));
    }
};

/// A vector whose new elements are uncleared; on huge pages if it is large.
template <class T>
requires std::is_trivially_destructible_v<T>
using BareVector = std::vector<T, BareAllocator<T>>;
/// A BareVector on ordinary pages, for lists with gaps: only pages that are written take memory.
template <class T>
requires std::is_trivially_destructible_v<T>
using SparseVector = std::vector<T, BareAllocator<T, false>>;

}  // namespace hedgerow
