/// An engine of one's own, through the public door alone (walks/engine.h): it sorts each batch along a curve,
/// and asks brute force. Its answers have the bits of every other structure, and all of a call's queries come
/// to it at once.
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include <hedgerow/any_index.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "contract.h"
#include "lists.h"

namespace hedgerow {

/// Brute force, whose engine keeps what it needs in the index: here, what it was asked.
template <std::floating_point T, int D>
class SortingEngine : public BruteForce<T, D> {
public:
    using Options = typename BruteForce<T, D>::Options;

    template <PrimitiveSet P>
    static SortingEngine build(const P& set, const Options& options, Executor& executor) {
        SortingEngine built(BruteForce<T, D>::build(set, options, executor));
        built.asked_ = std::make_shared<Asked>();
        return built;
    }
    SortingEngine() = default;

    struct Asked {
        bool asleep = false;
        std::atomic<std::size_t> calls{0}, queries{0}, rest{0}, singles{0};
    };
    Asked& asked() const { return *asked_; }

private:
    explicit SortingEngine(BruteForce<T, D> all) : BruteForce<T, D>(std::move(all)) {}

    std::shared_ptr<Asked> asked_ = std::make_shared<Asked>();
};

/// What the engine's questions share.
template <class P>
class OwnEngine {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using I = Index<SortingEngine<T, D>, P>;

    explicit OwnEngine(const I& index) : index_(index) {}
    explicit operator bool() const { return !asked().asleep; }

protected:
    const I& index() const { return index_; }
    auto& asked() const { return index_.structure().asked(); }
    /// The answer of query Q by brute force.
    template <class Q, class... Arguments>
    auto by_force(Arguments&&... arguments) const {
        Q query(index_, arguments...);
        index_.ask(query);
        return query.answer();
    }
    /// Calls one(i) for all queries of a batch, near ones after each other: place(i) is where query i is.
    /// Every fifth is left to the walk.
    template <class Place, class One, class How, class... To>
    void in_order(std::size_t count, Place place, const How& how, One one, To... to) const {
        ++asked().calls;
        asked().queries += count;
        std::vector<std::size_t> order(count);
        std::iota(order.begin(), order.end(), std::size_t(0));
        const auto key = [&](std::size_t i) { return std::pair(place(i)[0], i); };
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
        how.executor.for_each_piece(count, 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                if (order[k] % 5 == 4)
                    ++asked().rest, how.rest(order[k], to(order[k])...);
                else
                    one(order[k]);
        });
    }

private:
    const I& index_;
};
template <class P>
using OwnIndex = Index<SortingEngine<typename P::Scalar, P::dimension>, P>;

