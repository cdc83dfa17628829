/// Sources of light that are no surfaces. Positions and directions are in the world. Colours are linear with
/// the primaries of sRGB.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include <hedgerow/geometry/box.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/geometry/vec.h>
#include <hedgerow/looks/texture.h>

namespace hedgerow {

/// Shines alike in all directions. The intensity is in candela (lm/sr), a component a colour.
struct PointLight {
    std::string name;
    Vec3d position;
    Vec3f intensity;
};

/// A point light within a cone about `direction`, which has length 1. Angles are from the axis, in radians,
/// 0 ≤ inner < outer ≤ π/2. KHR_lights_punctual defines the fall between them as
/// clamp((cos θ − cos outer) / (cos inner − cos outer), 0, 1)².
struct SpotLight {
    std::string name;
    Vec3d position, direction;
    Vec3f intensity;
    double inner = 0, outer = 0.7853981633974483;
};

/// Light that travels in one direction, of length 1, from beyond all surfaces. The illuminance of a surface
/// that faces it is in lux (lm/m²).
struct DirectionalLight {
    std::string name;
    Vec3d direction;
    Vec3f illuminance;
};

using Light = std::variant<PointLight, SpotLight, DirectionalLight>;

/// Light from all around, infinitely far away. The picture is a panorama in latitude and longitude: its top
/// row lies at the zenith +y of the environment's own space, and its middle column at −z, with +x right of
/// it.
struct Environment {
    Texture panorama;                                                  ///< without pixels: white
    Vec3f radiance = Vec3f::all(1);                                    ///< multiplies the panorama
    Rows<3> to_world{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)};  ///< a rotation
};

}  // namespace hedgerow
