/// Kernels: rays and points against triangles in a wide BVH, and rays against instances of such indexes, with
/// the processor's vectors. This header says what the kernels of an instruction set (instruction_set.h)
/// offer.
///
/// All give the same bits as the plain walk. Where there is no kernel, the plain walk answers.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include <hedgerow/base/instruction_set.h>
#include <hedgerow/engine/hit_filter.h>
#include <hedgerow/engine/near_elements.h>
#include <hedgerow/engine/near_keys.h>
#include <hedgerow/engine/point_blocks.h>
#include <hedgerow/engine/triangle_blocks.h>
#include <hedgerow/engine/wide_tree.h>
#include <hedgerow/engine/winding_walk.h>
#include <hedgerow/probes/point_batch.h>
#include <hedgerow/probes/ray_array.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/queries/point_query.h>
#include <hedgerow/queries/signed_crossings.h>
#include <hedgerow/walks/engine.h>

namespace hedgerow {

/// What a kernel needs to know of an index: the tree, the triangles of its leaves, and the ids that hits
/// report (empty if these are the positions). What it needs to know of the call: the filter of hits, and the
/// number of the first ray in its batch.
struct WideScene {
    using Scalar = float;

    const WideTree<float, 3>& tree;
    const TriangleBlock<float>* blocks;
    Strided<std::uint32_t> faces;
    HitFilter filter = {};
    std::size_t first_ray = 0;
    std::uint32_t instance = 0, geometry = 0;  // reported by hits
};

/// An instance of an index of triangles in a wide BVH (instances/instance_set.h). `back` transforms from the
/// world into the index's space, as PlacedIndex::inside does. The pointers are to members of the index, so
/// they are valid while it stays at its address.
struct alignas(64) WideInstance {
    double back[4][3];  // columns of the linear part, then the shift
    const WideTree<float, 3>* tree;
    const TriangleBlocks<float>* triangles;
    const Strided<std::uint32_t>* faces;
    std::uint32_t mask, geometry;
};
static_assert(sizeof(WideInstance) == 128);

/// Instances in a wide BVH, whose items are the numbers of the instances. `error` is a length, hit_error of
/// the set: a ray's hit may lie this much farther from its instance's box than a hit on a triangle from its
/// own.
struct WideInstances {
    const WideTree<float, 3>& tree;
    const WideInstance* all;
    float error;
    HitFilter filter = {};
};

/// The kernels of one kind of query. The answer is a bool, or a Hit that is false where nothing is hit. A
/// kernel owns nothing that an exception from the filter would leave behind.
template <class Answer>
struct RayKernels {
    Answer (*one)(const WideScene&, const Ray<float, 3>&);
    Answer (*among_instances)(const WideInstances&, const Ray<float, 3>&);
    KernelUse (*many)(const WideScene&, const RayArray<float, 3>&, Answer*);
};

/// Writes the next hits of a ray after a place, as many as there is room for, and returns how many there are
/// (queries/first_hits.h).
using FirstHitsKernel = std::size_t (*)(const WideScene&, const Ray<float, 3>&, std::span<Hit<float>>,
                                        const PlaceOfHit<float>&);

/// What a kernel needs to know of an index of points: the tree, and the points of its leaves.
struct WidePoints {
    using Scalar = float;

    const WideTree<float, 3>& tree;
    const PointBlock<float, 3>* blocks;

    /// How many points at the last distance a search for the k nearest looks at in vain before it gives up.
    int most_ties() const { return tree.crowded ? 64 : std::numeric_limits<int>::max(); }
};
/// What a kernel needs to know of an index of triangles of double.
struct WideDoubles {
    using Scalar = double;

    const WideTree<double, 3>& tree;
    const TriangleBlock<double>* blocks;
    Strided<std::uint32_t> faces;
};
/// Leaves of any primitives, behind one plain call: `test` tests those of a leaf, and returns the limit of
/// the walk from then on: the squared distance beyond which no box can change the answer.
template <std::floating_point T>
struct WideLeaves {
    using Scalar = T;

