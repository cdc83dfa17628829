/// The number of queries from which a slower build pays.
#pragma once

namespace hedgerow::measure {

/// Seconds to build a structure once, and seconds for each query.
struct Cost {
    double build, query;
    double after(double queries) const { return build + queries * query; }
};

/// The numbers of queries for which one structure costs less than another: all, those above `queries`, those
/// below it, or none.
struct BreakEven {
    enum class When { always, from, until, never };
    When when;
    double queries;  ///< the number at which costs are equal, for `from` and `until`; else 0
    friend bool operator==(const BreakEven&, const BreakEven&) = default;
};

/// Compares the total costs of `one` and `other`. Equal costs count as not less.
BreakEven break_even(const Cost& one, const Cost& other);

}  // namespace hedgerow::measure
