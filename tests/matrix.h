/// The parts of the test matrix: structures, rays of every kind, and the comparison with brute force.
#pragma once

#include <memory>
#include <span>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <hedgerow/questions.h>
#include <hedgerow/scenes/random.h>

#include "long_runs.h"
#include "structure_names.h"

namespace hedgerow::matrix {

/// Structures with their builders and options, by their names in space.
inline constexpr const char* fast_structures[] = {"wide",
                                                  "wide:width=4",
                                                  "wide:width=16,builder=fast,max_leaf_size=1",
                                                  "bvh",
                                                  "bvh:builder=sweep",
                                                  "bvh:builder=midpoint",
                                                  "bvh:builder=equal-counts",
                                                  "bvh:builder=lbvh",
                                                  "bvh:builder=ploc",
                                                  "bvh:builder=agglomerative",
                                                  "bvh:builder=ploc,reinsertion=3",
                                                  "bvh:builder=spatial-splits",
                                                  "kdtree",
                                                  "kdtree:builder=binned",
                                                  "grid",
                                                  "two-level-grid",
                                                  "octree",
                                                  "bsp"};
/// Those that show or stress something, and are slow on large scenes.
inline constexpr const char* slow_structures[] = {
    "bvh:ordered=off,culling=off",
    "bvh:max_leaf_size=1",
    "bvh:builder=spatial-splits,overlap=0,duplicates=3,max_leaf_size=1",
    "kdtree:builder=median",
    "kdtree:builder=midpoint,leaf_size=1",
    "kdtree:mailbox=off,intersection_cost=100",
    "grid:resolution=3",
    "grid:resolution=40,insert=box",
    "grid:heuristic=roots,mailbox=off,skip_empty=off",
    "two-level-grid:resolution=2,inner_density=10",
    "octree:leaf_size=1",
    "bsp:samples=4,intersection_cost=20,plane_cost=1",
    "octree:max_depth=3,mailbox=off",
    "brute-force:box=on",
    "bvh:volume=sphere",
    "bvh:volume=obb,max_leaf_size=1",
    "bvh:volume=kdop6",
    "bvh:volume=kdop14,builder=ploc",
    "bvh:volume=kdop18",
    "bvh:volume=kdop26",
    "bvh:volume=cylinder",
    "bvh:volume=hull,builder=agglomerative"};

/// All of these.
inline const std::vector<const char*> structures = [] {
    std::vector<const char*> all(std::begin(fast_structures), std::end(fast_structures));
    all.insert(all.end(), std::begin(slow_structures), std::end(slow_structures));
    return all;
}();
inline constexpr const char* structures_of_points[] = {
    "point-kdtree", "point-octree",        "point-octree:leaf_size=1", "point-octree:max_depth=3",
    "hash-grid",    "hash-grid:cell=0.01", "hash-grid:cell=1e-9",      "hash-grid:cell=7"};

/// The spec for sets of P: `spec` itself in space, the corresponding structure or volume in the plane.
template <class P>
std::string named_for(std::string spec) {
    if (P::dimension == 3) return spec;
    for (const auto& [space, plane] : {std::pair<std::string, std::string>{"octree", "quadtree"},
                                       {"kdop6", "kdop4"},
                                       {"kdop14", "kdop8"},
                                       {"kdop18", "kdop8"},
                                       {"kdop26", "kdop8"},
                                       {"cylinder", "sphere"},
                                       {"hull", "obb"}})
        if (const auto at = spec.find(space); at != std::string::npos) spec.replace(at, space.size(), plane);
    return spec;
}

template <class T, int D>
using Points = std::vector<Vec<T, D>>;

template <class T, int D>
Vec<T, D> point_in(const Box<T, D>& box, double beyond, Random& random) {
    Vec<T, D> p;
    for (int k = 0; k < D; ++k) {
        const double low = static_cast<double>(box.low[k]), extent = static_cast<double>(box.high[k]) - low;
        p[k] = static_cast<T>(low - beyond * extent + random.uniform() * extent * (1 + 2 * beyond));
    }
    return p;
}

/// What is particular about a ray of a scene.
struct RayCase {
    bool far_origin = false;      ///< up to two sizes of the scene away
    bool at_target = false;       ///< aims exactly at a target: a vertex, the middle of an edge
    bool from_target = false;     ///< starts exactly on one
    bool from_afar = false;       ///< starts a thousand sizes of the scene away
    bool along_axis = false;      ///< other components are 0, −0 or the least subnormal
    bool through_target = false;  ///< along an axis, and through a target
    int component = 0;            ///< which of these
    bool short_direction = false, long_direction = false;
    bool begins_late = false, ends_early = false;

