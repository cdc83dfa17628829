/// The rays of a camera.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/elementary.h>
#include <hedgerow/geometry/ray.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/render/camera/flat_mirror.h>
#include <hedgerow/render/sampling/warps.h>

namespace hedgerow {

/// The plane of a picture: its axes, the size of a pixel on it, and the middle in pixels from the top left.
/// A perspective's plane is at distance 1 forward of the eye, and rays start at the eye; that of parallel
/// rays goes through the eye, and rays start on it. Of a picture in a mirror the axes are images, and rays
/// begin, after their origin, where they come out of the mirror: at distance `begin` along a normal from the
/// eye.
struct PicturePlane {
    Vec3f eye, forward, right, up;
    float scale, middle_x, middle_y;
    bool parallel = false;
    Vec3f begin_normal;
    float begin = 0;

    bool in_mirror() const { return begin > 0; }
};

/// The t at which a ray from the eye's image begins: at this distance along a normal from its origin.
/// Infinity for a ray that does not come out of the mirror, 0 for a distance of 0.
inline float begin_of(const Vec3f& normal, float distance, const Vec3f& direction) {
    if (distance == 0) return 0;
    const float along = dot(normal, direction);
    return along > 0 ? distance / along : std::numeric_limits<float>::infinity();
}

/// A point of a thin lens, from its middle, in units of its radius: within 1.
struct LensPoint {
    float right = 0, up = 0;
};
/// Maps a square to the lens, with equal areas to equal areas. u and v are in [0, 1).
inline LensPoint lens_point(float u, float v) {
    const Vec2f p = disc_point(u, v);
    return {p[0], p[1]};
}

/// Throws InputError for a camera that sees nothing or whose numbers make no sense: an angle of view that is
/// not between 0 and 180 degrees, a negative height, lens or focus, an eye at the target.
inline void check_camera(const Camera& c) {
    const auto expect = [](bool sound, const char* what) {
        if (!sound) throw InputError(std::string("camera: ") + what);
    };
    expect(c.field_of_view > 0 && c.field_of_view < 180,
           "the field of view must be between 0 and 180 degrees");
    expect(c.height >= 0, "the height of an orthographic picture must not be negative");
    expect(c.lens_radius >= 0, "the radius of the lens must not be negative");
    expect(c.focus >= 0, "the distance of focus must not be negative");
    expect(finite(c.eye) && finite(c.target), "the eye and the target must be finite");
    expect(length2(c.target - c.eye) > 0, "the eye is at the target");
}

/// Makes the rays of a picture. x and y are in pixels from the top left, with fractions within a pixel.
class RayMaker {
public:
    RayMaker(const Camera& c, int width, int height)
        : eye_(c.eye),
          forward_(normalized(c.target - c.eye)),
          right_(normalized(cross(forward_, c.up))),
          up_(cross(right_, forward_)),
          scale_(2 * tangent(c.field_of_view / 2) / static_cast<float>(height)),
          middle_x_(static_cast<float>(width) / 2),
          middle_y_(static_cast<float>(height) / 2),
          projection_(c.projection),
          lens_radius_(c.projection == Projection::perspective ? c.lens_radius : 0),
          focus_(c.focus > 0 ? c.focus : length(c.target - c.eye)) {
        if (projection_ == Projection::orthographic)
            scale_ = c.height > 0 ? c.height / static_cast<float>(height) : scale_ * length(c.target - c.eye);
    }

