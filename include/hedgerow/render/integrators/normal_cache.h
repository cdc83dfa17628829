/// The normals of surfaces that paths have met lately.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/queries/hit.h>

namespace hedgerow {

/// Keeps the normal of a triangle of an instance until another triangle takes its place: the exact normal in
/// double costs about 80 ns, and paths meet the same triangles again and again. For one thread. 320 KiB,
/// twice that for double.
template <std::floating_point T>
class NormalCache {
public:
    /// The normal at a hit, which `compute` returns if it is not kept.
    template <class Compute>
    const Vec<T, 3>& at(const Hit<T>& hit, const Compute& compute) {
        Entry& e = entries_[(hit.element + hit.instance * 0x9E3779B1u) % entry_count];
        if (e.element != hit.element || e.instance != hit.instance)
            e = {hit.element, hit.instance, compute()};
        return e.normal;
    }

private:
    static constexpr std::size_t entry_count = std::size_t(1) << 14;

    struct Entry {
        std::uint32_t element = Hit<T>::none, instance = 0;
        Vec<T, 3> normal;
    };
    std::vector<Entry> entries_{entry_count};
};

}  // namespace hedgerow
