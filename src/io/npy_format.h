/// Reads and writes NumPy arrays, whatever files they are in.
#pragma once

#include <hedgerow/io/npy.h>

#include "byte_source.h"
#include "output_file.h"

namespace hedgerow::detail {

/// The most axes that an array may have, as in NumPy.
inline constexpr std::size_t most_axes = 64;

NpyArray read_npy(ByteSource& file);
/// Reads only the header: the number of elements along each axis.
std::vector<std::size_t> read_npy_shape(ByteSource& file);

/// The header of a file of version 1. `dtype` is written as in NpyArray.
std::string npy_header(const std::string& dtype, const std::vector<std::size_t>& shape);

template <class T>
constexpr const char* npy_dtype() {
    constexpr std::size_t s = sizeof(T);
    if constexpr (std::is_floating_point_v<T>)
        return s == 4 ? "f4" : "f8";
    else if constexpr (std::is_signed_v<T>)
        return s == 1 ? "i1" : s == 2 ? "i2" : s == 4 ? "i4" : "i8";
    else
        return s == 1 ? "u1" : s == 2 ? "u2" : s == 4 ? "u4" : "u8";
}

}  // namespace hedgerow::detail
