/// Primitives that a question leaves out by their number.
#pragma once

#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/base/strided.h>
#include <hedgerow/walks/query.h>

namespace hedgerow {

/// The element that a query leaves out, whatever its distance: none, one for all queries, or one for each
/// query of a batch, where `no_primitive` leaves out none. Among instances it is left out of each.
///
///   nearest(index, points, 8, lists, {.leave_out = own_numbers});   // without the point itself
class LeaveOut {
public:
    LeaveOut() = default;
    LeaveOut(PrimitiveId element) : element_(element) {}  // NOLINT(google-explicit-constructor)
    /// Views an array: a vector, a span, or Strided.
    template <class Each>
    requires std::convertible_to<const Each&, Strided<PrimitiveId>> LeaveOut(const Each& each)
        : each_(each), of_each_(true) {}  // NOLINT(google-explicit-constructor)

    bool none() const { return !of_each_ && element_ == no_primitive; }
    PrimitiveId of(std::size_t query) const { return of_each_ ? each_[query] : element_; }
    /// Throws InputError if there is an array that is shorter than the batch.
    void expect(std::size_t queries) const {
        if (of_each_ && each_.size() < queries)
            throw InputError("there are " + std::to_string(queries) +
                             " queries, but elements to leave out for " + std::to_string(each_.size()) +
                             ": give one for each query, or none");
    }

private:
    PrimitiveId element_ = no_primitive;
    Strided<PrimitiveId> each_;
    bool of_each_ = false;
};

}  // namespace hedgerow
