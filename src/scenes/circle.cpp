#include "circle.h"

#include <cmath>

namespace hedgerow::detail {

std::vector<Vec2d> circle(std::uint64_t n) {
    const double tan_eighth = std::sqrt(2.0) - 1;  // tan(π/8)
    // The octant from (1, 0), and its mirror image about the diagonal.
    std::vector<Vec2d> quarter(2 * n + 1);
    for (std::uint64_t i = 0; i <= n; ++i) {
        const double t = product(tan_eighth, static_cast<double>(i) / static_cast<double>(n));
        const double t2 = product(t, t);
        const Vec2d p((1 - t2) / (1 + t2), 2 * t / (1 + t2));
        quarter[2 * n - i] = Vec2d(p[1], p[0]);
        quarter[i] = p;
    }
    // The quarter, turned to all four places.
    std::vector<Vec2d> points;
    for (const Vec2d& turn : {Vec2d(1, 0), Vec2d(0, 1), Vec2d(-1, 0), Vec2d(0, -1)})
        for (std::uint64_t i = 0; i < 2 * n; ++i) {
            const Vec2d p = quarter[i];
            points.push_back({turn[0] * p[0] - turn[1] * p[1], turn[1] * p[0] + turn[0] * p[1]});
        }
    return points;
}

}  // namespace hedgerow::detail
