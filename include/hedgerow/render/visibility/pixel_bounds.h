/// Which pixels of a picture a triangle may cover.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <hedgerow/geometry/shapes.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/render/visibility/samples.h>

namespace hedgerow {

/// Where a triangle may be seen: in a box of pixels, and no nearer forward of the eye than this.
struct Sight {
    PixelBox box;
    float nearest;
};

/// The boxes of pixels that hold every sample whose ray the watertight test (geometry/entry.h) may find to
/// hit a triangle of float or double.
///
/// A point, seen from the eye, is f·forward + a·right + b·up, and lies in the picture at the place
/// (a/f, b/f). What the test sees is not quite the triangle: differences from the origin and the shear are
/// rounded, and so is the direction that the camera gives to a ray. All of that moves a corner by less than
/// e = 64u·M, where M is the distance of the farthest corner and u the unit roundoff of float. A ray that
/// hits passes a point of the moved triangle; the same point of the given one is at most e away from it, so
/// its place is within room = 2·e/f·(1 + |place|) of the sample's. Only samples in the picture count, so the
/// box around the places of the corners, and room for the least f on all sides, holds them.
///
/// Of parallel rays, a corner is at the place (a, b), and their origins, which are rounded too, lie on the
/// picture's plane: e = 64u·(M + W), where W is how far the picture reaches from 0 and from the eye; room =
/// 2·e.
///
/// Of an instance, the picture's axes are mapped to the object's space, where the triangle is as it is given.
/// They are no longer of length 1 there: errors are up to A times as large in the coordinates that they give,
/// A the greatest length of the axes dual to them. The eye is rounded, so e = 64u·(M + |eye|).
///
/// A triangle with all corners behind the eye, or all beyond one side of the picture, covers nothing. Of one
/// that comes near the eye's plane, what lies before f = M/1024 is cut off. That is seen only where the
/// triangle passes the eye as closely; such a triangle may cover everything.
class PixelBounds {
public:
    /// `back` leads to the space of the triangles; null: they are in the world.
    template <class T>
    explicit PixelBounds(const PictureSamples<T>& samples, const Affine<3>* back = nullptr)
        : PixelBounds(samples.plane(), back, samples.width(), samples.height()) {
        f_.least = static_cast<double>(samples.within_pixel().least);
        f_.most = static_cast<double>(samples.within_pixel().most);
    }

    /// What the kernels read (raster_kernels.h).
    struct Frame {
        int width, height;
        double middle[2], pixels, least = 0, most = 1;  ///< the middle in pixels, how many pixels a place of
                                                        ///< 1 is from it, and where samples are within theirs
        Vec3d eye, forward, right, up;                  ///< the axes dual to the camera's
        Box<double, 2> sides;                           ///< the places of the picture's sides
        double reach;         ///< at least 1 + |place| in the picture; of parallel rays 1
        double corner_share;  ///< errors of corners, as a share of the farthest one's distance
        double error;         ///< and a part that is the same for all: of parallel rays and of instances
        double cut_share;     ///< how far before the eye a triangle is cut, as a share of the same
        double span;          ///< the greatest length of the picture's axes in the triangle's space
        bool parallel;        ///< whether rays are parallel: forward distances make nothing smaller
        bool sound;           ///< whether the camera has axes
    };
    const Frame& frame() const { return f_; }
    PixelBox whole() const { return {0, 0, f_.width - 1, f_.height - 1}; }
    template <class T>
    Sight of(const Triangle<T, 3>& t) const {
        if (!f_.sound) return {whole(), 0};
        const Corners corners(*this, t);
        if (beyond_a_side(corners)) return {{}, 0};
        // The places of the corners, or of the part behind the cut.
        Box<double, 2> places;
        double nearest = std::numeric_limits<double>::infinity();
        const auto add = [&](const Seen& p) {
            places.expand(Vec2d(p.right / divisor(p), p.up / divisor(p)));
            nearest = std::min(nearest, p.forward);
        };
        bool is_cut = false;
        for (int i = 0; i < 3; ++i) {
            const Seen &p = corners.seen[i], &q = corners.seen[(i + 1) % 3];
            if (p.forward > corners.cut) add(p);
            if ((p.forward > corners.cut) == (q.forward > corners.cut)) continue;
            is_cut = true;
            const double at = (corners.cut - p.forward) / (q.forward - p.forward);
            add(seen(p.from_eye + (q.from_eye - p.from_eye) * at));
        }
        if ((is_cut || places.empty()) && passes_eye(corners)) return {whole(), 0};
        if (places.empty()) return {{}, 0};
        const double least = is_cut ? 0 : nearest - 4 * corners.error;
        return {pixels(places, room(corners, nearest)), std::max(0.f, static_cast<float>(least))};
    }
    /// The corners of a triangle in pixels from the top left, and how far from it, along either axis, samples
    /// may lie that it covers.
    struct Projected {
        Vec2d corners[3];
        double room;
    };
    /// Nothing if the triangle has to be cut.
    template <class T>
    std::optional<Projected> projected(const Triangle<T, 3>& t) const {
        if (!f_.sound) return std::nullopt;
        const Corners corners(*this, t);
        Projected to;
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
            const Seen& p = corners.seen[i];
            if (!(p.forward > corners.cut)) return std::nullopt;
            const double by_forward = 1 / divisor(p);
            to.corners[i] = Vec2d(plane_x(p.right * by_forward), plane_y(p.up * by_forward));
            nearest = std::min(nearest, p.forward);
        }
        to.room = room(corners, nearest) * f_.pixels;
        return to;
    }

private:
    static constexpr double error_share = 64 * static_cast<double>(unit_roundoff<float>), cut_share = 0x1p-10;