    /// What the eye sees in a mirror: rays from the image of the eye, which begin where they leave the
    /// mirror. Only those that meet the mirror come from it, so the others of a picture say nothing. Throws
    /// InputError for parallel rays and for a lens, whose rays have no common origin, and for an eye in the
    /// mirror.
    RayMaker in_mirror(const FlatMirror& mirror) const {
        if (!from_one_eye()) throw InputError("what is seen in a mirror is found from one eye");
        const double above = mirror.above(Vec3d(eye_));
        const Vec3d image = mirror.image_of_point(Vec3d(eye_));
        const double clear =
            0x1p-17 * (mirror.reach + std::max(max_component(abs(Vec3d(eye_))), max_component(abs(image))));
        if (!(std::abs(above) > clear)) throw InputError("the eye is in the plane of the mirror");
        RayMaker seen = *this;
        const auto turn = [&](Vec3f& axis) { axis = Vec3f(mirror.image_of_direction(Vec3d(axis))); };
        turn(seen.forward_), turn(seen.right_), turn(seen.up_);
        seen.eye_ = Vec3f(image);
        seen.begin_normal_ = Vec3f(above > 0 ? mirror.normal : -mirror.normal);
        seen.begin_ = static_cast<float>(std::abs(above) + clear);
        return seen;
    }

    /// Whether all rays come from one eye, or go one way, through a plane, where they begin: what can be
    /// projected.
    bool has_plane() const { return projection_ != Projection::panorama && lens_radius_ == 0 && begin_ == 0; }
    bool from_one_eye() const { return projection_ == Projection::perspective && lens_radius_ == 0; }
    bool has_lens() const { return lens_radius_ > 0; }
    PicturePlane plane() const {
        return {eye_,          forward_,  right_,    up_,
                scale_,        middle_x_, middle_y_, projection_ == Projection::orthographic,
                begin_normal_, begin_};
    }
    template <class T>
    Ray<T, 3> ray(float x, float y) const {
        const Vec3f across = right_ * ((x - middle_x_) * scale_), up = up_ * ((middle_y_ - y) * scale_);
        switch (projection_) {
            case Projection::orthographic:
                return {Vec<T, 3>(eye_ + across + up), Vec<T, 3>(forward_)};
            case Projection::panorama:
                return {Vec<T, 3>(eye_), Vec<T, 3>(in_panorama(x, y))};
            default: {
                const Vec3f direction = normalized(forward_ + across + up);
                return {Vec<T, 3>(eye_), Vec<T, 3>(direction), T(begin_of(begin_normal_, begin_, direction))};
            }
        }
    }
    /// The ray from a point of the lens to where the ray through its middle is in focus.
    template <class T>
    Ray<T, 3> ray(float x, float y, const LensPoint& point) const {
        const Vec3f d = forward_ + right_ * ((x - middle_x_) * scale_) + up_ * ((middle_y_ - y) * scale_);
        const Vec3f from = right_ * (point.right * lens_radius_) + up_ * (point.up * lens_radius_);
        return {Vec<T, 3>(eye_ + from), Vec<T, 3>(normalized(d * focus_ - from))};
    }
    /// Projects a point onto the plane. Returns x and y in pixels from the top left, and the distance forward
    /// of the eye, which is negative behind the eye.
    Vec3f seen(const Vec3f& p) const {
        const Vec3f d = p - eye_;
        const float forward = dot(d, forward_),
                    per_pixel = projection_ == Projection::orthographic ? scale_ : forward * scale_;
        return {middle_x_ + dot(d, right_) / per_pixel, middle_y_ - dot(d, up_) / per_pixel, forward};
    }
    /// The distance forward of the eye of the point at t = 1 on a ray with this direction.
    float forward_of(const Vec3f& direction) const { return dot(direction, forward_); }

private:
    static float tangent(float degrees) {
        return static_cast<float>(hedgerow::tangent(double(degrees) * std::numbers::pi / 180));
    }
    Vec3f in_panorama(float x, float y) const {
        const auto longitude = sine_cosine_of_turns((x - middle_x_) / middle_x_ / 2),
                   latitude = sine_cosine_of_turns((middle_y_ - y) / middle_y_ / 4);
        const Vec3f level = forward_ * longitude.cosine + right_ * longitude.sine;
        return normalized(level * latitude.cosine + up_ * latitude.sine);
    }

    Vec3f eye_, forward_, right_, up_;
    float scale_, middle_x_, middle_y_;
    Projection projection_;
    float lens_radius_, focus_;
    Vec3f begin_normal_;
    float begin_ = 0;
};

}  // namespace hedgerow
