/// Which pixels triangles may cover: PixelBounds with triangles in lanes.
#if defined(HEDGEROW_RENDER_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_BOUNDS_INL_H
#undef HEDGEROW_RENDER_BOUNDS_INL_H
#else
#define HEDGEROW_RENDER_BOUNDS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/render/visibility/raster_kernels.h>

#include "engine/coordinates-inl.h"
#include "engine/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// In floats. PixelBounds allows for four times the errors of the test of rays, which leaves room for those
// made here: a corner is moved by less than 8u of its distance, and its place in pixels by less than 4u of
// it.
class BoundsInLanes {
public:
    using F = PacketRays::F;
    using V = hn::Vec<F>;
    using M = hn::Mask<F>;
    static constexpr std::size_t lanes = hn::MaxLanes(F());

    explicit BoundsInLanes(const PixelBounds::Frame& frame) : frame_(frame) {}

    // Corners of triangles in rows, by corner and axis. A vector that is loaded from what was just stored in
    // parts has to wait for the stores, so many triangles are gathered at once.
    struct Rows {
        static constexpr std::size_t size = 64;
        alignas(64) float at[3][3][size];

        HWY_INLINE void gather(const TriangleMeshView<float>& mesh, std::size_t first, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) {
                const auto corners = mesh.indices(first + i);
                for (std::size_t c = 0; c < 3; ++c) {
                    const Vec<float, 3> p = mesh.vertex(corners[c]);
                    for (std::size_t k = 0; k < 3; ++k) at[c][k][i] = p[static_cast<int>(k)];
                }
            }
        }
    };
    // The sights of as many triangles as there are lanes, from a place of the rows on.
    HWY_INLINE void write(const Rows& rows, std::size_t from, Sight* sights) const {
        V farthest2 = hn::Zero(f), nearest = all(std::numeric_limits<float>::infinity());
        Corners corners;
        for (int c = 0; c < 3; ++c) {
            const auto from_eye = [&](int k) __attribute__((always_inline)) {
                return hn::Sub(hn::Load(f, rows.at[c][k] + from), all(frame_.eye[k]));
            };
            const Coordinates<F> p{from_eye(0), from_eye(1), from_eye(2)};
            farthest2 = hn::Max(farthest2, dot<F>(p, p));
            const V forward = along(p, frame_.forward);
            nearest = hn::Min(nearest, forward);
            const V pixels = by_forward(all(frame_.pixels), forward);
            corners.x[c] = hn::MulAdd(along(p, frame_.right), pixels, all(frame_.middle[0]));
            corners.y[c] = hn::NegMulAdd(along(p, frame_.up), pixels, all(frame_.middle[1]));
        }
        const V farthest = hn::Sqrt(farthest2);
        // Before the eye, and within what squares of floats can hold.
        constexpr float tiny = 1e-30f;
        M before = hn::Gt(farthest2, all(tiny));
        if (!frame_.parallel)
            before = hn::And(before, hn::Gt(nearest, hn::Mul(farthest, all(frame_.cut_share))));
        const V error = hn::MulAdd(farthest, all(frame_.corner_share), all(frame_.error));
        const V room = by_forward(hn::Mul(error, all(2 * frame_.reach * frame_.pixels)), nearest);
        before = hn::And(before, hn::Lt(room, all(std::numeric_limits<float>::infinity())));
        const V left = first_at(hn::Sub(least(corners.x), room), frame_.width),
                top = first_at(hn::Sub(least(corners.y), room), frame_.height),
                bottom = last_at(hn::Add(greatest(corners.y), room), frame_.height);
        V right = last_at(hn::Add(greatest(corners.x), room), frame_.width);
        if (frame_.least == frame_.most)
            right = hn::IfThenElse(misses(corners, room, left, top, right, bottom), all(-1.0), right);
        // Write them.
        const auto side = [&](V pixels) __attribute__((always_inline)) {
            return hn::ConvertTo(i32, hn::IfThenElse(before, pixels, all(double(uncut.left))));
        };
        alignas(64) PixelBox boxes[lanes];
        hn::StoreInterleaved4(side(left), side(top), side(right), side(bottom), i32, &boxes[0].left);
        alignas(64) float nearest_points[lanes];
        hn::Store(hn::Max(hn::NegMulAdd(error, all(4.0), nearest), hn::Zero(f)), f, nearest_points);
        for (std::size_t i = 0; i < lanes; ++i) sights[i] = {boxes[i], nearest_points[i]};
    }

