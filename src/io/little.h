/// Numbers in little-endian order.
#pragma once

#include <algorithm>
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

}  // namespace hedgerow::detail