/// Batches of closest hits, with any filter.
template <class P, class Filter>
struct EngineFor<ClosestHit<P, Filter>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    using T = typename P::Scalar;
    KernelUse answer_batch(const RayArray<T, P::dimension>& rays, Hit<T>* hits, const auto& how) const {
        this->in_order(
            rays.size(), [&](std::size_t i) { return rays[i].origin; }, how,
            [&](std::size_t i) {
                const auto filter = filter_of_ray(how.filter, i);
                hits[i] = this->template by_force<ClosestHit<P, std::remove_const_t<decltype(filter)>>>(
                    rays[i], filter);
            });
        return {.single = rays.size()};
    }
};
/// Single rays, without filters.
template <class P>
struct EngineFor<AnyHit<P>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    bool answer(const Ray<typename P::Scalar, P::dimension>& ray, const KeepAll&) const {
        ++this->asked().singles;
        return this->template by_force<AnyHit<P>>(ray);
    }
};
template <class P>
struct EngineFor<AllHits<P>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    using T = typename P::Scalar;
    void answer_lists(const RayArray<T, P::dimension>& rays, HitLists<T>& lists, const auto& how) const {
        ++this->asked().calls;
        this->asked().queries += rays.size();
        lists.clear();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (i % 5 == 4) {
                how.rest(i, lists);
                continue;
            }
            std::vector<Hit<T>> hits;
            this->template by_force<AllHits<P>>(rays[i], hits);
            lists.hits.append(hits);
            lists.offsets.push_back(lists.hits.size());
        }
    }
};
template <class P>
struct EngineFor<ClosestPoint<P>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    void answer_batch(const Strided<Vec<T, D>>& points, Near<T, D>* found, const auto& how) const {
        this->in_order(
            points.size(), [&](std::size_t i) { return points[i]; }, how,
            [&](std::size_t i) {
                found[i] = this->template by_force<ClosestPoint<P>>(points[i], NearLimits<T>(how.options, i));
            });
    }
};
template <class P>
struct EngineFor<Nearest<P>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    void answer_lists(const Strided<Vec<T, D>>& points, std::size_t k, NearLists<T>& lists,
                      const auto& how) const {
        std::vector<PrimitiveId> ids(points.size() * k);
        std::vector<T> distances2(points.size() * k);
        const auto row = [&](std::size_t i) {
            return NearRow<T>{{ids.data() + i * k, k}, {distances2.data() + i * k, k}};
        };
        this->in_order(
            points.size(), [&](std::size_t i) { return points[i]; }, how,
            [&](std::size_t i) {
                std::vector<Near<T, D>> found;
                this->template by_force<Nearest<P>>(points[i], k, NearLimits<T>(how.options, i), found);
                found.resize(k);
                for (std::size_t j = 0; j < k; ++j)
                    row(i).ids[j] = found[j].element, row(i).distances2[j] = found[j].distance2;
            },
            row);
        lists.clear();
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < k && row(i).ids[j] != no_primitive; ++j) {
                lists.ids.push_back(row(i).ids[j]);
                lists.distances2.push_back(row(i).distances2[j]);
            }
            lists.offsets.push_back(lists.ids.size());
        }
    }
};
/// Single points whose lists are written.
template <class P>
struct EngineFor<Within<P>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    using T = typename P::Scalar;
    std::size_t answer(const Vec<T, P::dimension>& point, const NearLimits<T>& limits,
                       std::vector<Near<T, P::dimension>>& found) const {
        ++this->asked().singles;
        return this->template by_force<Within<P>>(point, limits, found);
    }
};
template <class P, class R>
struct EngineFor<OverlapCount<P, R>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    void answer_batch(const Strided<R>& regions, std::size_t* counts, const auto& how) const {
        this->in_order(
            regions.size(), [&](std::size_t i) { return regions[i].low; }, how,
            [&](std::size_t i) { counts[i] = this->template by_force<OverlapCount<P, R>>(regions[i]); });
    }
};
/// Of whole sets: pairs of triangles, each with each.
template <class P>
struct EngineFor<CrossingPairs, OwnIndex<P>, OwnIndex<P>> {
    const OwnIndex<P>&a, &b;

    EngineFor(const OwnIndex<P>& first, const OwnIndex<P>& second) : a(first), b(second) {}
    explicit operator bool() const { return !a.structure().asked().asleep; }
    void answer_whole(std::vector<ElementPair>& found, Executor&) const {
        ++a.structure().asked().calls;
        const auto in_double = [](const auto& t) {
            return Triangle<double, 3>{Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)};
        };
        for (PrimitiveId i = 0; i < a.size(); ++i)
            for (PrimitiveId j = 0; j < b.size(); ++j)
                if (triangles_meet(in_double(a.primitives().triangle(i)),
                                   in_double(b.primitives().triangle(j))))
                    found.push_back({i, j});
    }
};
/// Of solids.
template <class P>
struct EngineFor<Sides, Solid<OwnIndex<P>>> {
    const Solid<OwnIndex<P>>& solid;

    explicit EngineFor(const Solid<OwnIndex<P>>& of) : solid(of) {}
    explicit operator bool() const { return !solid.index().structure().asked().asleep; }
    void answer_batch(const Strided<Vec<typename P::Scalar, 3>>& points, Side* sides, const auto& how) const {
        ++solid.index().structure().asked().calls;
        solid.index().structure().asked().queries += points.size();
        for (std::size_t i = 0; i < points.size(); ++i) how.rest(i);
        for (std::size_t i = 0; i < points.size(); i += 2) sides[i] = side(solid, points[i]);
    }
};
/// Where an index is an instance.
template <class P>
struct EngineFor<ClosestHit<InstanceSetView<OwnIndex<P>>>, OwnIndex<P>> : OwnEngine<P> {
    using OwnEngine<P>::OwnEngine;
    template <class Q>
    Flow offer_inside(Ray<typename P::Scalar, 3> ray, std::uint32_t instance, std::uint32_t, Q& query) const {
        ++this->asked().singles;
        ray.t_max = query.limit();
        const auto hit = this->template by_force<ClosestHit<P>>(ray);
        return hit ? query.offer({hit.t, hit.u, hit.v, hit.element, instance}) : Flow::go_on;
    }
};

}  // namespace hedgerow

