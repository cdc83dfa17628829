/// Regions of every shape that three points and a size define, so that a few numbers are one.
#pragma once

#include <array>
#include <ostream>

#include "shapes.h"

namespace hedgerow::hunter {

enum class RegionKind { half_space, planes, oriented_box, frustum, cone };
inline constexpr std::size_t region_kinds = 5;

/// A region as numbers: a half-space is bounded at a, across b - a; planes pass through a, b and c; the axes
/// of a box or a frustum are along b - a and c - a; a cone opens from a towards b.
template <class T, int D>
struct RegionThrough {
    RegionKind kind;
    Vec<T, D> a, b, c;
    T size;
};

/// Unit axes at right angles, the first along `x` and the second beside `y`; those of the coordinates if the
/// vectors do not say.
template <int D>
std::array<Vec<double, D>, std::size_t(D)> axes_along(const Vec<double, D>& x, const Vec<double, D>& y) {
    using V = Vec<double, D>;
    std::array<V, std::size_t(D)> axes{};
    const auto unit = [](const V& v) { return normalized(v * (1 / max_component(abs(v)))); };
    axes[0] = unit(x);
    if constexpr (D == 2) {
        axes[1] = V(-axes[0][1], axes[0][0]);
    } else {
        axes[2] = unit(cross(axes[0], unit(y)));
        axes[1] = cross(axes[2], axes[0]);
    }
    for (const V& axis : axes)
        if (!(std::abs(length2(axis) - 1) < 0x1p-40))
            for (int k = 0; k < D; ++k) {
                axes[static_cast<std::size_t>(k)] = V();
                axes[static_cast<std::size_t>(k)][k] = 1;
            }
    return axes;
}

/// Calls f with the region.
template <class T, int D, class F>
void with_region(const RegionThrough<T, D>& r, F f) {
    using V = Vec<T, D>;
    using Vd = Vec<double, D>;
    const auto face = [](const V& through, const V& normal) {
        return HalfSpace<T, D>{normal, rounded_to<T>(dot(Vd(normal), Vd(through)))};
    };
    if (r.kind == RegionKind::half_space) return f(face(r.a, r.b - r.a));
    if (r.kind == RegionKind::planes) {
        const std::array faces{face(r.a, r.b - r.a), face(r.b, r.c - r.b), face(r.c, r.a - r.c)};
        return f(Hull<T, D>{faces});
    }
    if (r.kind == RegionKind::cone) {
        const T height = max_component(abs(r.c - r.a));
        const T endless = std::numeric_limits<T>::infinity();
        return f(Cone<T, D>(r.a, r.b - r.a, std::abs(r.size), height > 0 ? height : endless));
    }
    const auto axes = axes_along(Vd(r.b) - Vd(r.a), Vd(r.c) - Vd(r.a));
    const double half[] = {length(Vd(r.b) - Vd(r.a)), length(Vd(r.c) - Vd(r.a)), double(std::abs(r.size))};
    if (r.kind == RegionKind::oriented_box) {
        Obb<T, D> box;
        for (int k = 0; k < D; ++k) {
            box.axis[k] = V(axes[static_cast<std::size_t>(k)]);
            const double at = dot(axes[static_cast<std::size_t>(k)], Vd(r.a));
            box.low[k] = rounded_to<T>(at - half[k]), box.high[k] = rounded_to<T>(at + half[k]);
        }
        return f(box);
    }
    // Faces of a frustum are across the axes, and lean.
    typename Frustum<T, D>::Faces faces;
    for (std::size_t k = 0; k < std::size_t(D); ++k) {
        const Vd lean = axes[(k + 1) % std::size_t(D)] * 0.25;
        faces[2 * k] = face(r.b, V(axes[k] + lean));
        faces[2 * k + 1] = face(r.a, V(lean - axes[k]));
    }
    f(Frustum<T, D>(faces));
}

template <class T, int D, class F>
void for_each_number(RegionThrough<T, D>& r, F f) {
    for (auto* v : {&r.a, &r.b, &r.c}) for_each_number(*v, f);
    f(r.size);
}
template <class T, int D>
void write(std::ostream& out, const RegionThrough<T, D>& r) {
    out << "{RegionKind(" << static_cast<int>(r.kind) << "), ";
    write(out, r.a), out << ", ", write(out, r.b), out << ", ", write(out, r.c), out << ", ";
    write(out, r.size);
    out << '}';
}

}  // namespace hedgerow::hunter
