/// Checks, before work begins, that there is memory for it.
#pragma once

#include <stdexcept>
#include <string>

namespace hedgerow::cli {

class MemoryShort : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws MemoryShort, with both figures, if `what` takes more bytes than there are (memory_left). `instead`
/// tells the user what to do, as "ask for a smaller picture".
void expect_memory(const std::string& what, double bytes, const std::string& instead);

}  // namespace hedgerow::cli
