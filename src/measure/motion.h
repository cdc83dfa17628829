/// Moves primitives, for the measurement of updates.
#pragma once

#include <hedgerow/any_index.h>

namespace hedgerow::measure {

/// Bends space within a box. Each coordinate moves by up to a tenth of the box's extent, as a parabola of the
/// next coordinate: 0.4 · u · (1 − u) is at most 0.1. Neighbours stay neighbours.
template <class T, int D>
class Bend {
public:
    explicit Bend(const Box<T, D>& box) : box_(box) {}

    void operator()(TriangleMesh<T>& mesh) const {
        for (auto& p : mesh.vertices) move(p);
    }
    void operator()(SphereSet<T, D>& set) const {
        for (auto& s : set.spheres) move(s.center);
    }
    void operator()(PointCloud<T, D>& cloud) const {
        for (auto& p : cloud.points) move(p);
    }
    void operator()(SegmentSet<T>& set) const requires(D == 2) {
        for (auto& s : set.segments) move(s.a), move(s.b);
    }

private:
    void move(Vec<T, D>& p) const {
        const Vec<T, D> from = p, extent = box_.extent();
        for (int k = 0; k < D; ++k) {
            const int next = (k + 1) % D;
            const T u = extent[next] > 0 ? (from[next] - box_.low[next]) / extent[next] : T(0);
            p[k] = from[k] + T(0.4) * extent[k] * u * (1 - u);
        }
    }
    Box<T, D> box_;
};

}  // namespace hedgerow::measure