private:
    static constexpr F f{};
    static constexpr hn::RebindToSigned<F> i32{};
    // In pixels.
    struct Corners {
        V x[3], y[3];

        HWY_INLINE Corners() {}
    };

    static HWY_INLINE V all(float x) { return hn::Set(f, x); }
    static HWY_INLINE V all(double x) { return hn::Set(f, static_cast<float>(x)); }
    // Boxes of up to 2 × 2 samples, in the middles of their pixels, of which none is covered: as PixelEdges
    // tells. Most triangles of a scan are that small.
    HWY_INLINE M misses(const Corners& p, V room, V left, V top, V right, V bottom) const {
        const V one = all(1.0), zero = hn::Zero(f), wide = hn::Sub(right, left), high = hn::Sub(bottom, top);
        const M few = hn::And(hn::Le(wide, one), hn::Le(high, one));
        const V x_least = least(p.x), x_most = greatest(p.x), y_least = least(p.y), y_most = greatest(p.y);
        const V largest =
            hn::Max(hn::Max(hn::Abs(x_least), hn::Abs(x_most)), hn::Max(hn::Abs(y_least), hn::Abs(y_most)));
        const V rounding = hn::Mul(largest, all(8 * unit_roundoff<float>));
        const V area = hn::Sub(hn::Mul(hn::Sub(p.x[1], p.x[0]), hn::Sub(p.y[2], p.y[0])),
                               hn::Mul(hn::Sub(p.y[1], p.y[0]), hn::Sub(p.x[2], p.x[0])));
        const V extent = hn::Add(hn::Sub(x_most, x_least), hn::Sub(y_most, y_least));
        const V sample_x = hn::Add(left, all(frame_.least)), sample_y = hn::Add(top, all(frame_.least));
        const V side = hn::CopySignToAbs(one, area);
        // For each of the four samples, the least value of an edge.
        V inside[4];
        for (int i = 0; i < 3; ++i) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            const V edge_x = hn::Mul(side, hn::Sub(p.y[a], p.y[b])),
                    edge_y = hn::Mul(side, hn::Sub(p.x[b], p.x[a]));
            const V error = hn::Mul(hn::Add(hn::Abs(edge_x), hn::Abs(edge_y)), hn::Add(room, rounding));
            const V here = hn::MulAdd(edge_x, hn::Sub(sample_x, p.x[a]),
                                      hn::MulAdd(edge_y, hn::Sub(sample_y, p.y[a]), error));
            const V at[4] = {here, hn::Add(here, edge_x), hn::Add(here, edge_y),
                             hn::Add(hn::Add(here, edge_x), edge_y)};
            for (int k = 0; k < 4; ++k) inside[k] = i == 0 ? at[k] : hn::Min(inside[k], at[k]);
        }
        const M second = hn::Gt(wide, zero), below = hn::Gt(high, zero);
        M covered = hn::Ge(inside[0], zero);
        covered = hn::Or(covered, hn::And(second, hn::Ge(inside[1], zero)));
        covered = hn::Or(covered, hn::And(below, hn::Ge(inside[2], zero)));
        covered = hn::Or(covered, hn::And(hn::And(second, below), hn::Ge(inside[3], zero)));
        // The sign of the area is sure beyond what the roundings of places make.
        const M told = hn::And(few, hn::Gt(hn::Abs(area), hn::Mul(rounding, hn::Mul(extent, all(4.0)))));
        return hn::AndNot(covered, told);
    }
    HWY_INLINE V by_forward(V x, V forward) const { return frame_.parallel ? x : hn::Div(x, forward); }
    static HWY_INLINE V least(const V (&v)[3]) { return hn::Min(v[0], hn::Min(v[1], v[2])); }
    static HWY_INLINE V greatest(const V (&v)[3]) { return hn::Max(v[0], hn::Max(v[1], v[2])); }
    static HWY_INLINE V along(const Coordinates<F>& p, const Vec3d& axis) {
        return hn::MulAdd(p.z, all(axis[2]), hn::MulAdd(p.y, all(axis[1]), hn::Mul(p.x, all(axis[0]))));
    }
    HWY_INLINE V first_at(V place, int count) const {
        const V at = hn::Sub(place, all(frame_.most));
        return hn::Ceil(hn::Min(hn::Max(at, hn::Zero(f)), all(double(count))));
    }
    HWY_INLINE V last_at(V place, int count) const {
        const V at = hn::Sub(place, all(frame_.least));
        return hn::Floor(hn::Min(hn::Max(at, all(-1.0)), all(double(count - 1))));
    }

    const PixelBounds::Frame& frame_;
};

// See RasterKernels.
inline void pixel_bounds(const PixelBounds& bounds, const TriangleMeshView<float>& mesh, std::size_t first,
                         std::span<Sight> sights) {
    const BoundsInLanes in_lanes(bounds.frame());
    static_assert(sizeof(PixelBox) == 4 * sizeof(std::int32_t));
    BoundsInLanes::Rows rows;
    for (std::size_t i = 0; i < sights.size(); i += rows.size) {
        const std::size_t count = std::min(rows.size, sights.size() - i);
        rows.gather(mesh, first + i, count);
        std::size_t k = 0;
        for (; k + BoundsInLanes::lanes <= count; k += BoundsInLanes::lanes)
            in_lanes.write(rows, k, &sights[i + k]);
        for (; k < count; ++k) sights[i + k].box = uncut;
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
