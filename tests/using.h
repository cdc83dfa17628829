/// Chooses an instruction set for a while.
#pragma once

#include <hedgerow/base/instruction_set.h>

namespace hedgerow {

/// Selects an instruction set, and restores the earlier one at its end.
class Using {
public:
    explicit Using(std::string_view set) : before_(name_of(instruction_set())) { use_instruction_set(set); }
    ~Using() { use_instruction_set(before_); }
    Using(const Using&) = delete;
    Using& operator=(const Using&) = delete;

private:
    std::string_view before_;
};

}  // namespace hedgerow
