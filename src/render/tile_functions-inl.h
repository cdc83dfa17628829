/// Where eight triangles cover the samples of a tile for sure, and how near they are there.
#if defined(HEDGEROW_RENDER_TILE_FUNCTIONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_TILE_FUNCTIONS_INL_H
#undef HEDGEROW_RENDER_TILE_FUNCTIONS_INL_H
#else
#define HEDGEROW_RENDER_TILE_FUNCTIONS_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <hwy/highway.h>

#include <hedgerow/geometry/rounding.h>
#include <hedgerow/render/visibility/raster_kernels.h>

#include "tile_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Functions of eight triangles that are linear in the place (x, y) of a sample, in pixels from the middle of
// a box of samples. A corner P is (right, down, 1) times its distance forward of the eye, with right and down
// in pixels; of parallel rays, without that factor.
//
// *Edges* (Olano and Greer 1997): the triple products of (x, y, 1) and two corners, which are not below 0
// within the triangle, by the sign of the three corners'. What the test of a ray sees is the triangle with
// each corner moved by up to `room` pixels along either axis (PixelBounds). While the corners move there, a
// sample changes sides only where an edge passes it, and a point of the moved edge is within `room` of the
// same point of the given one. So the test can only say something else where an edge is within room times the
// sum of its slopes of 0. Each is divided by that, and by what bounds its roundings: above 1, all three say
// that the test finds a hit, and one of them below -1 that it does not.
//
// *Nearness*: 1/f, the inverse of the distance forward of the eye, which is linear in the picture; of
// parallel rays, -f. The t of the test is that of a point of the moved triangle, within e of the same point
// of the given one, whose place is within room of the sample's. And its barycentrics come from products that
// are rounded: 4u·L² each, where L is how far a corner may be from a sample; a share of their sum, the triple
// product of the corners times 1/f. They average distances, so the error is that share of the triangle's
// extent. `slack` bounds all of that.
class TileFunctions {
public:
    using F = PacketRays::F;
    using V = PacketRays::V;
    using M = PacketRays::M;
    static constexpr F f{};
    static constexpr int lanes = PacketRays::lanes, parts = PacketRays::parts;

    // Boxes of samples, one for each triangle: their middles from the top left of the picture, how far
    // samples are from these at most, and how far right and down of them the places are that functions are
    // asked at.
    struct Boxes {
        alignas(64) float middle[2][8], reach[2][8], from[2][8];
    };
    // A row for each number, a column for each triangle.
    alignas(64) float edge[3][3][8], nearness[3][8], slack[8];
    // How near a triangle is at most where it covers a sample; -infinity if it covers none.
    alignas(64) float nearest[8];

    // Of the first `count` triangles of a block, each over a box of its own. The edges of a triangle that is
    // not sound, such as one seen edge-on, are not numbers, and compare as neither.
    HWY_INLINE void prepare(const PixelBounds::Frame& frame, const Boxes& boxes,
                            const TriangleBlock<float>& block, int count) {
        for (int at = 0; at < count; at += static_cast<int>(hn::MaxLanes(d)))
            prepare_from(frame, boxes, block, at, count == 1);
    }

    // A vector of samples and one triangle.
    struct Seen {
        M in, out;              // covered for sure, not covered for sure
        V nearness, near, far;  // of the triangle's plane, and where it is covered at least and at most
    };
    HWY_INLINE Seen at(int triangle, int part) const {
        const V x = hn::Load(f, places().x + part * lanes), y = hn::Load(f, places().y + part * lanes);
        const auto value = [&](const float(&of)[3][8]) __attribute__((always_inline)) {
            return hn::MulAdd(hn::Set(f, of[0][triangle]), x,
                              hn::MulAdd(hn::Set(f, of[1][triangle]), y, hn::Set(f, of[2][triangle])));
        };
        const V least = hn::Min(value(edge[0]), hn::Min(value(edge[1]), value(edge[2])));
        const V at = value(nearness), by = hn::Set(f, slack[triangle]);
        return {hn::Gt(least, hn::Set(f, 1.0f)), hn::Lt(least, hn::Set(f, -1.0f)), at, hn::Sub(at, by),
                hn::Add(at, by)};
    }

private:
    using D = hn::CappedTag<float, 8>;
    using W = hn::Vec<D>;
    static constexpr D d{};