    /// A point from the eye, and its coordinates along the picture's axes.
    struct Seen {
        Vec3d from_eye;
        double forward, right, up;
    };

    PixelBounds(const PicturePlane& plane, const Affine<3>* back, int width, int height) {
        const auto there = [&](const Vec3f& axis) { return back ? back->vector(Vec3d(axis)) : Vec3d(axis); };
        const Vec3d f = there(plane.forward), r = there(plane.right), u = there(plane.up);
        const double volume = dot(f, cross(r, u)), scale = static_cast<double>(plane.scale);
        const double x = static_cast<double>(plane.middle_x), y = static_cast<double>(plane.middle_y);
        f_.width = width, f_.height = height, f_.middle[0] = x, f_.middle[1] = y, f_.pixels = 1 / scale;
        f_.eye = back ? back->point(Vec3d(plane.eye)) : Vec3d(plane.eye);
        // Not 0, unless the camera looks along its up or the object is all but flat.
        f_.sound = std::abs(volume) > 0x1p-20 * length(f) * length(r) * length(u);
        f_.forward = cross(r, u) / volume, f_.right = cross(u, f) / volume, f_.up = cross(f, r) / volume;
        f_.sides = {{-x * scale, (y - height) * scale}, {(width - x) * scale, y * scale}};
        const double places = max_component(abs(f_.sides.low)) + max_component(abs(f_.sides.high));
        f_.parallel = plane.parallel;
        f_.reach = plane.parallel ? 1 : 1 + places;
        const auto longest = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
            return std::sqrt(std::max({length2(a), length2(b), length2(c)}));
        };
        const double dual = longest(f_.forward, f_.right, f_.up);
        f_.span = longest(f, r, u);
        f_.corner_share = error_share * dual, f_.cut_share = cut_share * dual;
        f_.error = f_.corner_share * ((plane.parallel ? 2 * places * f_.span : 0) +
                                      (plane.parallel || back ? length(f_.eye) : 0));
    }

    /// The corners of a triangle, the error of each, and how far before the eye's plane it is cut.
    struct Corners {
        Seen seen[3];
        double error, cut;

        template <class T>
        Corners(const PixelBounds& bounds, const Triangle<T, 3>& t)
            : seen{bounds.seen(Vec3d(t.a) - bounds.f_.eye), bounds.seen(Vec3d(t.b) - bounds.f_.eye),
                   bounds.seen(Vec3d(t.c) - bounds.f_.eye)} {
            const double farthest = std::sqrt(
                std::max({length2(seen[0].from_eye), length2(seen[1].from_eye), length2(seen[2].from_eye)}));
            error = bounds.f_.corner_share * farthest + bounds.f_.error;
            cut = bounds.f_.parallel ? -std::numeric_limits<double>::infinity()
                                     : bounds.f_.cut_share * farthest;
        }
    };

    Seen seen(const Vec3d& p) const { return {p, dot(p, f_.forward), dot(p, f_.right), dot(p, f_.up)}; }
    /// By which the coordinates of a point are divided in perspective.
    double divisor(const Seen& p) const { return f_.parallel ? 1 : p.forward; }
    double room(const Corners& corners, double nearest) const {
        return 2 * corners.error / (f_.parallel ? 1 : nearest) * f_.reach;
    }
    /// Whether all corners are behind the eye, or beyond one side of the picture, by more than their errors.
    bool beyond_a_side(const Corners& corners) const {
        const double room = 4 * corners.error * f_.reach;
        bool behind = true, left = true, right = true, below = true, above = true;
        for (const Seen& p : corners.seen) {
            behind &= p.forward < -room;
            const double by = divisor(p);
            left &= p.right < f_.sides.low[0] * by - room;
            right &= p.right > f_.sides.high[0] * by + room;
            below &= p.up < f_.sides.low[1] * by - room;
            above &= p.up > f_.sides.high[1] * by + room;
        }
        return behind || left || right || below || above;
    }
    /// Whether what is cut off may be seen: where the triangle's plane is near the eye; also where that
    /// cannot be told.
    bool passes_eye(const Corners& corners) const {
        const Vec3d& a = corners.seen[0].from_eye;
        const Vec3d normal = cross(corners.seen[1].from_eye - a, corners.seen[2].from_eye - a);
        return !(std::abs(dot(normal, a)) > 4 * corners.cut * f_.reach * f_.span * length(normal));
    }
    double plane_x(double place) const { return f_.middle[0] + place * f_.pixels; }
    double plane_y(double place) const { return f_.middle[1] - place * f_.pixels; }
    PixelBox pixels(const Box<double, 2>& places, double room) const {
        return {
            first(plane_x(places.low[0] - room), f_.width), first(plane_y(places.high[1] + room), f_.height),
            last(plane_x(places.high[0] + room), f_.width), last(plane_y(places.low[1] - room), f_.height)};
    }
    /// The first pixel whose sample may be at or after a place, and the last with one at or before it; beyond
    /// the picture if there is none.
    int first(double place, int count) const {
        return static_cast<int>(std::ceil(std::clamp(place - f_.most, 0.0, double(count))));
    }
    int last(double place, int count) const {
        return static_cast<int>(std::floor(std::clamp(place - f_.least, -1.0, double(count - 1))));
    }

    Frame f_;
};