    /// The case of ray i.
    static RayCase of(std::uint64_t i) {
        return {.far_origin = i % 3 == 0,
                .at_target = i % 4 == 1,
                .from_target = i % 16 == 5,
                .from_afar = i % 64 == 7,
                .along_axis = i % 8 == 2,
                .through_target = i % 16 == 2,
                .component = static_cast<int>(i / 8 % 3),
                .short_direction = i % 32 == 9,
                .long_direction = i % 32 == 11,
                .begins_late = i % 32 == 13,
                .ends_early = i % 32 == 15};
    }
    std::string name() const {
        std::string all;
        for (const auto& [is, what] :
             {std::pair(far_origin, "from far"), std::pair(at_target, "at a target"),
              std::pair(from_target, "from a target"), std::pair(from_afar, "from afar"),
              std::pair(along_axis, "along an axis"), std::pair(through_target, "through a target"),
              std::pair(short_direction, "with a short direction"),
              std::pair(long_direction, "with a long direction"), std::pair(begins_late, "that begins late"),
              std::pair(ends_early, "that ends early")})
            if (is) all += (all.empty() ? "" : ", ") + std::string(what);
        return all.empty() ? "of no special kind" : all;
    }
};

/// Ray i of a scene, of the case of its number.
template <class T, int D>
Ray<T, D> ray_of(const Box<T, D>& box, const Points<T, D>& targets, std::uint64_t i) {
    const RayCase is = RayCase::of(i);
    Random random(3, i);
    const auto any_target = [&] { return targets[random.bits() % targets.size()]; };
    Ray<T, D> ray;
    // Choose the origin and the point to aim at.
    ray.origin = point_in(box, is.far_origin ? 2.0 : 0.1, random);
    const Vec<T, D> target = is.at_target ? any_target() : point_in(box, 0.0, random);
    if (is.from_target) ray.origin = any_target();
    if (is.from_afar) ray.origin = ray.origin + Vec<T, D>::all(T(1000) * length(box.extent()));
    ray.direction = target - ray.origin;
    if (is.along_axis) {
        constexpr T small[] = {T(0), T(-0.0), std::numeric_limits<T>::denorm_min()};
        const int axis = static_cast<int>(random.bits() % D);
        for (int k = 0; k < D; ++k)
            if (k != axis) ray.direction[k] = small[is.component];
        if (is.through_target) {
            ray.origin = any_target();
            ray.origin[axis] -= ray.direction[axis];
        }
    }
    if (is.short_direction) ray.direction = ray.direction * T(1e-20);
    if (is.long_direction) ray.direction = ray.direction * T(1e15);
    if (is.begins_late) ray.t_min = T(0.5);
    if (is.ends_early) ray.t_max = T(1);
    return ray;
}
/// A query, by its number, for a message: of a ray its case, and the ray in hexadecimal numbers.
template <class Given>
std::string described(const Given&, std::uint64_t i) {
    return "query " + std::to_string(i);
}
template <class T, int D>
std::string described(const Ray<T, D>& ray, std::uint64_t i) {
    std::ostringstream out;
    out << "ray " << i << ", " << RayCase::of(i).name() << std::hexfloat << ": {{";
    for (int k = 0; k < D; ++k) out << (k > 0 ? ", " : "") << ray.origin[k];
    out << "}, {";
    for (int k = 0; k < D; ++k) out << (k > 0 ? ", " : "") << ray.direction[k];
    out << "}, " << ray.t_min << ", " << ray.t_max << "}";
    return out.str();
}
template <class T, int D>
std::string described(const HitsAlong<T, D>& along, std::uint64_t i) {
    return std::to_string(along.k) + " hits of " + described(along.ray, i);
}

template <class T, int D>
using Indexes = std::vector<std::unique_ptr<AnyIndex<T, D>>>;

/// The answers of an index to a question, for each that is given. `some` queries are one task.
template <class Question, class Index>
std::unique_ptr<typename Question::Answer[]> answers_of(const Index& index,
                                                        std::span<const typename Question::Given> given,
                                                        std::size_t some) {
    std::unique_ptr<typename Question::Answer[]> answers(new typename Question::Answer[given.size()]);
    default_executor().for_each_piece(given.size(), some, [&](std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        if constexpr (AsksMany<Question>) {
            Question::ask_all(index, given.subspan(begin, count), std::span(answers.get() + begin, count));
        } else {
            // An index may answer by another way where visits are not counted.
            Visits visits;
            for (std::size_t i = begin; i < end; ++i)
                if constexpr (requires { Question::ask(index, given[i], answers[i]); })
                    i % 2 == 0 ? Question::ask(index, given[i], answers[i])
                               : Question::ask(index, given[i], answers[i], visits);
                else
                    Question::ask(index, given[i], answers[i], visits);
        }
    });
    return answers;
}

/// Compares the answers of all other indexes with those of the first. `first` is the number of the first
/// query, and `stride` the distance to the next.
template <class Question, class T, int D>
void expect_equal_answers(const Indexes<T, D>& indexes, const std::vector<typename Question::Given>& given,
                          std::size_t some, std::size_t first = 0, std::size_t stride = 1) {
    if (!answers<Question>(*indexes[0])) return;
    const auto want = answers_of<Question>(*indexes[0], given, some);
    for (std::size_t s = 1; s < indexes.size(); ++s) {
        if (!answers<Question>(*indexes[s])) continue;
        const auto got = answers_of<Question>(*indexes[s], given, some);
        for (std::size_t i = 0; i < given.size(); ++i)
            ASSERT_EQ(want[i], got[i]) << indexes[s]->structure() << ": " << Question::words << ", "
                                       << described(given[i], first + i * stride);
    }
}

/// Rays, the numbers of hits to find, and places to go on from: the start, a hit of the first index, or the
/// place before or after that hit.
template <class T, int D>
std::vector<HitsAlong<T, D>> hits_along(const AnyIndex<T, D>& index, const std::vector<Ray<T, D>>& rays) {
    constexpr std::size_t counts[] = {1, 2, 3, 8, 100, 0};
    std::vector<HitsAlong<T, D>> all;
    std::vector<Hit<T>> hits;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        HitsAlong<T, D> given{rays[i], counts[i % std::size(counts)]};
        all_hits(index, rays[i], hits);
        if (i % 4 != 0 && !hits.empty()) {
            given.after = hits[i % hits.size()];
            given.after.element += i % 4 == 1 ? 1u : 0u;
            given.after.element -= i % 4 == 2 && given.after.element > 0 ? 1u : 0u;
        }
        all.push_back(given);
    }
    return all;
}