    struct Places {
        alignas(64) float x[PacketRays::size], y[PacketRays::size];

        constexpr Places() : x{}, y{} {
            for (int i = 0; i < PacketRays::size; ++i)
                x[i] = static_cast<float>(i % tile_side) - middle,
                y[i] = static_cast<float>(i / tile_side) - middle;
        }
        static constexpr float middle = (tile_side - 1) / 2.0f;
    };
    static const Places& places() {
        static constexpr Places all;
        return all;
    }
    static HWY_INLINE W all(float x) { return hn::Set(d, x); }
    static HWY_INLINE W all(double x) { return hn::Set(d, static_cast<float>(x)); }
    static HWY_INLINE W along(W x, W y, W z, const Vec3d& axis) {
        return hn::MulAdd(z, all(axis[2]), hn::MulAdd(y, all(axis[1]), hn::Mul(x, all(axis[0]))));
    }
    static HWY_INLINE W least(const W (&v)[3]) { return hn::Min(v[0], hn::Min(v[1], v[2])); }
    static HWY_INLINE W greatest(const W (&v)[3]) { return hn::Max(v[0], hn::Max(v[1], v[2])); }
    static HWY_INLINE W slopes(W right, W down) { return hn::Add(hn::Abs(right), hn::Abs(down)); }