    const WideTree<T, 3>& tree;
    void* asker;
    T (*test)(void* asker, std::uint32_t leaf);
};

/// Kernels insert into sorted lists; a walk has a heap, which is better for more than these.
inline constexpr std::size_t most_nearest = 256;

/// The kernels of closest points over leaves of one kind, where `Scene` is a WideScene, WidePoints or
/// WideDoubles. Distances are squared, and a maximum is included. No coordinate of a point may be NaN or
/// beyond `largest_coordinate<float>`, nor any of the scene.
template <class Scene, class T = typename Scene::Scalar>
struct ClosestKernels {
    /// The closest point; false if there is none.
    Near<T, 3> (*closest)(const Scene&, const Vec<T, 3>&, T max_distance2);
    /// Writes found[n] for point number n.
    void (*closest_of_many)(const Scene&, const PointBatch<T, 3>&, T max_distance2, Near<T, 3>* found);
};
/// Those of several points too, of floats.
template <class Scene>
struct PointKernels : ClosestKernels<Scene> {
    /// Writes the k nearest to `keys`, ascending, for k up to `most_nearest`, for as many of which there must
    /// be room, aligned to 64 bytes. Returns how many there are.
    std::size_t (*nearest)(const Scene&, const Vec<float, 3>&, std::size_t k, float max_distance2,
                           NearKey* keys);
    /// Writes the k nearest to point number n to the places from k·n on of each array, for k up to
    /// `most_nearest`.
    void (*nearest_of_many)(const Scene&, const PointBatch<float, 3>&, std::size_t k, float max_distance2,
                            PrimitiveId* ids, float* distances2);
    /// Appends all within the distance to the keys, in no order.
    void (*within)(const Scene&, const Vec<float, 3>&, float max_distance2, NearKeys& keys);
};
/// The kernels of points.
struct AllPointKernels {
    PointKernels<WideScene> triangles;
    PointKernels<WidePoints> points;
    ClosestKernels<WideDoubles> doubles;
    /// Walks to the leaves of any primitives that a point's limit, a squared distance, lets it reach.
    void (*walk)(const WideLeaves<float>&, const Vec<float, 3>&, float limit);
    void (*walk_of_doubles)(const WideLeaves<double>&, const Vec<double, 3>&, double limit);
    /// The number of points in a solid ball, whose center and radius are within `largest_coordinate`.
    std::size_t (*points_in_ball)(const WidePoints&, const Sphere<float, 3>&);
};

/// The crossings of rays along an axis with the triangles of a WideScene or WideDoubles (SignedCrossings).
template <class Scene, class T = typename Scene::Scalar>
struct CrossingKernels {
    CrossingCount (*one)(const Scene&, const RayInBounds<T, 3>&, bool past_surface);
    /// Writes counts[i] for rays[i].
    void (*many)(const Scene&, std::span<const RayInBounds<T, 3>> rays, bool past_surface,
                 CrossingCount* counts);
};
struct AllCrossingKernels {
    CrossingKernels<WideScene> floats;
    CrossingKernels<WideDoubles> doubles;
};

/// The exact terms of other primitives than triangles of float, behind one plain call: adds those of a leaf,
/// and returns a bound of their roundings.
struct WindingLeaves {
    void* sum = nullptr;
    double (*add)(void* sum, std::uint32_t block, std::uint32_t count) = nullptr;
};
/// Clusters of which winding numbers are expanded (winding_expansion.h). `blocks` is null where `leaves` adds
/// the exact terms.
struct WideExpansion {
    const WideTree<float, 3>& tree;
    const double* rows;  // WindingRow
    const TriangleBlock<float>* blocks;
    WindingLeaves leaves = {};
};
struct WindingKernels {
    /// The winding number, without the terms that `leaves` added.
    double (*winding_number)(const WideExpansion&, const WindingQuery&);
};

/// The kernels of rays.
struct AllRayKernels {
    /// The width (children per node) that all kernels of the instruction set are best at.
    int width;
    RayKernels<Hit<float>> closest;
    RayKernels<bool> any;
    FirstHitsKernel first_hits;
};

// Where none are in use, the plain walk answers.
template <>
const AllRayKernels* in_use<AllRayKernels>();
template <>
const AllPointKernels* in_use<AllPointKernels>();
template <>
const AllCrossingKernels* in_use<AllCrossingKernels>();
template <>
const WindingKernels* in_use<WindingKernels>();

/// The width (children per node) of new indexes: what the kernels in use are best at, or 8 without kernels.
inline int preferred_wide_width() {
    const AllRayKernels* const kernels = in_use<AllRayKernels>();
    return kernels != nullptr ? kernels->width : 8;
}

}  // namespace hedgerow
