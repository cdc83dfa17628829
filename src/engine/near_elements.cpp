/// Distances of points to a few elements, one after the other.
#include "near_elements.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/geometry/distance.h>

namespace hedgerow {
namespace {

using Row = double[NearElements::most];

Vec3d at(const Row (&rows)[3], int i) {
    return {rows[0][i], rows[1][i], rows[2][i]};
}
double reciprocal(double x) {
    return x > detail::least_product ? 1 / x : 0;
}
void prepare(NearElements& near) {
    near.slivers = 0;
    for (int i = 0; i < near.count; ++i) {
        const Vec3d ab = at(near.b, i) - at(near.a, i), ac = at(near.c, i) - at(near.a, i);
        const double ab2 = length2(ab), ac2 = length2(ac), abac = dot(ab, ac);
        const double both = product(ab2, ac2), area2 = both - product(abac, abac);
        for (int k = 0; k < 3; ++k) near.ab[k][i] = ab[k], near.ac[k][i] = ac[k];
        near.ab2[i] = ab2, near.ac2[i] = ac2, near.abac[i] = abac;
        near.per_ab2[i] = reciprocal(ab2), near.per_ac2[i] = reciprocal(ac2);
        near.per_bc2[i] = reciprocal(length2(ac - ab));
        near.per_area2[i] = reciprocal(area2);
        const bool plain = area2 > std::max(product(detail::least_area, both), detail::least_product);
        if (!plain && !near.points) near.slivers |= 1u << i;
    }
}

double part_of_edge(double x) {
    return std::min(std::max(x, 0.0), 1.0);
}
double distance2(const NearElements& near, int i, const Vec3d& p) {
    const Vec3d ab = at(near.ab, i), ac = at(near.ac, i), bc = ac - ab;
    const Vec3d ap = p - at(near.a, i), bp = ap - ab;
    const double along_ab = dot(ap, ab), along_ac = dot(ap, ac);
    const double ab2 = near.ab2[i], ac2 = near.ac2[i], abac = near.abac[i];
    const double v = product(product(along_ab, ac2) - product(along_ac, abac), near.per_area2[i]);
    const double w = product(product(along_ac, ab2) - product(along_ab, abac), near.per_area2[i]);
    if (v >= 0 && w >= 0 && v + w <= 1) return length2(ap - ab * v - ac * w);
    const double on_ab = part_of_edge(product(along_ab, near.per_ab2[i]));
    const double on_ac = part_of_edge(product(along_ac, near.per_ac2[i]));
    const double along_bc = (along_ac - along_ab) + (ab2 - abac);
    const double on_bc = part_of_edge(product(along_bc, near.per_bc2[i]));
    return std::min({length2(ap - ab * on_ab), length2(ap - ac * on_ac), length2(bp - bc * on_bc)});
}
double above(double distance, const DistanceMargin& margin) {
    return product(distance, 1 + margin.relative) + margin.absolute;
}
void measure(const NearElements& near, const DistanceMargin& margin, const Vec3d* points, int count,
             ToElements* found) {
    for (int n = 0; n < count; ++n) {
        auto& distance = found[n].distance;
        std::fill(std::begin(distance), std::end(distance), std::numeric_limits<double>::infinity());
        for (int i = 0; i < near.count; ++i)
            if ((near.slivers >> i & 1u) == 0)
                distance[i] = above(std::sqrt(distance2(near, i, points[n])), margin);
        detail::measure_slivers(near, margin, points[n], distance);
        found[n].nearest =
            static_cast<int>(std::min_element(distance, distance + near.count) - std::begin(distance));
    }
}

}  // namespace

void detail::measure_slivers(const NearElements& near, const DistanceMargin& margin, const Vec3d& p,
                             double (&distance)[NearElements::most]) {
    for (unsigned left = near.slivers; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        distance[i] = above(length(p - closest_point(p, near.triangle(i)).point), margin);
    }
}
const ElementKernels detail::plain_element_kernels = {prepare, measure};

const ElementKernels& element_kernels() {
    const ElementKernels* const kernels = in_use<ElementKernels>();
    return kernels != nullptr ? *kernels : detail::plain_element_kernels;
}

}  // namespace hedgerow
