/// What a tile of a picture sees: a beam from the eye, between four planes.
#if defined(HEDGEROW_RENDER_BEAM_SIDES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_RENDER_BEAM_SIDES_INL_H
#undef HEDGEROW_RENDER_BEAM_SIDES_INL_H
#else
#define HEDGEROW_RENDER_BEAM_SIDES_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include <hwy/highway.h>

#include <hedgerow/engine/kernels.h>
#include <hedgerow/render/visibility/pixel_bounds.h>

#include "beam_lists-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A direction along which boxes are measured: the least of normal·(x − eye) over a box, lowered by what hits
// and rays may err by.
//
// That is 64u·M + 16u·|o| along each axis, in the terms of RayProbe: 16u·M + 4u·|o| is how far a hit may lie
// from its primitive's box; 16u·M, how far the camera's roundings bend a ray; and the rest is more than what
// is rounded here: the normal, its products, and their sums.
struct BeamNormal {
    float normal[3], at_eye;  // `at_eye`: normal·eye, and what is added for errors
    int low_row[3];           // the row of the planes that are least along the normal

    BeamNormal() = default;
    BeamNormal(const Vec3d& n, const Vec3d& eye, double slack) {
        double reach = 0, height = 0;
        for (int k = 0; k < 3; ++k) {
            normal[k] = static_cast<float>(n[k]);
            const auto given = static_cast<double>(normal[k]);
            reach += std::abs(given), height += given * eye[k];
            low_row[k] = 2 * k + (given < 0);
        }
        at_eye = static_cast<float>(height + slack * reach);
    }
    // `row(r)` is a vector of row r of the boxes: the low and high planes across x, then y and z.
    template <class D, class Row>
    HWY_INLINE hn::Vec<D> least(D d, Row row) const {
        auto sum = hn::MulSub(row(low_row[0]), hn::Set(d, normal[0]), hn::Set(d, at_eye));
        sum = hn::MulAdd(row(low_row[1]), hn::Set(d, normal[1]), sum);
        return hn::MulAdd(row(low_row[2]), hn::Set(d, normal[2]), sum);
    }
};

// What all beams of a picture have in common.
struct BeamEye {
    const PixelBounds::Frame& frame;
    Vec3d eye;
    double slack;
    BeamNormal forward;
    float axes[3][3];  // dual to the camera's: right, up, forward
    // In a mirror, what lies between the eye and where rays begin is not seen.
    const PicturePlane& plane;
    BeamNormal before;

    BeamEye(const PicturePlane& p, const PixelBounds::Frame& f, const Box<float, 3>& scene)
        : frame(f), eye(f.eye), plane(p) {
        double reach = 0;
        for (int k = 0; k < 3; ++k)
            reach = std::max({reach, std::abs(static_cast<double>(scene.low[k]) - eye[k]),
                              std::abs(static_cast<double>(scene.high[k]) - eye[k])});
        const auto u = static_cast<double>(unit_roundoff<float>);
        slack = 64 * u * reach + 16 * u * max_component(abs(eye)) + 0x1p-120;
        forward = BeamNormal(f.forward, eye, slack);
        const Vec3d dual[3] = {f.right, f.up, f.forward};
        for (int r = 0; r < 3; ++r)
            for (int k = 0; k < 3; ++k) axes[r][k] = static_cast<float>(dual[r][k]);
        before = BeamNormal(-Vec3d(plane.begin_normal), eye, slack);
        before.at_eye -= plane.begin;
    }
};

// The beam of a tile: the places of its sides in the picture at distance 1, its planes, and the depth up to
// which it is open.
struct Beam {
    float left, right, low, high;
    BeamNormal planes[4];
    float farthest = std::numeric_limits<float>::infinity();

