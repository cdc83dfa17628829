/// From where generated scenes are seen, where an automatic view does not suit.
#pragma once

#include <optional>
#include <string_view>

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// From where a scene is seen: a perspective view, and the way to its light, or 0 for the usual one.
struct SceneView {
    Vec3f eye, target, up;
    float degrees;  ///< of the view, from the bottom to the top
    Vec3f light = {};
};

/// The view of a generated scene that the automatic camera does not suit; nothing for other scenes.
inline std::optional<SceneView> view_of_scene(std::string_view scene) {
    // From a few paces away, with the stands behind the teapot: from afar the teapot is a dot.
    if (scene == "teapot-in-stadium") return SceneView{{7, -12, 5.5f}, {0, 0, 2.4f}, {0, 0, 1}, 45};
    // The view of the stadium, turned as the scene is.
    if (scene == "turned-stadium") {
        const auto turned = [](const Vec3f& p) {
            const float c = 0.8660254f, s = 0.5f, y = c * p[1] - s * p[2], z = s * p[1] + c * p[2];
            return Vec3f(c * p[0] + s * z, y, c * z - s * p[0]);
        };
        SceneView c = *view_of_scene("teapot-in-stadium");
        c.eye = turned(c.eye), c.target = turned(c.target), c.up = turned(c.up);
        return c;
    }
    // Through the open side of the box, as it was photographed (Goral et al. 1984).
    if (scene == "cornell-box")
        return SceneView{{278, 273, -800}, {278, 273, 0}, {0, 1, 0}, 39.3f, {0.3f, 0.25f, -1}};
    // From a corner of the living room, through the next room; the sun shines in.
    if (scene == "interior")
        return SceneView{{0.5f, 4.2f, 1.6f}, {3.6f, 1.4f, 1}, {0, 0, 1}, 62, {0.35f, -1, 0.6f}};
    return std::nullopt;
}

}  // namespace hedgerow
