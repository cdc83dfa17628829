/// Rays made of NaN, infinities, zeros and numbers at the ends of the range: every kernel, structure and
/// level answers like brute force. Reads out of bounds are for sanitizers to find.
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "engine.h"
#include "placements.h"

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
constexpr T nan_of = std::numeric_limits<T>::quiet_NaN();

/// A random choice of numbers that few rays have.
template <class T>
T nasty(Random& random) {
    using limits = std::numeric_limits<T>;
    const T all[] = {T(0),
                     T(-0.0),
                     limits::denorm_min(),
                     limits::min(),
                     -8 * limits::min(),
                     limits::min() / unit_roundoff<T>,
                     unit_roundoff<T>,
                     T(1),
                     T(-1),
                     largest_coordinate<T>,
                     -limits::max(),
                     limits::infinity(),
                     -limits::infinity(),
                     nan_of<T>};
    return all[random.bits() % std::size(all)];
}

/// Rays of every kind in which some numbers, mostly of the direction, are replaced by nasty ones.
template <class T, int D>
std::vector<Ray<T, D>> hostile_rays(const Box<T, D>& box, const Points<T, D>& targets, std::size_t count) {
    std::vector<Ray<T, D>> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(31, i);
        Ray<T, D> ray = ray_of(box, targets, i);
        for (int k = 0; k < D; ++k) {
            if (random.bits() % 2 == 0) ray.direction[k] = nasty<T>(random);
            if (random.bits() % 16 == 0) ray.origin[k] = nasty<T>(random);
        }
        if (i % 32 == 17) ray.direction = Vec<T, D>::all(nan_of<T>);
        if (i % 16 == 3) ray.t_min = nasty<T>(random);
        if (i % 16 == 7) ray.t_max = nasty<T>(random);
        rays.push_back(ray);
    }
    return rays;
}

/// Replaces one ray in every `apart` by a hostile one. The other rays are coherent, so that packets are made.
std::vector<Ray3f> with_hostile_among(std::vector<Ray3f> rays, std::span<const Ray3f> hostile,
                                      std::size_t apart) {
    for (std::size_t i = 0; i < rays.size(); i += apart) rays[i] = hostile[i % hostile.size()];
    return rays;
}

template <class Index>
std::vector<Hit<typename Index::Scalar>> closest_of(
    const Index& index, std::span<const Ray<typename Index::Scalar, Index::dimension>> rays) {
    std::vector<Hit<typename Index::Scalar>> hits;
    for (const auto& ray : rays) hits.push_back(closest_hit(index, ray));
    return hits;
}

template <class H>
std::size_t hits_among(const std::vector<H>& hits) {
    return static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [](const H& hit) { return bool(hit); }));
}

TEST(HostileRays, ByEveryKernel) {
    const auto mesh = teapot_in_stadium<float>(1000);
    const auto brute = build<BruteForce>(mesh);
    const auto targets = targets_of(mesh);
    const auto hostile = hostile_rays(brute.bounds(), targets, in_long_runs(100000, 2000));
    const auto coherent = together(brute.bounds(), 2048);
    for (const auto& rays :
         {hostile, with_hostile_among(coherent, hostile, 1000), with_hostile_among(coherent, hostile, 80),
          with_hostile_among(coherent, hostile, 7)}) {
        const auto want = closest_of(brute, std::span(rays));
        ASSERT_GT(hits_among(want), rays.size() / 16);
        for_each_kernel(
            mesh, [&](const auto& index, std::string_view) { expect_hits(want, Answers(index, rays)); });
    }
}

