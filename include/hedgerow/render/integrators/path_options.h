/// How paths are followed.
#pragma once

#include <cstdint>
#include <limits>

#include <hedgerow/base/error.h>
#include <hedgerow/render/sampling/path_samples.h>

namespace hedgerow {

struct PathOptions {
    /// The number of times that light is scattered at most. 0 shows what emits alone, 1 light that comes
    /// straight from its source, too.
    std::uint32_t bounces = 64;
    Sampler sampler = Sampler::sobol;
    std::uint64_t seed = 0;

    /// Where light is looked for: in directions to the lights, and in those in which surfaces scatter. With
    /// both they are weighed by the power heuristic (Veach and Guibas, SIGGRAPH 1995). Light that only one of
    /// them can find (a point, the sun; a mirror's) is lost without it.
    bool light_sampling = true, material_sampling = true;

    /// From this vertex on a path ends at random, the likelier the less light it may still bring, and those
    /// that go on count for those that end (Arvo and Kirk, SIGGRAPH 1990), which changes no mean. `never` is
    /// none.
    std::uint32_t roulette_from = 3;
    static constexpr std::uint32_t never = 0xFFFFFFFFu;
    /// A path ends where less than this share of light gets through. Above 0 pictures are too dark.
    float least_throughput = 0;
    /// Light that is scattered more than once counts up to this much a path. Infinity changes nothing; less
    /// makes pictures too dark and takes away single bright pixels.
    float brightest_indirect = std::numeric_limits<float>::infinity();
    /// Whether light that is scattered several times between the facets of a rough surface is added.
    bool compensation = true;
};

/// Throws InputError for options without a meaning.
inline void check_paths(const PathOptions& o) {
    if (!o.light_sampling && !o.material_sampling)
        throw InputError(
            "paths look for light toward lights, or where surfaces scatter, or both, not neither");
    if (!(o.least_throughput >= 0 && o.least_throughput < 1))
        throw InputError("the share of light below which a path ends must be at least 0 and less than 1");
    if (!(o.brightest_indirect > 0))
        throw InputError("the greatest light that is scattered more than once must be above 0");
}

}  // namespace hedgerow
