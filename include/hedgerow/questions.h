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

/// A question: its name; the words for it in a sentence; what it answers (`meaning`); the functions of ask.h
/// that ask it once and many times; what is given to it, and what it answers, in memory that the next answer
/// may use again. `variant` tells questions of one name apart: "feature" tells more, "radius" is asked of
/// balls. A question has either `ask`, which asks an index once, or `ask_all`, which asks many times in one
/// call. Visits are added to those given; without them it is faster on the engine. `column` names an answer
/// that is a number or a truth value; columns.h has the columns of others, and those of what is given.
/// `of_facets` says that only triangles in space and segments in the plane answer. What is asked of the solid
/// of an index has `ask_solid` too. any_question.h has all that is said here behind one type.
template <std::floating_point T, int D>
struct AskClosestHit {
    static constexpr std::string_view name = "closest-hit", words = "closest hit";
    static constexpr std::string_view meaning = "the hit of least t in [t_min, t_max]",
                                      function = "closest_hit", batch = "closest_hits";
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
    static constexpr std::string_view meaning = "whether anything is hit in [t_min, t_max]",
                                      function = "any_hit", batch = "any_hits";
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
    static constexpr std::string_view meaning = "the hit of greatest t in [t_min, t_max]",
                                      function = "last_hit", batch = "last_hits";
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
    static constexpr std::string_view
        meaning = "every hit in [t_min, t_max], each primitive once, by (t, primitive)",
        function = "all_hits", batch = "all_hits";
    using Given = Ray<T, D>;
    using Answer = std::vector<Hit<T>>;
    template <class Count = const NoVisits>
    static void ask(const AnyIndex<T, D>& index, const Given& ray, Answer& hits, Count& count = no_visits) {
        all_hits(index, ray, hits, KeepAll(), count);
    }
};
template <std::floating_point T, int D>
struct AskFirstHits {
    static constexpr std::string_view name = "first-hits", words = "first hits";
    static constexpr std::string_view meaning = "the first of all hits, by (t, primitive)",
                                      function = "first_hits", batch = "first_hits";
    using Given = HitsAlong<T, D>;
    using Answer = std::vector<Hit<T>>;
    template <class Count = const NoVisits>
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& hits, Count& count = no_visits) {
        hits.resize(std::min(given.k, index.size()));  // a ray has no more hits than there are primitives
        hits.resize(first_hits(index, given.ray, std::span(hits), {.after = given.after}, KeepAll(), count));
    }
};
template <std::floating_point T, int D>
struct AskClosestPoint {
    static constexpr std::string_view name = "closest-point", words = "closest point";
    static constexpr std::string_view meaning = "the closest point of any primitive",
                                      function = "closest_point", batch = "closest_points";
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
    static constexpr std::string_view meaning = "the farthest point of any primitive",
                                      function = "farthest_point", batch = "farthest_points";
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
    static constexpr std::string_view meaning =
                                          "the closest point, and the face, edge or vertex that it is on",
                                      function = "feature", batch = "closest_points";
    static constexpr std::string_view variant = "feature";
    static constexpr bool of_facets = true;
    using Given = Vec<T, D>;
    using Answer = NearAndFeature<T, D>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}, const PointOptions& options = {}) {
        const Scratch<std::vector<Near<T, D>>> kept;
        std::vector<Near<T, D>>& near = *kept;
        near.resize(points.size());
        closest_points(index, points, near, detail::in_this_thread(options), KeepAll(), visits);
        for (std::size_t i = 0; i < points.size(); ++i)
            found[i] = {near[i], near[i] ? feature(index, points[i], near[i]) : FeatureOfNear<T, D>()};
    }
};
template <std::floating_point T, int D>
struct AskNearest {
    static constexpr std::string_view name = "nearest", words = "nearest";
    static constexpr std::string_view meaning = "the nearest primitives, by (distance, primitive)",
                                      function = "nearest", batch = "nearest";
    using Given = Neighbours<T, D>;
    using Answer = std::vector<Near<T, D>>;
    template <class Count = const NoVisits>
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found,
                    Count& count = no_visits) {
        nearest(index, given.point, given.k, found, given.options, KeepAll(), count);
    }
};
template <std::floating_point T, int D>
struct AskWithin {
    static constexpr std::string_view name = "within", words = "within a radius";
    static constexpr std::string_view meaning = "the primitives within a distance, by (distance, primitive)",
                                      function = "within", batch = "within";
    using Given = Ball<T, D>;
    using Answer = std::vector<Near<T, D>>;
    template <class Count = const NoVisits>
    static void ask(const AnyIndex<T, D>& index, const Given& ball, Answer& found, Count& count = no_visits) {
        within(index, ball.center, PointOptions::anywhere, found, {.radius2 = ball.radius2}, KeepAll(),
               count);
    }
};

