/// Counts all memory that a program allocates with `new`. One source of a program includes this. A sanitizer
/// (HEDGEROW_SANITIZED) has an allocator of its own, so nothing is counted there.
#pragma once

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

#ifndef HEDGEROW_SANITIZED
static std::atomic<std::size_t> allocations{0}, live{0}, most_live{0};  // the latter two in bytes

static void* counted(void* p) {
    if (p == nullptr) throw std::bad_alloc();
    ++allocations;
    const std::size_t now = live += malloc_usable_size(p);
    for (std::size_t most = most_live; now > most && !most_live.compare_exchange_weak(most, now);) {
    }
    return p;
}
static void freed(void* p) {
    live -= malloc_usable_size(p);
    std::free(p);
}

// Not inlined, because g++ would see a malloc without its free, or a free without its malloc, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
    return counted(std::malloc(size > 0 ? size : 1));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto a = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(a, (size / a + 1) * a));
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
    freed(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
    freed(p);
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t) noexcept {
    freed(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    freed(p);
}

/// The most bytes that were allocated at one time during f, beyond those allocated before.
template <class F>
std::size_t most_bytes_of(F f) {
    const std::size_t before = live;
    most_live = before;
    f();
    return most_live - before;
}
#endif
