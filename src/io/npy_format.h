/// Reads and writes NumPy arrays, whatever files they are in.
#pragma once

#include <bit>
#include <string>
#include <vector>

#include <hedgerow/io/npy.h>

#include "byte_source.h"
#include "output_file.h"

namespace hedgerow::detail {

/// The most axes that an array may have, as in NumPy.
inline constexpr std::size_t most_axes = 64;

/// The type of a number: "f8", as in NpyArray, its bytes and their order.
struct NpyType {
    std::string dtype;
    std::size_t item = 0;
    std::endian order = std::endian::little;
};
/// A field of a record, `offset` bytes after the record's first.
struct NpyField {
    std::string name;
    NpyType type;
    std::size_t offset;
};
/// What a header says. The elements are numbers, or records if there are fields; `type.item` is the size of
/// both.
struct NpyHeader {
    NpyType type;
    std::vector<NpyField> fields;
    bool fortran = false;
    std::vector<std::size_t> shape;
};

NpyHeader read_npy_header(ByteSource& file);
/// Bytes that all elements take. Throws InputError if the file does not have as many.
std::size_t expect_npy_elements(const ByteSource& file, const NpyHeader& header);

NpyArray read_npy(ByteSource& file);
/// Reads only the header: the number of elements along each axis.
std::vector<std::size_t> read_npy_shape(ByteSource& file);

/// The header of a file of version 1. `dtype` is written as in NpyArray.
std::string npy_header(const std::string& dtype, const std::vector<std::size_t>& shape);
/// The header of any elements, which `descr` describes as Python reads it. Ends at a multiple of 64 bytes,
/// and not before `length` bytes.
std::string npy_header_of(const std::string& descr, const std::vector<std::size_t>& shape,
                          std::size_t length = 0);

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
