/// The table of questions: all that an AnyIndex can be asked. Comparisons and the matrix of tests go
/// through it, so a question in the table is measured on every structure and compared with brute force.
#pragma once

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
};

/// A question: its name; the words for it in a sentence; what is given to it, and what it answers, in memory
/// that the next answer may use again. A question has either `ask`, which asks an index once, or `ask_all`,
/// which asks many times in one call. Visits are added to those given; an `ask` without them is faster on the
/// engine. `column` names an answer that is a number or a truth value; columns.h has the columns of others.
template <std::floating_point T, int D>
struct AskClosestHit {
    static constexpr std::string_view name = "closest-hit", words = "closest hit";
    using Given = Ray<T, D>;
    using Answer = Hit<T>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> rays, std::span<Answer> hits,
                        std::span<Visits> visits = {}) {
        index.closest_hits(rays, hits, visits);
    }
};
template <std::floating_point T, int D>
struct AskAnyHit {
    static constexpr std::string_view name = "any-hit", words = "any hit", column = "hit";
    using Given = Ray<T, D>;
    using Answer = bool;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> rays, std::span<Answer> hits,
                        std::span<Visits> visits = {}) {
        index.any_hits(rays, hits, visits);
    }
};
template <std::floating_point T, int D>
struct AskAllHits {
    static constexpr std::string_view name = "all-hits", words = "all hits";
    using Given = Ray<T, D>;
    using Answer = std::vector<Hit<T>>;
    static void ask(const AnyIndex<T, D>& index, const Given& ray, Answer& hits, Visits& visits) {
        index.all_hits(ray, hits, &visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& ray, Answer& hits) {
        index.all_hits(ray, hits);
    }
};
template <std::floating_point T, int D>
struct AskClosestPoint {
    static constexpr std::string_view name = "closest-point", words = "closest point";
    using Given = Vec<T, D>;
    using Answer = Near<T, D>;
    static void ask_all(const AnyIndex<T, D>& index, std::span<const Given> points, std::span<Answer> found,
                        std::span<Visits> visits = {}) {
        index.closest_points(points, found, visits);
    }
};
template <std::floating_point T, int D>
struct AskNearest {
    static constexpr std::string_view name = "nearest", words = "nearest";
    using Given = Neighbours<T, D>;
    using Answer = std::vector<Near<T, D>>;
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found, Visits& visits) {
        index.nearest(given.point, given.k, found, &visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found) {
        index.nearest(given.point, given.k, found);
    }
};
template <std::floating_point T, int D>
struct AskWithin {
    static constexpr std::string_view name = "within", words = "within a radius";
    using Given = Ball<T, D>;
    using Answer = std::vector<Near<T, D>>;
    static void ask(const AnyIndex<T, D>& index, const Given& ball, Answer& found, Visits& visits) {
        index.within(ball.center, {.radius2 = ball.radius2}, found, &visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& ball, Answer& found) {
        index.within(ball.center, {.radius2 = ball.radius2}, found);
    }
};
template <std::floating_point T, int D>
struct AskOverlap {
    static constexpr std::string_view name = "overlap", words = "box overlap";
    using Given = Box<T, D>;
    using Answer = std::vector<PrimitiveId>;
    static void ask(const AnyIndex<T, D>& index, const Given& box, Answer& found, Visits& visits) {
        index.overlapping(box, found, &visits);
    }
    static void ask(const AnyIndex<T, D>& index, const Given& box, Answer& found) {
        index.overlapping(box, found);
    }
};

/// Whether one call asks many times.
template <class Question>
concept AsksMany = requires {
    &Question::ask_all;
};

/// Calls f with each question.
template <std::floating_point T, int D, class F>
void for_each_question(F f) {
    f(AskClosestHit<T, D>());
    f(AskAnyHit<T, D>());
    f(AskAllHits<T, D>());
    f(AskClosestPoint<T, D>());
    f(AskNearest<T, D>());
    f(AskWithin<T, D>());
    f(AskOverlap<T, D>());
}

namespace detail {
template <class Given>
inline constexpr bool is_ray = false;
template <std::floating_point T, int D>
inline constexpr bool is_ray<Ray<T, D>> = true;
}  // namespace detail

/// Whether sets of P answer a question: points answer no rays, which pass between them.
template <class Question, class P>
inline constexpr bool answered_by = !(detail::is_ray<typename Question::Given> && PointSet<ViewOf<P>>);

/// The names of all questions that sets of P answer.
template <class P>
std::vector<std::string_view> question_names() {
    std::vector<std::string_view> names;
    for_each_question<typename P::Scalar, P::dimension>([&]<class Question>(Question) {
        if constexpr (answered_by<Question, P>) names.push_back(Question::name);
    });
    return names;
}

}  // namespace hedgerow
