/// A pinhole camera, and default positions for it.
#pragma once

#include <cmath>
#include <optional>
#include <string_view>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/ray.h>

namespace hedgerow {

struct Camera {
    Vec3f eye, target, up{0, 0, 1};
    float field_of_view = 45;  // vertical, in degrees
    /// Direction towards a distant light; 0: from above, behind and beside the camera.
    Vec3f light{0, 0, 0};
};

/// A three-quarter view of a box from above, far enough back that the box fills most of the picture.
/// `up_axis` is 0 for x, 1 for y or 2 for z. The front is -y where z is up, and +z where y is up.
inline Camera automatic_camera(const Box3f& box, int up_axis) {
    constexpr float beside = 0.45f, above = 0.42f, before = 0.8f;
    const Vec3f away[3] = {{above, beside, -before}, {beside, above, before}, {beside, -before, above}};
    Camera c;
    c.target = box.empty() ? Vec3f() : box.center();
    c.up = {0, 0, 0};
    c.up[up_axis] = 1;
    c.eye = c.target + away[up_axis] * (1.25f * (box.empty() ? std::sqrt(3.f) : length(box.extent())));
    return c;
}
/// The camera for a box alone, for rays that must not depend on where a scene comes from. The up axis is y
/// for a box that is flattest along y, z for any other.
inline Camera automatic_camera(const Box3f& box) {
    const Vec3f extent = box.empty() ? Vec3f(1, 1, 1) : box.extent();
    return automatic_camera(box, extent[1] < extent[2] && extent[1] < extent[0] ? 1 : 2);
}

/// The best camera for a generated scene that the automatic camera does not suit; nothing for other scenes.
inline std::optional<Camera> camera_for(std::string_view scene) {
    // From a few paces away, with the stands behind the teapot: from afar the teapot is a dot.
    if (scene == "teapot-in-stadium") return Camera{{7, -12, 5.5f}, {0, 0, 2.4f}, {0, 0, 1}, 45};
    // The camera of the stadium, turned as the scene is.
    if (scene == "turned-stadium") {
        const auto turned = [](const Vec3f& p) {
            const float c = 0.8660254f, s = 0.5f, y = c * p[1] - s * p[2], z = s * p[1] + c * p[2];
            return Vec3f(c * p[0] + s * z, y, c * z - s * p[0]);
        };
        Camera c = *camera_for("teapot-in-stadium");
        c.eye = turned(c.eye), c.target = turned(c.target), c.up = turned(c.up);
        return c;
    }
    // Through the open side of the box, as it was photographed (Goral et al. 1984).
    if (scene == "cornell-box")
        return Camera{{278, 273, -800}, {278, 273, 0}, {0, 1, 0}, 39.3f, {0.3f, 0.25f, -1}};
    // From a corner of the living room, through the next room; the sun shines in.
    if (scene == "interior")
        return Camera{{0.5f, 4.2f, 1.6f}, {3.6f, 1.4f, 1}, {0, 0, 1}, 62, {0.35f, -1, 0.6f}};
    return std::nullopt;
}

/// The plane of a picture at distance 1 forward of the eye: its axes, the size of a pixel on it, and the
/// middle in pixels from the top left.
struct PicturePlane {
    Vec3f eye, forward, right, up;
    float scale, middle_x, middle_y;
};

/// Makes rays through the picture plane. x and y are in pixels from the top left, with fractions within a
/// pixel.
class RayMaker {
public:
    RayMaker(const Camera& c, int width, int height)
        : eye_(c.eye),
          forward_(normalized(c.target - c.eye)),
          right_(normalized(cross(forward_, c.up))),
          up_(cross(right_, forward_)),
          scale_(2 * tangent(c.field_of_view / 2) / static_cast<float>(height)),
          middle_x_(static_cast<float>(width) / 2),
          middle_y_(static_cast<float>(height) / 2) {}
    PicturePlane plane() const { return {eye_, forward_, right_, up_, scale_, middle_x_, middle_y_}; }
    template <class T>
    Ray<T, 3> ray(float x, float y) const {
        const Vec3f d = forward_ + right_ * ((x - middle_x_) * scale_) + up_ * ((middle_y_ - y) * scale_);
        return {Vec<T, 3>(eye_), Vec<T, 3>(normalized(d))};
    }
    /// Projects a point. Returns x and y in pixels from the top left, and the distance forward of the eye,
    /// which is negative behind the eye.
    Vec3f seen(const Vec3f& p) const {
        const Vec3f d = p - eye_;
        const float forward = dot(d, forward_), per_pixel = forward * scale_;
        return {middle_x_ + dot(d, right_) / per_pixel, middle_y_ - dot(d, up_) / per_pixel, forward};
    }
    /// The distance forward of the eye of the point at t = 1 on a ray with this direction.
    float forward_of(const Vec3f& direction) const { return dot(direction, forward_); }

private:
    static float tangent(float degrees) { return std::tan(degrees * 3.14159265f / 180); }
    Vec3f eye_, forward_, right_, up_;
    float scale_, middle_x_, middle_y_;
};

}  // namespace hedgerow