/// Compares all other indexes with the first, on rays `begin` to `end` of the scene. Questions that are asked
/// one by one get every eighth.
template <class T, int D>
void expect_equal_rays(const Indexes<T, D>& indexes, const Points<T, D>& targets, std::size_t begin,
                       std::size_t end) {
    constexpr std::size_t at_once = 1 << 16;
    for (; begin < end; begin += at_once) {
        std::vector<Ray<T, D>> rays(std::min(at_once, end - begin)), eighth;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            rays[i] = ray_of(indexes[0]->bounds(), targets, begin + i);
            if (i % 8 == 0) eighth.push_back(rays[i]);
        }
        for_each_question<T, D>([&]<class Question>(Question) {
            if constexpr (std::same_as<typename Question::Given, Ray<T, D>>) {
                constexpr bool all = AsksMany<Question>;
                if (!testing::Test::HasFatalFailure())
                    expect_equal_answers<Question>(indexes, all ? rays : eighth, 256, begin, all ? 1 : 8);
            } else if constexpr (std::same_as<typename Question::Given, HitsAlong<T, D>>) {
                if (!testing::Test::HasFatalFailure())
                    expect_equal_answers<Question>(indexes, hits_along(*indexes[0], eighth), 256, begin, 8);
            }
        });
        if (testing::Test::HasFatalFailure()) return;
        // A ray hits something exactly if it has a closest hit.
        const std::span some(rays.data(), std::min<std::size_t>(rays.size(), 1024));
        const auto closest = answers_of<AskClosestHit<T, D>>(*indexes[0], some, 256);
        const auto any = answers_of<AskAnyHit<T, D>>(*indexes[0], some, 256);
        for (std::size_t i = 0; i < some.size(); ++i)
            ASSERT_EQ(bool(closest[i]), any[i]) << described(some[i], begin + i);
    }
}

/// `count` points, boxes and balls in and around a scene, as questions take them.
template <class T, int D>
struct Regions {
    std::vector<Vec<T, D>> points;
    std::vector<Neighbours<T, D>> neighbours;  ///< 0 to 19 of a point
    std::vector<Ball<T, D>> balls;
    std::vector<Box<T, D>> boxes;
    std::vector<Sphere<T, D>> solid_balls;  ///< some of them empty, points or all of space

