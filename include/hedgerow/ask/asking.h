/// What the questions of all families share: their one grammar, and the steps of a batch.
///
/// Every function that asks reads question(index, asked, out, options, filter, visits). `asked` is all that
/// the question cannot be without. `out` is left out where the answer is returned. `options` is a plain
/// struct, and may be left out before a filter too. A filter refuses answers (queries/hit.h); visits count
/// what was looked at (walks/visits.h): one Visits for one query, a span of them, one for each, for a batch.
///
/// A batch answers each of many queries as the function of one query does. Large batches use all cores, or
/// the threads of their options. A filter may keep state, which threads would share, so a batch with a filter
/// stays in the calling thread unless the options give it threads. A batch throws InputError, and writes
/// nothing, where there are fewer places for answers than queries. Lists take the memory of all answers, and
/// twice as much while the call runs over several threads.
#pragma once

#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/scratch.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/index.h>
#include <hedgerow/queries/lists.h>

namespace hedgerow {

inline constexpr NoVisits no_visits{};

namespace detail {
/// Throws InputError if there are fewer places for answers than queries.
inline void expect_room(const std::string& asked, std::size_t count, std::size_t answers) {
    if (answers < count)
        throw InputError("there are " + std::to_string(count) + " " + asked + ", but room for " +
                         std::to_string(answers) + " answers: make the array of answers as long as that of " +
                         asked);
}

/// The executor of a batch of `count` queries.
template <class Filter>
Executor& executor_for(Threads threads, std::size_t count) {
    return threads.over(std::same_as<Filter, KeepAll> ? count : 0);
}
/// Answers by f(count), where the count is the visits of query i of a batch, or none.
template <class F>
auto with_visits(std::span<Visits> visits, std::size_t i, F f) {
    return visits.empty() ? f(no_visits) : f(visits[i]);
}
inline void expect_visits(std::span<Visits> visits, std::size_t queries) {
    if (!visits.empty()) expect_room("queries", queries, visits.size());
}
/// Calls one(i, count) for each of `queries`, in pieces over the executor.
template <class One>
void ask_each(std::size_t queries, Executor& executor, std::span<Visits> visits, One one) {
    executor.for_each_piece(queries, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            with_visits(visits, i, [&](auto& count) { return one(i, count); });
    });
}
/// Fills lists of one column: one(i, list, count) replaces what a vector holds by the list of query i.
template <class C, class T, class One>
void list_each(std::size_t queries, Executor& executor, Lists<C>& lists, Buffer<T> C::*column,
               std::span<Visits> visits, One one) {
    list_one_by_one(queries, executor, lists, column, [&](std::size_t i, std::vector<T>& list) {
        with_visits(visits, i, [&](auto& count) { return one(i, list, count); });
    });
}

/// The number of primitives that a query may answer.
template <class P>
std::size_t primitives_in(const P& set) {
    if constexpr (Instanced<P>) {
        std::size_t all = 0;
        for (std::size_t i = 0; i < set.size(); ++i) all += set[i].index().size();
        return all;
    } else {
        return set.size();
    }
}
/// Whether a walk offers each primitive once: not where a structure has it in several cells.
template <class I>
bool offers_each_once(const I& index) {
    if constexpr (requires {
                      index.structure();
                      index.primitives();
                      index.structure().exclusive();
                  })
        return index.structure().exclusive() && offers_once(index.primitives());
    else
        return index.exclusive();
}
}  // namespace detail

}  // namespace hedgerow
