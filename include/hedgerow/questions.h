/// The table of questions: all that an AnyIndex can be asked. Comparisons and the matrix of tests go
/// through it, so a question in the table is measured on every structure and compared with brute force.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include <hedgerow/any_index.h>

namespace hedgerow {

/// What is given to a question about the primitives near a point.
template <std::floating_point T, int D>
struct Ball {
    Vec<T, D> center;
    T radius2;  ///< squared
};
template <std::floating_point T, int D>
struct Neighbours {
    Vec<T, D> point;
    std::size_t k;
    PointOptions options = {};
};

/// What is given to a question for the next hits of a ray: how many, and after which place.
template <std::floating_point T, int D>
struct HitsAlong {
    Ray<T, D> ray;
    std::size_t k;
    AfterHit after = {};
};

namespace detail {
/// The options of batches that stay in the calling thread.
inline const SideOptions alone{.threads = serial_executor()};
inline PointOptions in_this_thread(PointOptions options) {
    options.threads = serial_executor();
    return options;
}
}  // namespace detail

/// A question: its name; the words for it in a sentence; what is given to it, and what it answers, in memory
/// that the next answer may use again. A question has either `ask`, which asks an index once, or `ask_all`,
/// which asks many times in one call. Visits are added to those given; an `ask` without them is faster on the
/// engine. `column` names an answer that is a number or a truth value; columns.h has the columns of others.
/// `of_facets` says that only triangles in space and segments in the plane answer. What is asked of the solid
/// of an index has `ask_solid` too. Questions of one name differ by what is given to them or what they tell.
template <std::floating_point T, int D>
struct AskClosestHit {
    static constexpr std::string_view name = "closest-hit", words = "closest hit";
    using Given = Ray<T, D>;
    using Answer = Hit<T>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> rays, std::span<Answer> hits,
                        std::span<Visits> visits = {}) {
        closest_hits(index, rays, hits, {.threads = serial_executor()}, KeepAll(), visits);
    }
};
template <std::floating_point T, int D>
struct AskAnyHit {
    static constexpr std::string_view name = "any-hit", words = "any hit", column = "hit";
    using Given = Ray<T, D>;
    using Answer = bool;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> rays, std::span<Answer> hits,
                        std::span<Visits> visits = {}) {
        any_hits(index, rays, hits, {.threads = serial_executor()}, KeepAll(), visits);
    }
};
template <std::floating_point T, int D>
struct AskLastHit {
    static constexpr std::string_view name = "last-hit", words = "last hit";
    using Given = Ray<T, D>;
    using Answer = Hit<T>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> rays, std::span<Answer> hits,
                        std::span<Visits> visits = {}) {
        last_hits(index, rays, hits, {.threads = serial_executor()}, KeepAll(), visits);
    }
};
template <std::floating_point T, int D>
struct AskAllHits {
    static constexpr std::string_view name = "all-hits", words = "all hits";
    using Given = Ray<T, D>;
    using Answer = std::vector<Hit<T>>;
    static void ask(const AnyIndex<T, D>& index, const Given& ray, Answer& hits, Visits& visits) {
        all_hits(index, ray, hits, KeepAll(), visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& ray, Answer& hits) {
        all_hits(index, ray, hits);
    }
};
template <std::floating_point T, int D>
struct AskFirstHits {
    static constexpr std::string_view name = "first-hits", words = "first hits";
    using Given = HitsAlong<T, D>;
    using Answer = std::vector<Hit<T>>;
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& hits, Visits& visits) {
        find(index, given, hits, visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& hits) {
        find(index, given, hits, no_visits);
    }

private:
    template <class Count>
    static void find(const AnyIndex<T, D>& index, const Given& given, Answer& hits, Count& count) {
        hits.resize(std::min(given.k, index.size()));  // a ray has no more hits than there are primitives
        hits.resize(first_hits(index, given.ray, std::span(hits), {.after = given.after}, KeepAll(), count));
    }
};
template <std::floating_point T, int D>
struct AskClosestPoint {
    static constexpr std::string_view name = "closest-point", words = "closest point";
    using Given = Vec<T, D>;
    using Answer = Near<T, D>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}, const PointOptions& options = {}) {
        closest_points(index, points, found, detail::in_this_thread(options), KeepAll(), visits);
    }
};
template <std::floating_point T, int D>
struct AskFarthestPoint {
    static constexpr std::string_view name = "farthest-point", words = "farthest point";
    using Given = Vec<T, D>;
    using Answer = Near<T, D>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}, const PointOptions& options = {}) {
        farthest_points(index, points, found, detail::in_this_thread(options), KeepAll(), visits);
    }
};
/// A closest point, and where on its triangle or segment it is.
template <std::floating_point T, int D>
struct NearAndFeature {
    Near<T, D> near;
    FeatureOfNear<T, D> where;

