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

/// The way of the functions of ask/ to what an AnyIndex answers by its structure, without filters and visits.
struct Uncounted {
    template <class I, class... Arguments>
    static auto closest_points(const I& index, Arguments&&... arguments)
        -> decltype(index.closest_points_uncounted(arguments...)) {
        return index.closest_points_uncounted(arguments...);
    }
    template <class I, class... Arguments>
    static auto nearest(const I& index, Arguments&&... arguments)
        -> decltype(index.nearest_uncounted(arguments...)) {
        return index.nearest_uncounted(arguments...);
    }
    template <class I, class... Arguments>
    static auto within(const I& index, Arguments&&... arguments)
        -> decltype(index.within_uncounted(arguments...)) {
        return index.within_uncounted(arguments...);
    }
    template <class I, class... Arguments>
    static auto all_hits(const I& index, Arguments&&... arguments)
        -> decltype(index.all_hits_uncounted(arguments...)) {
        return index.all_hits_uncounted(arguments...);
    }
    template <class I, class... Arguments>
    static auto first_hits(const I& index, Arguments&&... arguments)
        -> decltype(index.first_hits_uncounted(arguments...)) {
        return index.first_hits_uncounted(arguments...);
    }
    /// Closest hits or any hits, by the type of the answers.
    template <class I, class... Arguments>
    static auto rays(const I& index, Arguments&&... arguments)
        -> decltype(index.rays_uncounted(arguments...)) {
        return index.rays_uncounted(arguments...);
    }
    template <template <class, class> class Q, class I, class R, class... Arguments>
    static auto region(const I& index, const R& region, Arguments&&... arguments)
        -> decltype(index.template region<Q>(region, arguments...)) {
        return index.template region<Q>(region, arguments...);
    }
};
}  // namespace detail

}  // namespace hedgerow
