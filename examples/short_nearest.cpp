// The five points of a cloud that are nearest to a point.
#include <cmath>
#include <cstdio>

#include <hedgerow/hedgerow.h>

int main() {
    hedgerow::PointCloud<double, 3> cloud;
    for (int i = 0; i < 1000; ++i) cloud.points.push_back({std::cos(i), std::sin(i), 0.001 * i});
    const auto index = hedgerow::build<hedgerow::KdTree>(cloud);
    std::vector<hedgerow::Near<double, 3>> found;
    hedgerow::nearest(index, {1, 0, 0.5}, 5, found);
    for (const auto& near : found) std::printf("point %u: %g\n", near.element, std::sqrt(near.distance2));
    return found.size() != 5;
}
