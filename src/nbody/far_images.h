/// What all charges' far images do in a periodic cube: a multipole of the whole cube, one conversion by sums
/// over the lattice, and a local expansion.
#pragma once

#include <cstddef>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/nbody/kernels.h>
#include <hedgerow/parallel/executor.h>

#include "tides.h"

namespace hedgerow::detail {

/// Places in rows.
struct PlaceRows {
    const double *x, *y, *z;
    std::size_t count;
};

/// The images of a cube that are near, by the number of sides that they lie away along each axis. An image
/// and its opposite are as far from the middle of the list, where the cube itself is.
std::vector<Vec3d> near_image_places(double side);

/// Charges in a periodic cube, and as much of the opposite charge, spread evenly.
class FarImages {
public:
    /// `order` is that of the cube's multipole. R is float or double. O(charges · order²).
    template <class R>
    FarImages(double side, const Vec3d& middle, int order, const PlaceRows& places, const R* charges,
              Executor& executor);
    /// Adds what far images and the even charge do. O(targets · order²).
    void act(const TargetRows<double>& targets, Executor& executor) const;
    /// Adds their tidal tensors.
    void bend(const PlaceRows& targets, const TideRows& tides, Executor& executor) const;

private:
    double side_, charge_ = 0;
    Vec3d middle_;
    int order_;
    Vec3d dipole_;
    std::vector<double> local_;  // packed, of order + 1
};

/// The order of the cube's multipole for an accuracy of the gradients.
int far_order(double accuracy);

}  // namespace hedgerow::detail
