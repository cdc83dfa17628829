/// What the questions of all families share: the check of the room for a batch's answers.
///
/// A batch of lists gives a list for each of many queries: `found[i]` is what the function of the same name
/// finds for query i, with the same limits and filters. Its memory is that of all answers, and up to three
/// times as much while the call runs; its cost is the sum of the costs of the single queries.
#pragma once

#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/scratch.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/index.h>
#include <hedgerow/queries/answer_lists.h>

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
}  // namespace detail

}  // namespace hedgerow
