/// Rays against triangles in a wide BVH, and against instances of such, by the processor's vectors: which
/// instruction set, and what it offers.
///
/// The kernels are one source (src/wide/), compiled for every instruction set that the compiler knows
/// (AVX-512, AVX2, SSE4; NEON) and chosen at run time. All give the same bits as the plain walk does; without
/// any the plain walk is what answers.
#pragma once

#include <string_view>
#include <vector>

#include <hedgerow/primitives/triangle_blocks.h>
#include <hedgerow/queries/filter.h>
#include <hedgerow/ray_array.h>
#include <hedgerow/structures/bvh/wide/wide_tree.h>

namespace hedgerow {

/// What a kernel is told of an index: the tree, its leaves' triangles, and the ids that hits report, if they
/// are not the positions. And of the call: who may refuse hits, and the number of the first ray.
struct WideScene {
    const WideTree<float, 3>& tree;
    const TriangleBlock<float>* blocks;
    Strided<std::uint32_t> faces;
    HitFilter filter = {};
    std::size_t first_ray = 0;
    std::uint32_t instance = 0, geometry = 0;  // what hits report
};

/// An instance of such an index (primitives/instance_set.h). The way back to its space is that of
/// PlacedIndex::inside; what is pointed at moves only with the index.
struct alignas(64) WideInstance {
    double back[4][3];  // the columns of the linear part, then the shift
    const WideTree<float, 3>* tree;
    const TriangleBlocks<float>* triangles;
    const Strided<std::uint32_t>* faces;
    std::uint32_t mask, geometry;
};
static_assert(sizeof(WideInstance) == 128);

/// Instances in a wide BVH, whose items are their numbers. `error` is how much farther than from triangles a
/// ray's hit may lie from its instance's box: hit_error of the set.
struct WideInstances {
    const WideTree<float, 3>& tree;
    const WideInstance* all;
    float error;
    HitFilter filter = {};
};

/// How many rays of a batch were answered by which algorithm. `single` are those that went one by one, by a
/// kernel (all against instances do) or without.
struct KernelUse {
    std::size_t single = 0, phased = 0, packets = 0;

    KernelUse& operator+=(const KernelUse& more) {
        single += more.single, phased += more.phased, packets += more.packets;
        return *this;
    }
};

struct WideKernels {
    std::string_view instruction_set;
    /// How many children a node has best.
    int width;
    /// A ray, or any number of them; where nothing is hit, a Hit that is false. They hold nothing that an
    /// exception of the filter would leave behind.
    Hit<float> (*closest_hit)(const WideScene&, const Ray<float, 3>&);
    bool (*any_hit)(const WideScene&, const Ray<float, 3>&);
    KernelUse (*closest_hits)(const WideScene&, const RayArray<float, 3>&, Hit<float>*);
    KernelUse (*any_hits)(const WideScene&, const RayArray<float, 3>&, bool*);
    Hit<float> (*closest_hit_of_instances)(const WideInstances&, const Ray<float, 3>&);
    bool (*any_hit_of_instances)(const WideInstances&, const Ray<float, 3>&);

    Hit<float> closest(const WideScene& scene, const Ray<float, 3>& ray) const {
        return closest_hit(scene, ray);
    }
    Hit<float> closest(const WideInstances& scene, const Ray<float, 3>& ray) const {
        return closest_hit_of_instances(scene, ray);
    }
    bool any(const WideScene& scene, const Ray<float, 3>& ray) const { return any_hit(scene, ray); }
    bool any(const WideInstances& scene, const Ray<float, 3>& ray) const {
        return any_hit_of_instances(scene, ray);
    }
};

/// The kernels in use, or nullptr for the plain walk. The first call chooses: what the environment names in
/// HEDGEROW_INSTRUCTION_SET (which is ignored if this processor lacks it), else the best there is.
const WideKernels* wide_kernels();

/// What this processor and this build have, best first; "plain" is last and always there.
std::vector<std::string_view> instruction_sets();
/// Takes another, from now on and for all threads. Throws UsageError for one that is not in the list.
void use_instruction_set(std::string_view name);

/// How many children a node of a new index is given: what the kernels in use are best at.
int preferred_wide_width();

}  // namespace hedgerow
