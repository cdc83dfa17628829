#include <hedgerow/measure/break_even.h>

namespace hedgerow::measure {

BreakEven break_even(const Cost& one, const Cost& other) {
    const double build = one.build - other.build, query = one.query - other.query;
    if (build >= 0 && query >= 0) return {BreakEven::When::never, 0};
    if (build <= 0 && query <= 0) return {BreakEven::When::always, 0};
    return {build > 0 ? BreakEven::When::from : BreakEven::When::until, -build / query};
}

}  // namespace hedgerow::measure
