/// Pictures of particles: their density, projected along z, in a frame that stays the same for all of a run.
#pragma once

#include <string>
#include <vector>

#include <hedgerow/geometry/fixed_point.h>
#include <hedgerow/io/image.h>
#include <hedgerow/nbody/particles.h>

namespace hedgerow::cli {

/// What of the plane a picture shows, and where its colours end.
struct DensityFrame {
    Vec2d middle;
    double half_height = 1;
    double most = 1;  ///< the mass per pixel of the last colour

    /// A frame around nine tenths of the particles, or around a cube of a period, if it is above 0. The last
    /// colour is four times the greatest density in it.
    static DensityFrame around(const Particles& particles, int width, int height, double period = 0);
};

/// What a density picture takes a pixel while it is made, in bytes.
constexpr std::size_t memory_of_density_pixel =
    sizeof(Image::Pixel) + sizeof(double) + sizeof(FixedPoint::Sum);

/// Colours tell the logarithm of the mass in a pixel. Particles are spots of some pixels where they are few.
Image density_picture(const Particles& particles, const DensityFrame& frame, int width, int height,
                      const std::vector<std::string>& note);

}  // namespace hedgerow::cli
