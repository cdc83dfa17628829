/// What the files of `hedgerow nbody` share.
#pragma once

#include <string>

#include <hedgerow/nbody/motion.h>

#include "common.h"

namespace hedgerow::cli {

struct NbodyArguments : Common {
    bool forces = false, compare = false, check = false, resume = false, block_steps = false;
    std::string from, kernel = "wendland", size = "800x800", format, snapshots = "npy";
    double accuracy = 1e-3, softening = -1, gravity = 1, until = -1, dt = 0, every = 0, eta = 0.025,
           period = 0;
    BareSteps bare;  // of size 0: steps are dt long
    unsigned threads = 0;
};

/// Loads or generates the particles of the scene.
MotionState load_particles(const NbodyArguments& a);
/// The softening of --kernel and --softening.
Softening softening_of(const NbodyArguments& a, const Particles& particles);

/// The three things that the verb does. Each returns the exit code.
int nbody_forces(const NbodyArguments& a);
int nbody_run(NbodyArguments a);
int nbody_compare(const NbodyArguments& a);

}  // namespace hedgerow::cli
