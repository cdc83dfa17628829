/// The rays of a picture, with pixels in lanes.
#if defined(HEDGEROW_RENDER_PICTURE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_PICTURE_RAYS_INL_H
#undef HEDGEROW_RENDER_PICTURE_RAYS_INL_H
#else
#define HEDGEROW_RENDER_PICTURE_RAYS_INL_H
#endif

#include <algorithm>
#include <limits>
#include <utility>

#include <hwy/highway.h>

#include <hedgerow/render/visibility/beam_kernels.h>

#include "engine/coordinates-inl.h"
#include "engine/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The rays through the middles of pixels: what RayMaker::ray computes, the same operations in the same order.
class MiddleRays {
public:
    using F = PacketRays::F;
    using V = PacketRays::V;
    static constexpr F f{};
    static constexpr hn::RebindToSigned<F> i32{};
    using I = hn::Vec<hn::RebindToSigned<F>>;

    explicit MiddleRays(const PicturePlane& plane) : plane_(plane) {}

    // Numbers from `first` on. A number in Iota other than 0 would be stored lane by lane, and loaded as a
    // whole.
    static HWY_INLINE I numbers(int first) { return hn::Add(hn::Iota(i32, 0), hn::Set(i32, first)); }
    // The places on the plane, from the eye in perspective.
    HWY_INLINE Coordinates<F> places(I column, I row) const {
        const V scale = hn::Set(f, plane_.scale), half = hn::Set(f, 0.5f);
        const V x = hn::Add(hn::ConvertTo(f, column), half), y = hn::Add(hn::ConvertTo(f, row), half);
        const V right = hn::Mul(hn::Sub(x, hn::Set(f, plane_.middle_x)), scale);
        const V up = hn::Mul(hn::Sub(hn::Set(f, plane_.middle_y), y), scale);
        const Coordinates<F> middle = all_lanes(f, plane_.parallel ? plane_.eye : plane_.forward);
        return plus(plus(middle, times(all_lanes(f, plane_.right), right)),
                    times(all_lanes(f, plane_.up), up));
    }
    // Directions from the eye.
    HWY_INLINE Coordinates<F> directions(I column, I row) const {
        const Coordinates<F> d = places(column, row);
        const V length = hn::Sqrt(product(d, d));
        const auto is = hn::Gt(length, hn::Zero(f));
        return {hn::IfThenElse(is, hn::Div(d.x, length), d.x), hn::IfThenElse(is, hn::Div(d.y, length), d.y),
                hn::IfThenElse(is, hn::Div(d.z, length), d.z)};
    }

    // Where rays from the eye begin: what begin_of computes.
    HWY_INLINE V begins(const Coordinates<F>& directions) const {
        if (!plane_.in_mirror()) return hn::Zero(f);
        const V along = product(all_lanes(f, plane_.begin_normal), directions);
        return hn::IfThenElse(hn::Gt(along, hn::Zero(f)), hn::Div(hn::Set(f, plane_.begin), along),
                              hn::Set(f, std::numeric_limits<float>::infinity()));
    }

private:
    const PicturePlane& plane_;
};

// The rays of a tile's samples from one eye, a vector of `lanes` at a time. Pixels beyond the tile stand for
// those of its border.
class PictureRays {
public:
    using F = PacketRays::F;
    using V = PacketRays::V;
    static constexpr F f{};
    static constexpr int lanes = PacketRays::lanes, side = static_cast<int>(block_side);

    explicit PictureRays(const BeamTile& tile) : tile_(tile) {}

    // The directions in a row of pixels, from (left, y) on.
    HWY_INLINE Coordinates<F> in_row(int left, int y) const {
        if (tile_.rays != nullptr) [[unlikely]]
            return given([&](int i) { return std::pair(left + i, y); });
        return through_middles(MiddleRays::numbers(left), hn::Set(i32, y));
    }
    // Those of vector p of the block of 8 × 8 samples from (left, top) on, by rows.
    HWY_INLINE Coordinates<F> in_block(int left, int top, int p) const {
        if (tile_.rays != nullptr) [[unlikely]]
            return given([&](int i) {
                return std::pair(left + (p * lanes + i) % side, top + (p * lanes + i) / side);
            });
        const auto place = MiddleRays::numbers(p * lanes);
        return through_middles(hn::Add(hn::And(place, hn::Set(i32, side - 1)), hn::Set(i32, left)),
                               hn::Add(hn::ShiftRight<3>(place), hn::Set(i32, top)));
    }
    HWY_INLINE V begins(const Coordinates<F>& directions) const {
        return MiddleRays(tile_.plane).begins(directions);
    }
    // What packets read of vector p of a block.
    HWY_INLINE void write(int left, int top, int p, float (&numbers)[8][lanes]) const {
        const auto d = in_block(left, top, p);
        for (int k = 0; k < 3; ++k) hn::Store(hn::Set(f, tile_.plane.eye[k]), f, numbers[k]);
        hn::Store(d.x, f, numbers[3]), hn::Store(d.y, f, numbers[4]), hn::Store(d.z, f, numbers[5]);
        hn::Store(begins(d), f, numbers[6]);
        hn::Store(hn::Set(f, std::numeric_limits<float>::infinity()), f, numbers[7]);
    }
    // Ray i of a block.
    HWY_INLINE Ray<float, 3> ray(int left, int top, int i) const {
        alignas(64) float numbers[8][lanes];
        write(left, top, i / lanes, numbers);
        Ray<float, 3> r;
        for (int k = 0; k < 3; ++k)
            r.origin[k] = numbers[k][i % lanes], r.direction[k] = numbers[3 + k][i % lanes];
        r.t_min = numbers[6][i % lanes];
        return r;
    }

private:
    static constexpr hn::RebindToSigned<F> i32{};
    using I = hn::Vec<hn::RebindToSigned<F>>;

    HWY_INLINE Coordinates<F> through_middles(I column, I row) const {
        return MiddleRays(tile_.plane)
            .directions(hn::Min(column, hn::Set(i32, tile_.pixels.right)),
                        hn::Min(row, hn::Set(i32, tile_.pixels.bottom)));
    }
    // Those of the tile's own rays: lane i has the ray of pixel(i).
    template <class Pixel>
    HWY_NOINLINE Coordinates<F> given(Pixel pixel) const {
        alignas(64) float d[3][lanes];
        for (int i = 0; i < lanes; ++i) {
            const auto [x, y] = pixel(i);
            const Ray<float, 3>& ray =
                tile_.rays[(std::min(y, tile_.pixels.bottom) - tile_.pixels.top) * beam_side +
                           std::min(x, tile_.pixels.right) - tile_.pixels.left];
            for (int k = 0; k < 3; ++k) d[k][i] = ray.direction[k];
        }
        return {hn::Load(f, d[0]), hn::Load(f, d[1]), hn::Load(f, d[2])};
    }

    const BeamTile& tile_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