    explicit operator bool() const { return static_cast<bool>(near); }
    /// NaN, in the normal of a triangle without area, equals itself.
    friend bool operator==(const NearAndFeature& a, const NearAndFeature& b) {
        const auto same = [](T x, T y) { return x == y || (x != x && y != y); };
        bool equal =
            a.near == b.near && a.where.feature == b.where.feature && a.where.number == b.where.number;
        for (int k = 0; k < D; ++k) {
            const auto i = static_cast<std::size_t>(k);
            equal = equal && same(a.where.weights[i], b.where.weights[i]) &&
                    same(a.where.normal[k], b.where.normal[k]);
        }
        return equal;
    }
};
template <std::floating_point T, int D>
struct AskFeature {
    static constexpr std::string_view name = "closest-point", words = "closest point with its feature";
    static constexpr bool of_facets = true, tells_features = true;
    using Given = Vec<T, D>;
    using Answer = NearAndFeature<T, D>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}, const PointOptions& options = {}) {
        const Scratch<std::vector<Near<T, D>>> kept;
        std::vector<Near<T, D>>& near = *kept;
        near.resize(points.size());
        closest_points(index, points, near, detail::in_this_thread(options), KeepAll(), visits);
        for (std::size_t i = 0; i < points.size(); ++i)
            found[i] = {near[i], near[i] ? index.feature(points[i], near[i]) : FeatureOfNear<T, D>()};
    }
};
template <std::floating_point T, int D>
struct AskNearest {
    static constexpr std::string_view name = "nearest", words = "nearest";
    using Given = Neighbours<T, D>;
    using Answer = std::vector<Near<T, D>>;
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found, Visits& visits) {
        nearest(index, given.point, given.k, found, given.options, KeepAll(), visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found) {
        nearest(index, given.point, given.k, found, given.options);
    }
};
template <std::floating_point T, int D>
struct AskWithin {
    static constexpr std::string_view name = "within", words = "within a radius";
    using Given = Ball<T, D>;
    using Answer = std::vector<Near<T, D>>;
    static void ask(const AnyIndex<T, D>& index, const Given& ball, Answer& found, Visits& visits) {
        within(index, ball.center, PointOptions::anywhere, found, {.radius2 = ball.radius2}, KeepAll(),
               visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& ball, Answer& found) {
        within(index, ball.center, PointOptions::anywhere, found, {.radius2 = ball.radius2});
    }
};

// The questions of a region: of a box, and by the same names of a solid ball.

namespace detail {
template <class R>
inline constexpr bool is_ball = false;
template <std::floating_point T, int D>
inline constexpr bool is_ball<Sphere<T, D>> = true;
}  // namespace detail

template <Region R>
struct AskOverlap {
    static constexpr std::string_view name = "overlap",
                                      words = detail::is_ball<R> ? "ball overlap" : "box overlap";
    using Given = R;
    using Answer = std::vector<PrimitiveId>;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    static void ask(const Asked& index, const R& region, Answer& found, Visits& visits) {
        overlapping(index, region, found, {}, visits);
    }
    static void ask(const Asked& index, const R& region, Answer& found) { overlapping(index, region, found); }
};
template <Region R>
struct AskContained {
    static constexpr std::string_view name = "contained", words = detail::is_ball<R> ? "contained in a ball"
                                                                                     : "contained in a box";
    using Given = R;
    using Answer = std::vector<PrimitiveId>;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    static void ask(const Asked& index, const R& region, Answer& found, Visits& visits) {
        contained(index, region, found, {}, visits);
    }
    static void ask(const Asked& index, const R& region, Answer& found) { contained(index, region, found); }
};
template <Region R>
struct AskCount {
    static constexpr std::string_view name = "count", column = "count",
                                      words = detail::is_ball<R> ? "count in a ball" : "count in a box";
    using Given = R;
    using Answer = std::uint64_t;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    static void ask(const Asked& index, const R& region, Answer& count, Visits& visits) {
        count = overlap_count(index, region, {}, visits);
    }
    static void ask(const Asked& index, const R& region, Answer& count) {
        count = overlap_count(index, region);
    }
};
template <Region R>
struct AskAnyOverlap {
    static constexpr std::string_view name = "any-overlap", column = "overlaps",
                                      words = detail::is_ball<R> ? "any in a ball" : "any in a box";
    using Given = R;
    using Answer = bool;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    static void ask(const Asked& index, const R& region, Answer& any, Visits& visits) {
        any = any_overlap(index, region, {}, visits);
    }
    static void ask(const Asked& index, const R& region, Answer& any) { any = any_overlap(index, region); }
};

// The questions of the solid whose surface the primitives are.

/// What these have in common. A Question has `ask_solid`, which asks a solid many times.
template <class Question, std::floating_point T, int D, class A>
struct AskOfSolid {
    static constexpr bool of_facets = true;
    using Given = Vec<T, D>;
    using Answer = A;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}) {
        Question::ask_solid(index.solid(), points, found, visits);
    }
};
/// Answers a sign: -1 outside, 0 on the surface, 1 inside.
template <std::floating_point T, int D>
struct AskSide : AskOfSolid<AskSide<T, D>, T, D, std::int8_t> {
    static constexpr std::string_view name = "side", words = "side of a surface", column = "side";
    static void ask_solid(const AnySolid<T, D>& solid, std::span<const Vec<T, D>> points,
                          std::span<std::int8_t> found, std::span<Visits> visits = {}) {
        const Scratch<std::vector<Side>> kept;
        std::vector<Side>& sides = *kept;
        sides.resize(points.size());
        hedgerow::sides(solid, points, sides, detail::alone, visits);
        for (std::size_t i = 0; i < points.size(); ++i)
            found[i] = static_cast<std::int8_t>(static_cast<int>(sides[i]) - static_cast<int>(Side::on));
    }
};
template <std::floating_point T, int D>
struct AskWindingNumber : AskOfSolid<AskWindingNumber<T, D>, T, D, double> {
    static constexpr std::string_view name = "winding-number", words = "winding number",
                                      column = "winding_number";
    static void ask_solid(const AnySolid<T, D>& solid, std::span<const Vec<T, D>> points,
                          std::span<double> found, std::span<Visits> visits = {}) {
        winding_numbers(solid, points, found, detail::alone, visits);
    }
};
template <std::floating_point T, int D>
struct AskSignedDistance : AskOfSolid<AskSignedDistance<T, D>, T, D, T> {
    static constexpr std::string_view name = "signed-distance", words = "signed distance",
                                      column = "distance";
    static void ask_solid(const AnySolid<T, D>& solid, std::span<const Vec<T, D>> points, std::span<T> found,
                          std::span<Visits> visits = {}) {
        signed_distances(solid, points, found, detail::alone, visits);
    }
};