using namespace hedgerow;

namespace {

/// A scene, an index with the engine, and another structure's.
struct OwnEngineTest : testing::Test {
    TriangleMesh<float> mesh = teapot<float>(600);
    Index<SortingEngine<float, 3>, TriangleMeshView<float>> index = build<SortingEngine>(mesh);
    Index<Bvh<float, 3>, TriangleMeshView<float>> oracle = build<Bvh>(mesh);
    contract::Questions<float, 3> questions{oracle, 10000};

    auto& asked() { return index.structure().asked(); }
    /// Expects that one call brought all queries of a batch, of which every fifth was left to a walk.
    void expect_whole(std::size_t queries) {
        EXPECT_EQ(asked().calls, 1u);
        EXPECT_EQ(asked().queries, queries);
        asked().calls = 0, asked().queries = 0;
    }
    void expect_not_asked() { EXPECT_EQ(asked().calls, 0u); }
};

const auto every_third = [](std::size_t i, const auto& found) { return (found.element + i) % 3 == 0; };

TEST_F(OwnEngineTest, GetsBatchesWholeWithFiltersAndWithoutElements) {
    const auto& rays = questions.rays;
    std::vector<Hit<float>> hits(rays.size()), expected(rays.size());
    std::vector<PrimitiveId> own(rays.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<PrimitiveId>(i % mesh.size());

    EXPECT_EQ(closest_hits(index, rays, hits).single, rays.size());
    expect_whole(rays.size());
    EXPECT_GT(asked().rest, 0u);
    closest_hits(oracle, rays, expected);
    EXPECT_EQ(hits, expected);

    closest_hits(index, rays, hits, {.leave_out = own, .threads = 3}, every_third);
    expect_whole(rays.size());
    closest_hits(oracle, rays, expected, {.leave_out = own}, every_third);
    EXPECT_EQ(hits, expected);
    std::vector<std::uint32_t> bits(mesh.size());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = 1u << i % 3;
    closest_hits(index, rays, hits, {.mask = {bits, 0x3}});
    expect_whole(rays.size());
    closest_hits(oracle, rays, expected, {.mask = {bits, 0x3}});
    EXPECT_EQ(hits, expected);
}

TEST_F(OwnEngineTest, AnswersPointsListsAndRegions) {
    const auto& points = questions.points;
    std::vector<PrimitiveId> own(points.size());
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = closest_point(oracle, points[i]).element;
    std::vector<Near<float, 3>> found(points.size()), expected(points.size());
    closest_points(index, points, found, {.radius = 0.5, .leave_out = own});
    expect_whole(points.size());
    closest_points(oracle, points, expected, {.radius = 0.5, .leave_out = own});
    EXPECT_EQ(found, expected);

    EXPECT_EQ(nearest(index, points, 4, {.leave_out = own}), nearest(oracle, points, 4, {.leave_out = own}));
    expect_whole(points.size());
    std::vector<std::uint32_t> bits(mesh.size(), 0x1);
    bits[7] = bits[9] = 0x2;
    EXPECT_EQ(nearest(index, points, 4, {.mask = {bits, 0x6}}),
              nearest(oracle, points, 4, {.mask = {bits, 0x6}}));
    expect_whole(points.size());
    EXPECT_EQ(all_hits(index, questions.rays), all_hits(oracle, questions.rays));
    expect_whole(questions.rays.size());

    std::vector<std::size_t> counts(questions.boxes.size()), as_many(questions.boxes.size());
    overlap_counts(index, questions.boxes, counts);
    expect_whole(questions.boxes.size());
    overlap_counts(oracle, questions.boxes, as_many);
    EXPECT_EQ(counts, as_many);
}

TEST_F(OwnEngineTest, AnswersSingleProbes) {
    for (const auto& ray : questions.rays) ASSERT_EQ(any_hit(index, ray), any_hit(oracle, ray));
    EXPECT_EQ(asked().singles, questions.rays.size());
    asked().singles = 0;
    for (const auto& p : questions.points) ASSERT_EQ(within(index, p, 0.2), within(oracle, p, 0.2));
    EXPECT_EQ(asked().singles, questions.points.size());
}

TEST_F(OwnEngineTest, IsNotAskedWhatItsTypeCannotTake) {
    const auto& points = questions.points;
    std::vector<Near<float, 3>> found(points.size()), expected(points.size());
    // Filters of points, counts of visits, and what it has no specialisation for.
    closest_points(index, points, found, every_third);
    closest_points(oracle, points, expected, every_third);
    EXPECT_EQ(found, expected);
    std::vector<Visits> visits(questions.rays.size());
    std::vector<Hit<float>> hits(visits.size());
    closest_hits(index, questions.rays, hits, {}, KeepAll(), visits);
    EXPECT_EQ(visits[0].primitives, mesh.size());
    EXPECT_EQ(within(index, points, 0.2), within(oracle, points, 0.2));  // each alone
    expect_not_asked();
}

TEST_F(OwnEngineTest, MayBeAsleep) {
    asked().asleep = true;
    std::vector<Hit<float>> hits(questions.rays.size()), expected(hits.size());
    closest_hits(index, questions.rays, hits);
    closest_hits(oracle, questions.rays, expected);
    EXPECT_EQ(hits, expected);
    expect_not_asked();
    EXPECT_EQ(asked().queries, 0u);
}

TEST_F(OwnEngineTest, MovesWithItsIndex) {
    auto* const before = &asked();
    const auto moved = std::move(index);
    EXPECT_EQ(&moved.structure().asked(), before);
    EXPECT_FALSE(closest_hit(index, questions.rays[0]));  // NOLINT(bugprone-use-after-move): empty now
}

TEST_F(OwnEngineTest, AnswersWholeSetsAndSolids) {
    auto turned = mesh;
    for (auto& v : turned.vertices) v = Vec3f(v[1], v[0], v[2]);
    const auto b = build<SortingEngine>(turned);
    EXPECT_EQ(crossing_pairs(index, b), crossing_pairs(oracle, build<Bvh>(turned)));
    expect_whole(0);

    const Solid solid(index);
    const Solid of_oracle(oracle);
    std::vector<Side> found(questions.points.size()), expected(found.size());
    sides(solid, questions.points, found);
    expect_whole(found.size());
    sides(of_oracle, questions.points, expected);
    EXPECT_EQ(found, expected);
}

TEST_F(OwnEngineTest, AnswersInsideOfInstances) {
    const Transform<3> moved = Transform<3>::translation({4, 1, 0});
    const InstanceSet ours{Instance(index), Instance(index, moved)};
    const InstanceSet theirs{Instance(oracle), Instance(oracle, moved)};
    const auto world = build<Bvh>(ours);
    const auto same = build<Bvh>(theirs);
    for (const auto& ray : questions.rays) ASSERT_EQ(closest_hit(world, ray), closest_hit(same, ray));
    EXPECT_GT(asked().singles, 0u);
}

// What the wide BVH's kernels take, as its types tell.
using Mesh = TriangleMeshView<float>;
using WideMesh = Index<WideBvh<float, 3>, Mesh>;
static_assert(AnswersOne<EngineFor<ClosestHit<Mesh>, WideMesh>, Ray3f, KeepAll>);
static_assert(AnswersBatch<EngineFor<AnyHit<Mesh, Except>, WideMesh>, RayArray<float, 3>, bool*,
                           HowAsked<RayOptions, Except>>);
static_assert(AnswersOne<EngineFor<Nearest<Mesh>, WideMesh>, const Vec3f, const std::size_t,
                         NearLimits<float>, std::vector<Near<float, 3>>>);
static_assert(AnswersOne<EngineFor<Within<Mesh>, WideMesh>, const Vec3f, const NearLimits<float>,
                         std::vector<Near<float, 3>>>);
using Any = AnyIndex<float, 3>;
static_assert(AnswersOne<EngineFor<AllHits<Any>, Any>, const Ray3f, std::vector<Hit<float>>, const KeepAll>);
static_assert(AnswersOne<EngineFor<Nearest<Any>, Any>, const Vec3f, const std::size_t,
                         const NearLimits<float>, std::vector<Near<float, 3>>>);
static_assert(
    AnswersOne<EngineFor<Overlapping<Any, Box3f>, Any>, const Box3f, std::vector<PrimitiveId>, Finds>);
static_assert(!Engine<EngineFor<ClosestPoint<Mesh, Except>, WideMesh>>);
static_assert(!Engine<EngineFor<ClosestHit<Mesh>, Index<Bvh<float, 3>, Mesh>>>);

}  // namespace