/// The edges of a triangle in the picture: they tell which boxes of pixels lie beyond one of them.
///
/// A sample that is covered lies within `room` of the triangle along either axis (PixelBounds), so the
/// function of an edge, which is not below 0 within the triangle, is there at least −room times the sum of
/// its slopes. Roundings of places are less than 2⁻³⁰ of the largest.
class PixelEdges {
public:
    /// Without edges for a triangle that has to be cut, or that is seen edge-on: it covers all of its box.
    template <class T>
    PixelEdges(const PixelBounds& bounds, const Triangle<T, 3>& triangle)
        : least_(bounds.frame().least), most_(bounds.frame().most) {
        const auto projected = bounds.projected(triangle);
        if (!projected) return;
        const auto& [p, room] = *projected;
        const double largest = std::max(
                         {max_component(abs(p[0])), max_component(abs(p[1])), max_component(abs(p[2]))}),
                     rounding = 0x1p-30 * largest;
        const double area = edge(p[0], p[1], p[2]);
        if (!(std::abs(area) > rounding * largest)) return;
        for (int i = 0; i < 3; ++i) {
            const Vec2d &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
            const double side = area > 0 ? 1 : -1, x = side * (a[1] - b[1]), y = side * (b[0] - a[0]);
            edges_[i] = {x, y, -(x * a[0] + y * a[1]) + (std::abs(x) + std::abs(y)) * (room + rounding)};
        }
        count_ = 3;
    }
    /// Whether no sample in a box of pixels is covered.
    bool exclude(const PixelBox& box) const {
        for (int i = 0; i < count_; ++i) {
            const Edge& e = edges_[i];
            const double x = e.x > 0 ? box.right + most_ : box.left + least_,
                         y = e.y > 0 ? box.bottom + most_ : box.top + least_;
            if (e.x * x + e.y * y + e.constant < 0) return true;
        }
        return false;
    }

private:
    /// x·s.x + y·s.y + constant.
    struct Edge {
        double x, y, constant;
    };
    /// Twice the area of a triangle, signed.
    static double edge(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    }

    Edge edges_[3];
    int count_ = 0;
    double least_, most_;  // where samples are within their pixels
};

}  // namespace hedgerow
