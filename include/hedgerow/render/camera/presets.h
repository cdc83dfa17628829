/// Cameras for a box, and for generated scenes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <hedgerow/geometry/box.h>
#include <hedgerow/render/camera/camera.h>
#include <hedgerow/scenes/views.h>

namespace hedgerow {

/// The axes of a scene in which `up_axis` (0 for x, 1 for y, 2 for z) points up: the front is -y where z is
/// up, and +z where y is up.
struct SceneAxes {
    Vec3f right, back, up;
};
inline SceneAxes scene_axes(int up_axis) {
    static constexpr int right[3] = {1, 0, 0}, back[3] = {2, 2, 1};
    static constexpr float away[3] = {1, -1, 1};
    SceneAxes axes;
    axes.right[right[up_axis]] = 1;
    axes.back[back[up_axis]] = away[up_axis];
    axes.up[up_axis] = 1;
    return axes;
}

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

/// The names of views: `corner` is the automatic camera, the others look along an axis of the scene.
inline constexpr std::array<std::string_view, 7> view_names = {"corner", "front", "back",  "left",
                                                               "right",  "top",   "bottom"};

/// The view of this name of a box, from far enough away that a perspective or an orthographic picture of any
/// shape (width / height) shows all of it. Nothing for another name.
inline std::optional<Camera> named_view(std::string_view name, const Box3f& box, int up_axis, float shape) {
    Camera c = automatic_camera(box, up_axis);
    if (name == "corner") return c;
    const SceneAxes axes = scene_axes(up_axis);
    const bool level = name != "top" && name != "bottom";
    Vec3f towards;
    if (name == "front")
        towards = axes.back;
    else if (name == "back")
        towards = -axes.back;
    else if (name == "left")
        towards = axes.right;
    else if (name == "right")
        towards = -axes.right;
    else if (name == "top")
        towards = -axes.up;
    else if (name == "bottom")
        towards = axes.up;
    else
        return std::nullopt;
    c.up = level ? axes.up : (name == "top" ? axes.back : -axes.back);
    // The half extents across the picture, up it and along the view. A point is seen as if it had a size.
    Vec3f half = box.empty() ? Vec3f(1, 1, 1) : box.extent() * 0.5f;
    if (length2(half) == 0) half = Vec3f::all(std::max(1.f, max_component(abs(c.target))));
    const auto along = [&](const Vec3f& axis) { return std::abs(dot(half, abs(axis))); };
    const float across = along(cross(towards, c.up)), high = along(c.up);
    constexpr float margin = 1.08f;
    const float visible = margin * std::max({high, across / shape, 1e-3f * length(half)});
    c.height = 2 * visible;
    // tan(45° / 2)
    c.eye = c.target - towards * (along(towards) + visible / 0.41421356f);
    return c;
}

/// The camera for a generated scene that has a view of its own (scenes/views.h); nothing for other scenes.
inline std::optional<Camera> camera_for(std::string_view scene) {
    const auto view = view_of_scene(scene);
    if (!view) return std::nullopt;
    return Camera{view->eye, view->target, view->up, view->degrees, view->light};
}

}  // namespace hedgerow
