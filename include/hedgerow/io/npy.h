/// NumPy arrays: `.npy` files, versions 1 to 3 (the format is NumPy's NEP 1).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// An array as in a file, but in this processor's byte order and in C order (last index fastest).
struct NpyArray {
    /// "b1" (bool), "i1" "i2" "i4" "i8", "u1" "u2" "u4" "u8", "f4" or "f8": the kind, and the bytes per
    /// element.
    std::string dtype = "f8";
    /// Number of elements along each axis; empty for a single number.
    std::vector<std::size_t> shape;
    std::vector<std::byte> bytes;

    /// Number of elements.
    std::size_t size() const;
    /// All elements, converted to T: float, double or a fixed-width integer. Conversion to a floating-point
    /// type rounds. Conversion to an integer type throws InputError, naming the first element that is not
    /// exactly a value of T. An unknown `dtype` is an InputError too. O(size).
    template <class T>
    std::vector<T> as() const;
};

/// Reads `.npy` or `.npy.gz`, in either byte order, in C or Fortran order. Throws InputError if the file is
/// not an array, has elements of another type (objects, complex numbers, records, ...), ends early, or has a
/// shape whose size overflows. Throws Cancelled if `progress` is cancelled. Memory fills as data arrives;
/// Fortran order needs the data twice for a moment. O(size).
NpyArray load_npy(const std::filesystem::path& path, const Progress& progress = {});

/// Writes elements in C order as version 1, little endian. T is float, double or a fixed-width integer.
/// Throws InputError if `shape` does not hold as many elements as `values` or has more than 64 axes, and
/// OutputError if the path cannot be written. O(size).
template <class T>
void save_npy(const std::filesystem::path& path, std::span<const T> values,
              const std::vector<std::size_t>& shape);

}  // namespace hedgerow