/// Whether one call asks many times.
template <class Question>
concept AsksMany = requires {
    &Question::ask_all;
};

/// Calls f with each question of a region of type R.
template <Region R, class F>
void for_each_question_of_region(F f) {
    f(AskOverlap<R>());
    f(AskContained<R>());
    f(AskCount<R>());
    f(AskAnyOverlap<R>());
}

/// Calls f with each question.
template <std::floating_point T, int D, class F>
void for_each_question(F f) {
    f(AskClosestHit<T, D>());
    f(AskAnyHit<T, D>());
    f(AskLastHit<T, D>());
    f(AskAllHits<T, D>());
    f(AskFirstHits<T, D>());
    f(AskClosestPoint<T, D>());
    f(AskFeature<T, D>());
    f(AskFarthestPoint<T, D>());
    f(AskNearest<T, D>());
    f(AskWithin<T, D>());
    for_each_question_of_region<Box<T, D>>(f);
    for_each_question_of_region<Sphere<T, D>>(f);
    f(AskSide<T, D>());
    f(AskWindingNumber<T, D>());
    f(AskSignedDistance<T, D>());
}

namespace detail {
template <class Given>
inline constexpr bool is_ray = false;
template <std::floating_point T, int D>
inline constexpr bool is_ray<Ray<T, D>> = true;
template <std::floating_point T, int D>
inline constexpr bool is_ray<HitsAlong<T, D>> = true;
}  // namespace detail

template <class Question>
concept AsksFacets = requires {
    requires Question::of_facets;
};
/// A question of the solid of an index.
template <class Question>
concept AsksSolid = requires {
    &Question::ask_solid;
};

/// Whether sets of P answer a question: points answer no rays, which pass between them, and only triangles in
/// space and segments in the plane have features and insides.
template <class Question, class P>
inline constexpr bool answered_by = !(detail::is_ray<typename Question::Given> &&
                                      PointSet<ViewOf<P>>)&&(!AsksFacets<Question> || FacetSet<ViewOf<P>>);
/// Whether an index answers a question.
template <class Question, std::floating_point T, int D>
bool answers(const AnyIndex<T, D>& index) {
    return (!detail::is_ray<typename Question::Given> || index.answers_rays()) &&
           (!AsksFacets<Question> || index.has_facets());
}

/// The names of all questions that sets of P answer, each once.
template <class P>
std::vector<std::string_view> question_names() {
    std::vector<std::string_view> names;
    for_each_question<typename P::Scalar, P::dimension>([&]<class Question>(Question) {
        if constexpr (answered_by<Question, P>)
            if (std::find(names.begin(), names.end(), Question::name) == names.end())
                names.push_back(Question::name);
    });
    return names;
}

}  // namespace hedgerow
