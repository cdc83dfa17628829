/// How the library says that its input is bad.
#pragma once

#include <stdexcept>
#include <string>

namespace hedgerow {

/// Bad input: a file, an option, an array or a size. The message names the place (file, line or byte, field)
/// and says what to do. The tool answers it with exit code 3.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace hedgerow
