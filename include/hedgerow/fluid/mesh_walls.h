/// Fluids and their walls inside of closed meshes, and around them.
#pragma once

#include <vector>

#include <hedgerow/fluid/fluid_walls.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// Which side of a mesh a fluid is on: inside of it, as in a tank that is drawn by its inner faces, or
/// outside, as around a stone or in a cup with walls of its own.
enum class FluidSide : bool { inside, outside };

/// Particles on the lattice of `fill_box` around a closed mesh, those inside of it that are half a spacing
/// from its surface or more. `origin` is a corner of the lattice; usually the low corner of the mesh's box,
/// so that boxes are filled as `fill_box` fills them.
///
/// Throws InputError for a mesh that is not closed, UsageError for a spacing that is not above 0 or for more
/// than 2^31 cells in the mesh's box. O(cells) questions of the signed distance to the surface.
std::vector<Vec3d> fill_mesh(const MeshIndex<double>& mesh, double spacing, const Vec3d& origin,
                             Threads threads = {});

/// Layers of particles behind the surface of a closed mesh, on the lattice of `fill_mesh`: those on the other
/// side than the fluid, up to `layers` spacings away. Walls thinner than a spacing have gaps. Throws as
/// `fill_mesh` does.
FluidWalls<3> walls_behind(const MeshIndex<double>& mesh, FluidSide fluid, double spacing,
                           const Vec3d& origin, int layers = 3, Threads threads = {});

}  // namespace hedgerow
