/// Rows whose columns are others than those that are wanted.
#pragma once

#include <hedgerow/base/error.h>

namespace hedgerow::detail {

/// The columns of a file are at fault, no number in it: it may have others.
class OtherColumns : public InputError {
public:
    using InputError::InputError;
};
/// Calls fail(), which throws an InputError, and throws OtherColumns in its place.
template <class F>
void fail_for_columns(F fail) {
    try {
        fail();
    } catch (const InputError& fault) {
        throw OtherColumns(fault.what());
    }
}

}  // namespace hedgerow::detail