    Beam() = default;
    Beam(const BeamEye& e, const PixelBox& pixels) {
        const PixelBounds::Frame& f = e.frame;
        const double x0 = (pixels.left + f.least - f.middle[0]) / f.pixels,
                     x1 = (pixels.right + f.most - f.middle[0]) / f.pixels,
                     y0 = (f.middle[1] - pixels.bottom - f.most) / f.pixels,
                     y1 = (f.middle[1] - pixels.top - f.least) / f.pixels;
        left = static_cast<float>(x0), right = static_cast<float>(x1);
        low = static_cast<float>(y0), high = static_cast<float>(y1);
        planes[0] = BeamNormal(f.forward * x0 - f.right, e.eye, e.slack);
        planes[1] = BeamNormal(f.right - f.forward * x1, e.eye, e.slack);
        planes[2] = BeamNormal(f.forward * y0 - f.up, e.eye, e.slack);
        planes[3] = BeamNormal(f.up - f.forward * y1, e.eye, e.slack);
    }
    // The boxes that the beam may meet no farther than it is open, and the least depth of each.
    template <class D, class Row>
    HWY_INLINE hn::Mask<D> meets(D d, const BeamEye& eye, Row row, hn::Vec<D>& depth) const {
        depth = eye.forward.least(d, row);
        auto out = hn::Max(planes[0].least(d, row), planes[1].least(d, row));
        out = hn::Max(out, hn::Max(planes[2].least(d, row), planes[3].least(d, row)));
        if (eye.plane.in_mirror()) [[unlikely]]
            out = hn::Max(out, eye.before.least(d, row));
        return hn::And(hn::Le(out, hn::Zero(d)), hn::Le(depth, hn::Set(d, farthest)));
    }

    // Where the beam lies to triangles: which it may meet, and which cover all of it, with the greatest depth
    // of these in the beam. `row(r)` is a vector of row r of BeamTriangles.
    template <class D>
    struct Sides {
        hn::Mask<D> meets, covers;
        hn::Vec<D> farthest;

        HWY_INLINE Sides() {}
    };
    template <class D, class Row>
    HWY_INLINE Sides<D> sides_of(D d, Row row) const {
        const auto error = row(BeamTriangles::error);
        const auto zero = hn::Zero(d), below = hn::Neg(error);
        // The range of the function of an edge over the tile.
        const auto range = [&](auto a, auto b, auto c, auto& least, auto& most)
            __attribute__((always_inline)) {
            const auto a0 = hn::Mul(a, hn::Set(d, left)), a1 = hn::Mul(a, hn::Set(d, right));
            const auto b0 = hn::Mul(b, hn::Set(d, low)), b1 = hn::Mul(b, hn::Set(d, high));
            least = hn::Add(c, hn::Add(hn::Min(a0, a1), hn::Min(b0, b1)));
            most = hn::Add(c, hn::Add(hn::Max(a0, a1), hn::Max(b0, b1)));
        };
        hn::Vec<D> least[3], most[3];
        for (int i = 0; i < 3; ++i) range(row(3 * i), row(3 * i + 1), row(3 * i + 2), least[i], most[i]);
        const auto all_least = hn::Min(least[0], hn::Min(least[1], least[2])),
                   all_most = hn::Max(most[0], hn::Max(most[1], most[2]));
        const auto some_above = hn::Gt(hn::Max(least[0], hn::Max(least[1], least[2])), error),
                   some_below = hn::Lt(hn::Min(most[0], hn::Min(most[1], most[2])), below);
        Sides<D> sides;
        // A sample that is covered has no functions of opposite signs.
        sides.meets = hn::AndNot(hn::And(some_above, some_below),
                                 hn::Le(row(BeamTriangles::nearest), hn::Set(d, farthest)));
        // All of one sign, and in front of the eye, for the greatest depth: the least sum.
        const auto sum = [&](int r) __attribute__((always_inline)) {
            return hn::Add(row(r), hn::Add(row(r + 3), row(r + 6)));
        };
        hn::Vec<D> sum_least, sum_most;
        range(sum(0), sum(1), sum(2), sum_least, sum_most);
        const auto by_sum = row(BeamTriangles::depth_by_sum);
        const auto above = hn::And(hn::Gt(all_least, error), hn::Gt(by_sum, zero)),
                   beneath = hn::And(hn::Lt(all_most, below), hn::Lt(by_sum, zero));
        sides.covers = hn::And(sides.meets, hn::Or(above, beneath));
        sides.farthest =
            hn::Mul(hn::Div(by_sum, hn::IfThenElse(above, sum_least, sum_most)), hn::Set(d, 1 + 0x1p-10f));
        return sides;
    }
};