    HWY_INLINE void prepare_from(const PixelBounds::Frame& frame, const Boxes& boxes,
                                 const TriangleBlock<float>& block, int at, bool alone) {
        constexpr float u = unit_roundoff<float>, infinity = std::numeric_limits<float>::infinity();
        // PixelBounds allows for four times the errors of the test; half of that holds those made here, too.
        const W corner_share = all(frame.corner_share / 2);
        const float to_pixels = static_cast<float>(2 * frame.reach * frame.pixels);
        const W one = all(1.0f), zero = hn::Zero(d);
        // What was stored number by number: one triangle alone fills all lanes, and does not wait for that.
        const auto lanes_of = [&](const float(&row)[8]) __attribute__((always_inline)) {
            return alone ? hn::Set(d, row[0]) : hn::Load(d, row + at);
        };
        const W reach_x = lanes_of(boxes.reach[0]), reach_y = lanes_of(boxes.reach[1]),
                reach = hn::Max(reach_x, reach_y);
        const W middle_x = hn::Sub(all(frame.middle[0]), lanes_of(boxes.middle[0])),
                middle_y = hn::Sub(all(frame.middle[1]), lanes_of(boxes.middle[1]));
        // The corners.
        W forward[3], h[3], x[3], y[3], away[3], length[3], farthest2 = zero, steepest2 = zero, inverse = one;
        for (int c = 0; c < 3; ++c) {
            const auto from_eye = [&](int k) __attribute__((always_inline)) {
                return hn::Sub(lanes_of(block.corner[k][c]), all(frame.eye[k]));
            };
            const W px = from_eye(0), py = from_eye(1), pz = from_eye(2);
            const W length2 = hn::MulAdd(pz, pz, hn::MulAdd(py, py, hn::Mul(px, px)));
            farthest2 = hn::Max(farthest2, length2);
            length[c] = hn::Add(slopes(px, py), hn::Abs(pz));
            forward[c] = along(px, py, pz, frame.forward);
            h[c] = frame.parallel ? one : forward[c];
            x[c] = hn::MulAdd(along(px, py, pz, frame.right), all(frame.pixels), hn::Mul(middle_x, h[c]));
            y[c] = hn::NegMulAdd(along(px, py, pz, frame.up), all(frame.pixels), hn::Mul(middle_y, h[c]));
            away[c] = hn::MulAdd(hn::Abs(h[c]), hn::Add(reach_x, reach_y), slopes(x[c], y[c]));
            if (frame.parallel) continue;
            const W by_forward = hn::Div(one, forward[c]);
            inverse = c == 0 ? by_forward : hn::Max(inverse, by_forward);
            steepest2 = hn::Max(steepest2, hn::Mul(length2, hn::Mul(by_forward, by_forward)));
        }
        const W least_forward = least(forward), extent = hn::Sub(greatest(forward), least_forward);
        // The triple products, and that of the corners.
        W a[3], b[3], c[3];
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            a[i] = hn::MulSub(y[j], h[k], hn::Mul(h[j], y[k]));
            b[i] = hn::MulSub(h[j], x[k], hn::Mul(x[j], h[k]));
            c[i] = hn::MulSub(x[j], y[k], hn::Mul(y[j], x[k]));
        }
        // As a sum of those at the middle of the box, whose errors weigh little there.
        const W volume = hn::MulAdd(h[0], c[0], hn::MulAdd(h[1], c[1], hn::Mul(h[2], c[2])));
        const W by_volume = hn::Div(one, volume);
        W near[3] = {zero, zero, zero};
        for (int i = 0; i < 3; ++i) {
            const W share = frame.parallel ? hn::Mul(hn::Sub(forward[0], forward[i]), by_volume) : by_volume;
            near[0] = hn::MulAdd(a[i], share, near[0]), near[1] = hn::MulAdd(b[i], share, near[1]),
            near[2] = hn::MulAdd(c[i], share, near[2]);
        }
        if (frame.parallel) near[2] = hn::Sub(near[2], forward[0]);
        // How near a point is that the test may see at a sample, and how far it is moved, as a share of its
        // distance.
        const auto growth = [&](W right, W down) __attribute__((always_inline)) {
            return hn::MulAdd(hn::Abs(right), reach_x, hn::Mul(hn::Abs(down), reach_y));
        };
        const W slope = slopes(near[0], near[1]), grows = growth(near[0], near[1]);
        W most_near = one, moved = hn::MulAdd(hn::Sqrt(farthest2), corner_share, all(frame.error));
        if (!frame.parallel) {
            const auto before = hn::Gt(least_forward, zero);
            const auto gentle = hn::Le(hn::Mul(hn::Mul(moved, slope), all(to_pixels)), all(0.5f));
            const W within = hn::Mul(hn::Add(hn::Abs(near[2]), grows), all(2.0f));
            most_near = hn::Min(hn::IfThenElse(before, inverse, all(infinity)),
                                hn::IfThenElse(gentle, within, all(infinity)));
            W share = zero;
            for (int i = 0; i < 3; ++i)
                share = hn::MulAdd(hn::Add(hn::Abs(c[i]), hn::Add(growth(a[i], b[i]), slopes(a[i], b[i]))),
                                   length[i], share);
            share = hn::Min(hn::Mul(share, hn::Abs(by_volume)),
                            hn::IfThenElse(before, hn::Sqrt(steepest2), all(infinity)));
            moved = hn::MulAdd(share, corner_share, hn::Mul(most_near, all(frame.error)));
        }
        const W room = hn::MulAdd(moved, all(to_pixels), hn::MulAdd(reach, all(8 * u), all(32 * u)));
        W band[3];
        for (int i = 0; i < 3; ++i)
            band[i] = hn::MulAdd(slopes(a[i], b[i]), room,
                                 hn::Mul(hn::Mul(away[(i + 1) % 3], away[(i + 2) % 3]), all(8 * u)));
        // Floats hold the numbers with all their bits, and from which side the triangle is seen is sure.
        constexpr float tiny = 1e-30f, huge = 1e30f;
        const W size = hn::Abs(volume), farthest_away = greatest(away),
                most_h = frame.parallel ? one : hn::Max(hn::Abs(least_forward), hn::Abs(greatest(forward)));
        const W size_error = hn::Mul(hn::Mul(farthest_away, farthest_away), hn::Mul(most_h, all(16 * u)));
        auto sound = hn::And(hn::And(hn::Gt(size, hn::Max(all(tiny), size_error)), hn::Lt(size, all(huge))),
                             hn::And(hn::Gt(least(band), all(tiny)), hn::Lt(greatest(band), all(huge))));
        // Parallel rays start on the eye's plane.
        sound = hn::And(sound, frame.parallel ? hn::Gt(least_forward, moved) : hn::Le(moved, all(0.25f)));
        const W side =
            hn::IfThenElse(sound, hn::CopySign(one, volume), all(std::numeric_limits<float>::quiet_NaN()));
        // Write them.
        const W from_x = lanes_of(boxes.from[0]), from_y = lanes_of(boxes.from[1]);
        const auto write = [&](float(&rows)[3][8], W right, W down, W constant)
            __attribute__((always_inline)) {
            hn::Store(right, d, rows[0] + at), hn::Store(down, d, rows[1] + at);
            hn::Store(hn::MulAdd(right, from_x, hn::MulAdd(down, from_y, constant)), d, rows[2] + at);
        };
        auto outside = hn::Ne(one, one);
        for (int i = 0; i < 3; ++i) {
            const W scale = hn::Div(side, band[i]);
            const W right = hn::Mul(a[i], scale), down = hn::Mul(b[i], scale),
                    constant = hn::Mul(c[i], scale);
            outside = hn::Or(outside, hn::Lt(hn::Add(growth(right, down), constant), all(-1.0f)));
            write(edge[i], right, down, constant);
        }
        // Roundings of products: an edge has an error of 4u·L·L' here, where L and L' are how far its corners
        // are from a sample, and 4u·L times the box of that changes within the box. What does not is in the
        // volume, too, so it counts for how unevenly near the third corner and the sample are; and so do the
        // test's own errors.
        W of_products = hn::Mul(hn::Mul(farthest_away, hn::Add(reach_x, reach_y)),
                                hn::Mul(frame.parallel ? extent : most_h, all(24 * u)));
        for (int i = 0; i < 3; ++i) {
            const W uneven =
                frame.parallel ? hn::Add(hn::Abs(hn::Add(near[2], forward[i])), grows)
                               : hn::MulAdd(grows, hn::Abs(h[i]), hn::Abs(hn::NegMulAdd(near[2], h[i], one)));
            of_products = hn::MulAdd(hn::Mul(away[(i + 1) % 3], away[(i + 2) % 3]),
                                     hn::Mul(uneven, all(16 * u)), of_products);
        }
        of_products = hn::Mul(of_products, hn::Abs(by_volume));
        const W of_place = hn::MulAdd(slope, hn::MulAdd(reach, all(8 * u), room), hn::Mul(moved, most_near));
        const W largest = frame.parallel
                              ? hn::Max(hn::Abs(forward[0]), hn::Add(hn::Abs(least_forward), extent))
                              : most_near;
        const W error =
            hn::Add(hn::Add(of_place, of_products), hn::Mul(hn::Add(largest, hn::Abs(near[2])), all(24 * u)));
        // What is not sound is anywhere.
        const auto bounded =
            hn::And(sound, hn::Lt(hn::Add(error, hn::Add(hn::Abs(near[2]), slope)), all(huge)));
        write(nearness, hn::IfThenElseZero(bounded, near[0]), hn::IfThenElseZero(bounded, near[1]),
              hn::IfThenElseZero(bounded, near[2]));
        hn::Store(hn::IfThenElse(bounded, error, all(infinity)), d, slack + at);
        const W most = hn::IfThenElse(bounded, hn::Add(hn::Add(grows, near[2]), error), all(infinity));
        hn::Store(hn::IfThenElse(outside, all(-infinity), most), d, nearest + at);
    }
};