    Regions(const AnyIndex<T, D>& index, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            Random random(9, i);
            points.push_back(point_in(index.bounds(), i % 2 == 0 ? 0.0 : 3.0, random));
            neighbours.push_back({points[i], i % 20});
            boxes.emplace_back();
            for (int corner = 0; corner < 2; ++corner) boxes[i].expand(point_in(index.bounds(), 0.2, random));
        }
        // Six radii from twice the scene's diagonal down, each by a factor of 2^1.5 smaller. Then exactly the
        // distance of the closest point.
        const auto closest = answers_of<AskClosestPoint<T, D>>(index, points, 16);
        const T extent = length(index.bounds().extent());
        for (std::size_t i = 0; i < count; ++i)
            balls.push_back({points[i], i % 7 == 6 ? closest[i].distance2
                                                   : extent * extent * std::ldexp(T(4), -3 * int(i % 7))});
        constexpr T radii[] = {T(0), T(-1), std::numeric_limits<T>::infinity(),
                               std::numeric_limits<T>::quiet_NaN()};
        for (std::size_t i = 0; i < count; ++i)
            solid_balls.push_back(
                {points[i], i / 4 % 8 < 4 && i % 4 == 0 ? radii[i / 4 % 8] : std::sqrt(balls[i].radius2)});
    }
    template <class Given>
    const std::vector<Given>& given() const {
        if constexpr (std::same_as<Given, Vec<T, D>>)
            return points;
        else if constexpr (std::same_as<Given, Neighbours<T, D>>)
            return neighbours;
        else if constexpr (std::same_as<Given, Ball<T, D>>)
            return balls;
        else if constexpr (std::same_as<Given, Sphere<T, D>>)
            return solid_balls;
        else
            return boxes;
    }
};

/// Compares all other indexes with the first, on `count` points, boxes and balls. Questions that share the
/// walk of another one get every fourth.
template <class T, int D>
void expect_equal_regions(const Indexes<T, D>& indexes, std::size_t count) {
    const Regions<T, D> regions(*indexes[0], count);
    for_each_question<T, D>([&]<class Question>(Question) {
        using Given = typename Question::Given;
        if constexpr (!detail::is_ray<Given>) {
            constexpr bool every = Question::name == "closest-point" || Question::name == "nearest" ||
                                   Question::name == "within" || Question::name == "overlap";
            const std::size_t stride = every && !AsksFacets<Question> ? 1 : 4;
            const auto& all = regions.template given<Given>();
            std::vector<Given> some;
            for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
            if (!testing::Test::HasFatalFailure())
                expect_equal_answers<Question>(indexes, some, 16, 0, stride);
        }
    });
}

/// Compares every structure over a set with brute force, on every query.
template <class P>
void expect_equal(const char* name, const P& set, const Points<typename P::Scalar, P::dimension>& targets) {
    SCOPED_TRACE(name);
    Indexes<typename P::Scalar, P::dimension> indexes;
    indexes.push_back(build_any("brute-force", set));
    const auto add = [&](std::span<const char* const> specs) {
        for (const char* spec : specs) {
            indexes.push_back(build_any(named_for<P>(spec), set));
            EXPECT_EQ(indexes.back()->validate(), "") << spec;
        }
    };
    add(structures);
    if constexpr (PointSet<ViewOf<P>>) add(structures_of_points);
    if (set.size() > 0) expect_equal_regions(indexes, in_long_runs(1000, 200));
    if (targets.empty()) return;
    // Compare all structures on some rays, and in long runs the fast ones on many more.
    const std::size_t for_all = in_long_runs(100000, 1500);
    expect_equal_rays(indexes, targets, 0, for_all);
    indexes.resize(1 + std::size(fast_structures));
    expect_equal_rays(indexes, targets, for_all, in_long_runs(1000000, for_all));
}

/// The vertices, and the middle of each triangle's first edge.
template <class T>
Points<T, 3> targets_of(const TriangleMesh<T>& mesh) {
    auto targets = mesh.vertices;
    for (const auto& t : mesh.triangles)
        targets.push_back(mesh.vertices[t[0]] * T(0.5) + mesh.vertices[t[1]] * T(0.5));
    return targets;
}

template <class T>
void expect_equal(const char* name, const TriangleMesh<T>& mesh) {
    expect_equal(name, mesh, targets_of(mesh));
}

}  // namespace hedgerow::matrix