// The rows of BeamTriangles for lanes of triangles. `corner(k, c)` is corner c along axis k, minus the eye.
//
// The test of a ray moves corners by less than 16u·R, in the camera's terms (design/035), where R is the
// greatest sum of a corner's coordinates; what is rounded here is less. So with a = |a| + |b| + 1 at a place
// of the picture, an edge's function errs by less than 64u·R²·a, and by half of the error that is stored.
template <class D, class Corner>
HWY_INLINE void triangle_rows(D d, const BeamEye& eye, Corner corner, hn::Vec<D> (&rows)[12]) {
    using V = hn::Vec<D>;
    V p[3][3];  // by camera axis
    V largest = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
        V size = hn::Zero(d);
        for (int r = 0; r < 3; ++r) {
            p[r][c] = hn::Mul(corner(0, c), hn::Set(d, eye.axes[r][0]));
            p[r][c] = hn::MulAdd(corner(1, c), hn::Set(d, eye.axes[r][1]), p[r][c]);
            p[r][c] = hn::MulAdd(corner(2, c), hn::Set(d, eye.axes[r][2]), p[r][c]);
            size = hn::Add(size, hn::Abs(p[r][c]));
        }
        largest = hn::Max(largest, size);
    }
    const auto minor = [&](int r, int q, int a, int b) __attribute__((always_inline)) {
        return hn::NegMulAdd(p[q][a], p[r][b], hn::Mul(p[r][a], p[q][b]));
    };
    for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        rows[3 * i] = minor(1, 2, a, b), rows[3 * i + 1] = minor(2, 0, a, b),
                 rows[3 * i + 2] = minor(0, 1, a, b);
    }
    const auto share = static_cast<float>(0x1p-17 * (2 * eye.frame.reach));
    rows[BeamTriangles::error] =
        hn::MulAdd(hn::Mul(largest, largest), hn::Set(d, share), hn::Set(d, 0x1p-120f));
    rows[BeamTriangles::depth_by_sum] =
        hn::MulAdd(p[0][0], rows[0], hn::MulAdd(p[1][0], rows[1], hn::Mul(p[2][0], rows[2])));
    rows[BeamTriangles::nearest] =
        hn::NegMulAdd(largest, hn::Set(d, 0x1p-16f), hn::Min(p[2][0], hn::Min(p[2][1], p[2][2])));
}

// In a mirror: whether rays may hit triangles, which do not lie before all rays begin. `rows` of those that
// lie before some do are changed, so that they cover no beam. Corners as above.
template <class D, class Corner>
HWY_INLINE hn::Mask<D> after_begin(D d, const BeamEye& eye, Corner corner, hn::Vec<D> (&rows)[12]) {
    auto least = hn::Set(d, std::numeric_limits<float>::infinity()), most = hn::Neg(least);
    for (int c = 0; c < 3; ++c) {
        auto along = hn::Mul(corner(0, c), hn::Set(d, eye.plane.begin_normal[0]));
        along = hn::MulAdd(corner(1, c), hn::Set(d, eye.plane.begin_normal[1]), along);
        along = hn::MulAdd(corner(2, c), hn::Set(d, eye.plane.begin_normal[2]), along);
        least = hn::Min(least, along), most = hn::Max(most, along);
    }
    const auto begin = hn::Set(d, eye.plane.begin), room = hn::Set(d, static_cast<float>(4 * eye.slack));
    rows[BeamTriangles::depth_by_sum] =
        hn::IfThenElseZero(hn::Gt(least, hn::Add(begin, room)), rows[BeamTriangles::depth_by_sum]);
    return hn::Ge(most, hn::Sub(begin, room));
}

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