// See RasterKernels.
inline void triangle_functions(const PixelBounds& bounds, const TriangleMeshView<float>& mesh,
                               std::size_t first, std::span<const std::uint32_t> numbers,
                               const PixelBox* boxes, TriangleFunctions* functions) {
    TriangleBlock<float> block{};
    TileFunctions::Boxes over{};
    TileFunctions of_eight;
    for (std::size_t i = 0; i < numbers.size(); i += 8) {
        const std::size_t count = std::min<std::size_t>(8, numbers.size() - i);
        for (std::size_t k = 0; k < count; ++k) {
            take_corners(mesh, first + numbers[i + k], block, static_cast<int>(k));
            const PixelBox& box = boxes[i + k];
            const auto along = [&](int axis, int from, int to) {
                over.middle[axis][k] = 0.5f * static_cast<float>(from + to + 1);
                over.reach[axis][k] = 0.5f * static_cast<float>(to - from + 1);
            };
            along(0, box.left, box.right), along(1, box.top, box.bottom);
        }
        of_eight.prepare(bounds.frame(), over, block, static_cast<int>(count));
        for (std::size_t k = 0; k < count; ++k) {
            TriangleFunctions& f = functions[i + k];
            for (int n = 0; n < 3; ++n) {
                for (int e = 0; e < 3; ++e) f.edge[e][n] = of_eight.edge[e][n][k];
                f.nearness[n] = of_eight.nearness[n][k];
            }
            f.slack = of_eight.slack[k];
        }
    }
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
