/// Cameras, as plain data.
#pragma once

#include <hedgerow/geometry/vec.h>

namespace hedgerow {

/// How a camera maps space to a picture: from an eye onto a plane; along parallel lines onto a plane; or from
/// an eye in all directions, longitude across the picture and latitude up it.
enum class Projection { perspective, orthographic, panorama };

struct Camera {
    Vec3f eye, target, up{0, 0, 1};
    float field_of_view = 45;  ///< vertical, in degrees; of a perspective
    /// Direction towards a distant light; 0: from above, behind and beside the camera.
    Vec3f light{0, 0, 0};
    Projection projection = Projection::perspective;
    /// Height of what an orthographic picture shows; 0: as much as a perspective shows at the target.
    float height = 0;
    /// Radius of a thin lens around the eye of a perspective, and the distance forward of it that is in
    /// focus; radius 0: a pinhole; focus 0: the distance of the target.
    float lens_radius = 0, focus = 0;
};

}  // namespace hedgerow
