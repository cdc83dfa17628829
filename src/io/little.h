/// Numbers in little-endian order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace hedgerow::detail {

/// The number in `sizeof(U)` bytes, the lowest first.
template <class U>
U little(const char* bytes) {
    unsigned char raw[sizeof(U)];
    std::memcpy(raw, bytes, sizeof(U));
    if constexpr (std::endian::native != std::endian::little) std::reverse(raw, raw + sizeof(U));
    U value;
    std::memcpy(&value, raw, sizeof(U));
    return value;
}
/// The bytes of a number, the lowest first.
template <class U>
std::array<char, sizeof(U)> little_bytes(U value) {
    std::array<char, sizeof(U)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(U));
    if constexpr (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

}  // namespace hedgerow::detail
