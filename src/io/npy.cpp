/// NumPy arrays: conversion of elements, and writing.
#include <hedgerow/io/npy.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include <hedgerow/base/error.h>

#include "memory.h"
#include "npy_format.h"
#include "text.h"

namespace hedgerow {

namespace {

/// Element i of an array as a To. Throws InputError if To is an integer type without that value.
template <class To, class From>
To converted(From x, std::size_t i) {
    if constexpr (std::is_same_v<To, From>) {
        return x;
    } else if constexpr (std::is_floating_point_v<To>) {
        if constexpr (std::is_same_v<From, double>)
            return detail::rounded<To>(x);
        else
            return static_cast<To>(x);
    } else {
        bool fits = false;
        if constexpr (std::is_floating_point_v<From>) {
            // Both bounds are exact: powers of two, or 0.
            const double d = static_cast<double>(x), end = std::ldexp(1.0, std::numeric_limits<To>::digits);
            fits = d == std::floor(d) && d < end && d >= (std::is_signed_v<To> ? -end : 0.0);
        } else {
            fits = std::in_range<To>(x);
        }
        if (!fits)
            throw InputError("element " + std::to_string(i) + " of the array is " + std::to_string(x) +
                             ", which is not a number of type " + detail::npy_dtype<To>() +
                             ". Convert the array before it is saved");
        return static_cast<To>(x);
    }
}

template <class To, class From>
std::vector<To> all_as(const NpyArray& array) {
    std::vector<To> values(array.bytes.size() / sizeof(From));
    for (std::size_t i = 0; i < values.size(); ++i) {
        From x;
        std::memcpy(&x, array.bytes.data() + i * sizeof(From), sizeof(From));
        values[i] = converted<To>(x, i);
    }
    return values;
}

}  // namespace

std::size_t NpyArray::size() const {
    return bytes.size() / static_cast<std::size_t>(dtype.at(1) - '0');
}

template <class T>
std::vector<T> NpyArray::as() const {
    if (dtype == "f4") return all_as<T, float>(*this);
    if (dtype == "f8") return all_as<T, double>(*this);
    if (dtype == "i1") return all_as<T, std::int8_t>(*this);
    if (dtype == "i2") return all_as<T, std::int16_t>(*this);
    if (dtype == "i4") return all_as<T, std::int32_t>(*this);
    if (dtype == "i8") return all_as<T, std::int64_t>(*this);
    if (dtype == "u1" || dtype == "b1") return all_as<T, std::uint8_t>(*this);
    if (dtype == "u2") return all_as<T, std::uint16_t>(*this);
    if (dtype == "u4") return all_as<T, std::uint32_t>(*this);
    if (dtype == "u8") return all_as<T, std::uint64_t>(*this);
    throw InputError("the array's type " + detail::shown(dtype) +
                     " is not known; known are b1 i1 i2 i4 i8 u1 u2 u4 u8 f4 f8");
}

std::string detail::npy_header(const std::string& dtype, const std::vector<std::size_t>& shape) {
    return npy_header_of(std::string(dtype[1] == '1' ? "'|" : "'<") + dtype + "'", shape);
}
std::string detail::npy_header_of(const std::string& descr, const std::vector<std::size_t>& shape,
                                  std::size_t length) {
    std::string text = "{'descr': " + descr + ", 'fortran_order': False, 'shape': (";
    for (const std::size_t n : shape) text += std::to_string(n) + ", ";
    text += "), }";
    if (shape.size() > 1) text.erase(text.size() - 6, 2);  // numpy writes (3, 4) but (3, )
    constexpr std::size_t start = 10;  // bytes before the text: magic word, version, length
    if (start + text.size() + 1 < length) text.append(length - start - text.size() - 1, ' ');
    // Elements begin at a multiple of 64 bytes.
    text.append(63 - (start + text.size()) % 64, ' ');
    text += '\n';
    std::string header("\x93NUMPY\x01\x00", 8);
    header.push_back(static_cast<char>(text.size() & 0xFF));
    header.push_back(static_cast<char>(text.size() >> 8));
    return header + text;
}

NpyArray load_npy(const std::filesystem::path& path, const Progress& progress) {
    return detail::within_memory(path, [&] {
        detail::ByteSource file(path, progress);
        return detail::read_npy(file);
    });
}

template <class T>
void save_npy(const std::filesystem::path& path, std::span<const T> values,
              const std::vector<std::size_t>& shape) {
    std::size_t size = 1;
    bool fits = true;
    for (const std::size_t n : shape) {
        fits = fits && (n == 0 || size <= std::numeric_limits<std::size_t>::max() / n);
        size *= n;
    }
    if (!fits || size != values.size() || shape.size() > detail::most_axes)
        throw InputError(path.string() + ": the shape does not hold the " + std::to_string(values.size()) +
                         " values that are to be saved. Make its sizes multiply to that number");
    detail::OutputFile file(path);
    file.write(detail::npy_header(detail::npy_dtype<T>(), shape));
    for (const T v : values) file.little(v);
    file.commit();
}

#define HEDGEROW_INSTANTIATE(T)                   \
    template std::vector<T> NpyArray::as() const; \
    template void save_npy(const std::filesystem::path&, std::span<const T>, const std::vector<std::size_t>&);
HEDGEROW_INSTANTIATE(float)
HEDGEROW_INSTANTIATE(double)
HEDGEROW_INSTANTIATE(std::int8_t)
HEDGEROW_INSTANTIATE(std::int16_t)
HEDGEROW_INSTANTIATE(std::int32_t)
HEDGEROW_INSTANTIATE(std::int64_t)
HEDGEROW_INSTANTIATE(std::uint8_t)
HEDGEROW_INSTANTIATE(std::uint16_t)
HEDGEROW_INSTANTIATE(std::uint32_t)
HEDGEROW_INSTANTIATE(std::uint64_t)
#undef HEDGEROW_INSTANTIATE

}  // namespace hedgerow
