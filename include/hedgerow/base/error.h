/// Exceptions for bad input, a bad request, and a file that cannot be written.
#pragma once

#include <stdexcept>
#include <string>

namespace hedgerow {

/// Bad input: a file, an option, an array or a size. The message names the place (file, line or byte, field)
/// and says what to do. The tool exits with code 3.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The request is at fault, not the input: a structure, scene or option that does not exist, a value out of
/// its range, or a structure that does not suit the primitives. The tool exits with code 2.
class UsageError : public InputError {
public:
    using InputError::InputError;
};

/// A file cannot be written: the disk is full, the folder is missing, or permission is denied. A file that
/// was there before is untouched. The tool exits with code 1.
class OutputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace hedgerow
