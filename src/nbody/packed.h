/// How kernels pack numbers of harmonics: of each degree n the real part of m = 0, then both parts of m = 1
/// to n.
#pragma once

namespace hedgerow {

constexpr int packed_count(int order) {
    return (order + 1) * (order + 1);
}
constexpr int re(int n, int m) {
    return n * n + (m == 0 ? 0 : 2 * m - 1);
}
constexpr int im(int n, int m) {
    return n * n + 2 * m;
}

}  // namespace hedgerow