// The questions of a region: of a box, and by the same names of a solid ball.

namespace detail {
template <class R>
inline constexpr bool is_ball = false;
template <std::floating_point T, int D>
inline constexpr bool is_ball<Sphere<T, D>> = true;
template <class R>
inline constexpr std::string_view variant_of_region = is_ball<R> ? "radius" : "";
}  // namespace detail

template <Region R>
struct AskOverlap {
    static constexpr std::string_view variant = detail::variant_of_region<R>;
    static constexpr std::string_view name = "overlap",
                                      words = detail::is_ball<R> ? "ball overlap" : "box overlap";
    static constexpr std::string_view meaning = "the primitives that share a point with a region",
                                      function = "overlapping", batch = "overlapping";
    using Given = R;
    using Answer = std::vector<PrimitiveId>;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    template <class Count = const NoVisits>
    static void ask(const Asked& index, const R& region, Answer& found, Count& count = no_visits) {
        overlapping(index, region, found, {}, count);
    }
};
template <Region R>
struct AskContained {
    static constexpr std::string_view variant = detail::variant_of_region<R>;
    static constexpr std::string_view name = "contained", words = detail::is_ball<R> ? "contained in a ball"
                                                                                     : "contained in a box";
    static constexpr std::string_view meaning = "the primitives that lie in a region wholly",
                                      function = "contained", batch = "contained";
    using Given = R;
    using Answer = std::vector<PrimitiveId>;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    template <class Count = const NoVisits>
    static void ask(const Asked& index, const R& region, Answer& found, Count& count = no_visits) {
        contained(index, region, found, {}, count);
    }
};
template <Region R>
struct AskCount {
    static constexpr std::string_view variant = detail::variant_of_region<R>;
    static constexpr std::string_view name = "count", column = "count",
                                      words = detail::is_ball<R> ? "count in a ball" : "count in a box";
    static constexpr std::string_view meaning = "how many primitives share a point with a region",
                                      function = "overlap_count", batch = "overlap_counts";
    using Given = R;
    using Answer = std::uint64_t;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    template <class Count = const NoVisits>
    static void ask(const Asked& index, const R& region, Answer& found, Count& count = no_visits) {
        found = overlap_count(index, region, {}, count);
    }
};
template <Region R>
struct AskAnyOverlap {
    static constexpr std::string_view variant = detail::variant_of_region<R>;
    static constexpr std::string_view name = "any-overlap", column = "overlaps",
                                      words = detail::is_ball<R> ? "any in a ball" : "any in a box";
    static constexpr std::string_view meaning = "whether any primitive shares a point with a region",
                                      function = "any_overlap", batch = "any_overlaps";
    using Given = R;
    using Answer = bool;
    using Asked = AnyIndex<typename R::Scalar, R::dimension>;
    template <class Count = const NoVisits>
    static void ask(const Asked& index, const R& region, Answer& any, Count& count = no_visits) {
        any = any_overlap(index, region, {}, count);
    }
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
    static constexpr std::string_view
        meaning = "whether a point is outside (-1), on (0) or inside (1) of the surface",
        function = "side", batch = "sides";
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
    static constexpr std::string_view meaning = "how often the surface winds around a point",
                                      function = "winding_number", batch = "winding_numbers";
    /// The ways that tell it (SideBy).
    static constexpr std::string_view ways[] = {"crossings", "expansion"};
    static void ask_solid(const AnySolid<T, D>& solid, std::span<const Vec<T, D>> points,
                          std::span<double> found, std::span<Visits> visits = {}) {
        winding_numbers(solid, points, found, detail::alone, visits);
    }
};
template <std::floating_point T, int D>
struct AskSignedDistance : AskOfSolid<AskSignedDistance<T, D>, T, D, T> {
    static constexpr std::string_view name = "signed-distance", words = "signed distance",
                                      column = "distance";
    static constexpr std::string_view meaning = "how far the surface is, negative inside",
                                      function = "signed_distance", batch = "signed_distances";
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
/// The variant of a question among those of its name.
template <class Question>
constexpr std::string_view variant_of() {
    if constexpr (requires { Question::variant; })
        return Question::variant;
    else
        return {};
}

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
