/// The answers of a structure to the table of questions, to be compared with those of brute force. Tests that
/// the hunter writes include this file.
#pragma once

#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/questions.h>

#include "regions.h"
#include "shapes.h"

namespace hedgerow::hunter {

/// The closest point in a batch with PointOptions, which the table of questions leaves out.
template <class T, int D>
struct AskClosestWithOptions {
    static constexpr std::string_view name = "closest-point", words = "closest point with options";
    using Given = Neighbours<T, D>;
    using Answer = Near<T, D>;
    static void ask(const AnyIndex<T, D>& index, const Given& given, Answer& found) {
        closest_points(index, {&given.point, 1}, {&found, 1}, given.options);
    }
};

/// Calls f with each question that the hunter asks, but those of regions of other shapes than boxes and
/// balls.
template <class T, int D, class F>
void for_each_hunted_question(F f) {
    for_each_question<T, D>(f);
    f(AskClosestWithOptions<T, D>());
}

/// The answers to a question, asked together if it can be.
template <class Question, class T, int D>
std::vector<typename Question::Answer> answers_to(const AnyIndex<T, D>& index,
                                                  std::span<const typename Question::Given> given) {
    using Answer = typename Question::Answer;
    const std::unique_ptr<Answer[]> found(new Answer[given.size()]());
    if constexpr (AsksMany<Question>)
        Question::ask_all(index, given, {found.get(), given.size()});
    else
        for (std::size_t i = 0; i < given.size(); ++i) Question::ask(index, given[i], found[i]);
    return {std::make_move_iterator(found.get()), std::make_move_iterator(found.get() + given.size())};
}

// With a factor the answer depends on the structure: it is compared with the exact one, by distances.

template <class Given>
const Given& exactly(const Given& given) {
    return given;
}
template <class T, int D>
Neighbours<T, D> exactly(Neighbours<T, D> given) {
    given.options.factor = 1;
    return given;
}
template <class T, int D>
bool about_as_near(const Near<T, D>& near, const Near<T, D>& exact, double factor) {
    if (!near || !exact) return bool(near) == bool(exact);
    const double most = double(exact.distance2) * factor * factor * (1 + 0x1p-18);
    return near.distance2 >= exact.distance2 && double(near.distance2) <= most;
}
/// Whether an answer is what brute force answers to the same with a factor of 1.
template <class Given, class Answer>
bool agrees(const Given& given, const Answer& said, const Answer& truth) {
    if constexpr (requires { given.options.factor; }) {
        const auto factor = given.options.factor;
        if (factor == 1) return said == truth;
        if constexpr (requires { said.distance2; }) {
            return about_as_near(said, truth, factor);
        } else {
            bool near = said.size() == truth.size();
            for (std::size_t i = 0; near && i < said.size(); ++i)
                near = about_as_near(said[i], truth[i], factor);
            return near;
        }
    } else {
        return said == truth;
    }
}

/// Whether an index answers all questions of something like another one.
template <class T, int D, class Given>
bool same_answers(const AnyIndex<T, D>& index, const AnyIndex<T, D>& oracle, const Given& given) {
    bool same = true;
    for_each_hunted_question<T, D>([&]<class Question>(Question) {
        if constexpr (std::same_as<typename Question::Given, Given>) {
            if (!same || !answers<Question>(index)) return;
            const Given exact = exactly(given);
            same = agrees(given, answers_to<Question>(index, {&given, 1})[0],
                          answers_to<Question>(oracle, {&exact, 1})[0]);
        }
    });
    return same;
}
template <class T, int D>
bool same_answers(const AnyIndex<T, D>& index, const AnyIndex<T, D>& oracle,
                  const RegionThrough<T, D>& given) {
    bool same = true;
    with_region(given, [&]<class R>(const R& region) {
        for_each_question_of_region<R>([&]<class Question>(Question) {
            same = same &&
                   answers_to<Question>(index, {&region, 1}) == answers_to<Question>(oracle, {&region, 1});
        });
    });
    return same;
}

/// A change to an index between its build and the query. It leaves the primitives the same.
enum class Then { nothing, erased_and_inserted, refitted };

/// Makes a change. Returns false if the structure cannot make it.
template <class T, int D>
bool carry_out(Then then, AnyIndex<T, D>& index) {
    if (then == Then::refitted && index.refittable()) return index.refit(), true;
    if (then != Then::erased_and_inserted || !index.changes_one_by_one()) return then == Then::nothing;
    const auto count = static_cast<PrimitiveId>(index.size());
    for (PrimitiveId id = 0; id < count; id += 2) index.erase(id);
    for (PrimitiveId id = 0; id < count; id += 2) index.insert(id);
    return true;
}

/// Whether an index over some shapes, built and changed, is valid and answers all questions of something like
/// brute force.
template <class Shape, class Given>
bool as_brute_force(const std::string& spec, const std::vector<Shape>& shapes, const Given& given,
                    Then then = Then::nothing) {
    const auto set = set_of(shapes);
    const auto index = build_any(spec, set);
    carry_out(then, *index);
    return index->validate().empty() && same_answers(*index, *build_any("brute-force", set), given);
}

}  // namespace hedgerow::hunter