template <class P>
void expect_equal_of_every_structure(const P& set) {
    using T = typename P::Scalar;
    const auto brute = build<BruteForce>(set);
    Points<T, P::dimension> targets;
    for (std::size_t i = 0; i < set.size(); i += 7) targets.push_back(set.view().bounds(i).center());
    const auto rays = hostile_rays(brute.bounds(), targets, in_long_runs(20000, 600));
    const auto want = closest_of(brute, std::span(rays));
    EXPECT_GT(hits_among(want), rays.size() / 16);
    for (const auto* const name : structures) {
        SCOPED_TRACE(name);
        const auto index = build_any(named_for<P>(name), set);
        std::vector<Hit<T>> hits(rays.size());
        const std::unique_ptr<bool[]> any(new bool[rays.size()]);
        closest_hits(*index, rays, hits);
        any_hits(*index, rays, {any.get(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(want[i], hits[i]) << "ray " << i;
            ASSERT_EQ(bool(want[i]), any[i]) << "any, ray " << i;
        }
    }
}

TEST(HostileRays, ByEveryStructure) {
    expect_equal_of_every_structure(teapot<float>(200));
    expect_equal_of_every_structure(teapot<double>(200));
    expect_equal_of_every_structure(spheres<double>(100));
    expect_equal_of_every_structure(segments2d<float>(200));
}

/// An index over one set, and an instance of it for each transform.
template <template <class, int> class Inner, class P>
struct Placements {
    IndexOf<Inner, P> index;
    InstanceSet<decltype(index)> instances;

    Placements(const P& set, const std::vector<Transform<P::dimension>>& transforms)
        : index(build<Inner>(set)), instances(all(index, transforms)) {}

    template <class I>
    static std::vector<Instance<I>> all(const I& of, const std::vector<Transform<P::dimension>>& transforms) {
        std::vector<Instance<I>> placed;
        placed.reserve(transforms.size());
        for (const auto& t : transforms) placed.emplace_back(of, t);
        return placed;
    }
};

template <class H, class Index, class Rays>
void expect_hits_of(const char* name, const std::vector<H>& want, const Index& index, const Rays& rays) {
    for (const auto set : instruction_sets()) {
        SCOPED_TRACE(std::string(name) + ", " + std::string(set));
        const Using use(set);
        std::vector<H> hits(rays.size());
        const std::unique_ptr<bool[]> any(new bool[rays.size()]);
        closest_hits(index, rays, hits);
        any_hits(index, rays, {any.get(), rays.size()});
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(want[i], hits[i]) << "ray " << i << ": t " << want[i].t << " and " << hits[i].t;
            ASSERT_EQ(bool(want[i]), any[i]) << "any, ray " << i;
        }
    }
}

/// Compares two-level indexes of many kinds with brute force over brute force.
template <template <class, int> class Inner, class P, class Rays>
void expect_equal_of_instances(const P& set, const std::vector<Transform<P::dimension>>& transforms,
                               const Rays& rays) {
    const Placements<BruteForce, P> brute(set, transforms);
    const auto oracle = build<BruteForce>(brute.instances);
    const auto want = closest_of(oracle, std::span(std::as_const(rays)));
    EXPECT_GT(hits_among(want), rays.size() / 32);
    expect_hits_of("bvh over brute force", want, build<Bvh>(brute.instances), rays);
    const Placements<Inner, P> placed(set, transforms);
    expect_hits_of("wide", want, build<WideBvh>(placed.instances), rays);
    expect_hits_of("bvh", want, build<Bvh>(placed.instances), rays);
    expect_hits_of("kdtree", want, build<KdTree>(placed.instances), rays);
    expect_hits_of("grid", want, build<Grid>(placed.instances), rays);
    expect_hits_of("brute force", want, build<BruteForce>(placed.instances), rays);
}

template <class P>
Box<typename P::Scalar, P::dimension> world_of(const P& set,
                                               const std::vector<Transform<P::dimension>>& transforms) {
    return build<BruteForce>(Placements<BruteForce, P>(set, transforms).instances).bounds();
}

template <class P>
Points<typename P::Scalar, P::dimension> middles_of(const P& set,
                                                    const std::vector<Transform<P::dimension>>& transforms) {
    Points<typename P::Scalar, P::dimension> all;
    for (const auto& t : transforms)
        for (std::size_t i = 0; i < set.size(); i += 9)
            all.push_back(transformed(t.there(), set.view().bounds(i).center()));
    return all;
}

template <template <class, int> class Inner, class P>
void expect_hostile_rays_against_instances(const P& set) {
    const auto placed = transforms<P::dimension>(12, Scales::any, 20);
    const auto rays = hostile_rays(world_of(set, placed), middles_of(set, placed), in_long_runs(10000, 800));
    expect_equal_of_instances<Inner>(set, placed, rays);
}

TEST(HostileRays, AgainstInstances) {
    expect_hostile_rays_against_instances<WideBvh>(teapot<float>(60));
    expect_hostile_rays_against_instances<WideBvh>(teapot<double>(60));
    expect_hostile_rays_against_instances<Grid>(segments2d<double>(60));
}

/// Short directions, down to those that round to zero. All levels agree on where hits end.
template <template <class, int> class Inner, class P>
void expect_short_directions_against_instances(const P& set) {
    using T = typename P::Scalar;
    const auto placed = transforms<P::dimension>(12, Scales::any, 20);
    const auto box = world_of(set, placed);
    const auto middles = middles_of(set, placed);
    std::vector<Ray<T, P::dimension>> rays;
    for (std::size_t i = 0; i < in_long_runs(30000, 3000); ++i) {
        Random random(32, i);
        // Aim at a point of the scene or the middle of a primitive.
        const auto target = i % 2 == 0 ? point_in(box, 0.0, random) : middles[random.bits() % middles.size()];
        // Half of the origins are near the target, because t of a far target may be larger than any T.
        Ray<T, P::dimension> ray{target, {}};
        if (i % 4 < 2) ray.origin += Vec<T, P::dimension>(random.template in_cube<P::dimension>());
        if (i % 4 >= 2) ray.origin = point_in(box, 1.0, random);
        // Give the direction a length near the smallest that T has.
        const auto way = normalized(Vec<double, P::dimension>(target - ray.origin));
        const int shorter = static_cast<int>(random.bits() % (i % 3 == 0 ? 80 : 20)) - 8;
        const double unit = std::ldexp(1.0, std::numeric_limits<T>::min_exponent + shorter);
        ray.direction = Vec<T, P::dimension>(way * unit);
        rays.push_back(ray);
    }
    expect_equal_of_instances<Inner>(set, placed, rays);
}

TEST(HostileRays, ShortDirectionsAgainstInstances) {
    expect_short_directions_against_instances<WideBvh>(teapot<float>(60));
    expect_short_directions_against_instances<WideBvh>(teapot<double>(60));
    expect_short_directions_against_instances<Grid>(segments2d<double>(60));
    expect_short_directions_against_instances<KdTree>(spheres<float>(60));
}

}  // namespace
