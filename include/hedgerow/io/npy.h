/// NumPy arrays: `.npy` files, versions 1 to 3 (the format is NumPy's NEP 1).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// An array as it lies in a file, but in this processor's byte order and in C order (last index fastest).
struct NpyArray {
    /// "b1" (bool), "i1" "i2" "i4" "i8", "u1" "u2" "u4" "u8", "f4" or "f8": kind and bytes an element.
    std::string dtype = "f8";
    /// Elements along each axis; empty: one number.
    std::vector<std::size_t> shape;
    std::vector<std::byte> bytes;

    /// Number of elements.
    std::size_t size() const;
    /// All elements, converted to T: float, double or a fixed-width integer. To a floating-point type numbers
    /// are rounded. Throws InputError naming the first element that is not exactly one of an integer type's
    /// values. O(size).
    template <class T>
    std::vector<T> as() const;
};

/// Reads `.npy` or `.npy.gz`, either byte order, C or Fortran order. Throws InputError if the file is none,
/// holds another type of element (objects, complex numbers, records, ...), ends early, or has a shape whose
/// size overflows. Memory grows as data arrives; Fortran order needs the data twice for a moment. O(size).
NpyArray load_npy(const std::filesystem::path& path, const Progress& progress = {});

/// Writes elements in C order as version 1, little endian. T is float, double or a fixed-width integer.
/// Throws InputError if `values` is not what `shape` holds, OutputError if the path cannot be written.
template <class T>
void save_npy(const std::filesystem::path& path, std::span<const T> values,
              const std::vector<std::size_t>& shape);

}  // namespace hedgerow
