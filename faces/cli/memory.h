/// Whether there is memory for what is asked, before it is begun.
#pragma once

#include <stdexcept>
#include <string>

namespace hedgerow::cli {

class MemoryShort : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws MemoryShort, with both figures, if `what` takes more bytes than there are. `instead` says what to
/// ask for, as "ask for a smaller picture".
void expect_memory(const std::string& what, double bytes, const std::string& instead);

}  // namespace hedgerow::cli
