/// When what is slow to build pays.
#pragma once

namespace hedgerow::compare {

/// What a structure costs that is built once and then asked: seconds.
struct Cost {
    double build, query;
    double after(double queries) const { return build + queries * query; }
};

/// For how many queries one structure costs less than another: always, from so many on, until so many, or
/// never.
struct BreakEven {
    enum class When { always, from, until, never };
    When when;
    double queries;  ///< of `from` and `until`; else 0
    friend bool operator==(const BreakEven&, const BreakEven&) = default;
};

/// Equal costs count as costing no less.
BreakEven break_even(const Cost& one, const Cost& other);

}  // namespace hedgerow::compare
