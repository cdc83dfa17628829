/// What tests of the engine share.
#pragma once

#include <hedgerow/structures/bvh/wide/kernels.h>

#include "matrix.h"

namespace hedgerow {

/// Takes an instruction set, and the one before when it goes.
class Using {
public:
    explicit Using(std::string_view set)
        : before_(wide_kernels() ? wide_kernels()->instruction_set : "plain") {
        use_instruction_set(set);
    }
    ~Using() { use_instruction_set(before_); }
    Using(const Using&) = delete;
    Using& operator=(const Using&) = delete;

private:
    std::string_view before_;
};

}  // namespace hedgerow
