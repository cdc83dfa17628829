/// What the files of `hedgerow particles` share.
#pragma once

#include <string>
#include <vector>

#include <hedgerow/fluid/particle_system.h>

#include "common.h"
#include "view.h"

namespace hedgerow::cli {

/// The options of a run. Numbers below 0 are chosen by the size of the scene and by gravity.
struct ParticlesArguments : Common {
    std::string emit = "fountain", colour = "auto";
    double rate = -1, life = -1, speed = -1, spread = -1, radius = -1;
    double gravity = -1, drag = -1, restitution = -1, friction = 0.3;
    std::vector<double> wind{0, 0, 0};
    bool alone = false, no_floor = false, resume = false;
    double until = -1, every = -1, dt = -1;
    unsigned threads = 0;
    ViewArguments view;

    ParticlesArguments() { view.size = "640x480"; }
};

/// A mesh, perhaps with a floor below it, and the particles that are emitted about it. The index and emitters
/// borrow the mesh, so a scene stays where it is.
struct ParticlesScene {
    TriangleMesh<double> mesh;
    MeshIndex<double> index;
    ParticleSystemOptions options;
    Box3f shown;     ///< what pictures should show
    double size;     ///< the diagonal of the mesh without its floor
    double fastest;  ///< the speed of the last colour
    Upright upright;

    /// Loads or generates the mesh, and chooses the numbers of `a` that are not given.
    explicit ParticlesScene(ParticlesArguments& a);
    ParticlesScene(const ParticlesScene&) = delete;
    ParticlesScene& operator=(const ParticlesScene&) = delete;

private:
    void choose(ParticlesArguments& a, const Box3d& box, std::size_t triangles);
    void add_floor(const Box3d& box);
};

/// Makes pictures of particles before a mesh: balls and mesh cast shadows on each other.
class ParticlesPicture {
public:
    /// Borrows the arguments and the scene.
    ParticlesPicture(const ParticlesArguments& a, const ParticlesScene& scene);
    Image draw(const ParticleState& state) const;

private:
    const ParticlesArguments& arguments_;
    const ParticlesScene& scene_;
    MeshIndex<float> mesh_;  // rays of float have kernels
    Camera camera_;
};

/// Runs the verb. Returns the exit code.
int particles_run(ParticlesArguments a);

}  // namespace hedgerow::cli
