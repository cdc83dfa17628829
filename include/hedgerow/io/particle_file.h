/// Particles, and the state of a motion, from and to files of rows and snapshots.
#pragma once

#include <filesystem>

#include <hedgerow/nbody/particles.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// Reads particles from a snapshot in HDF5 as GADGET and SWIFT lay it out (`.hdf5`, `.h5`; particles of all
/// types, one after the other; of a snapshot in several files NAME.0.hdf5, NAME.1.hdf5, ... any names all),
/// or from a file of rows (`.npy`, `.csv`, `.json`, as `open_rows` in io/rows.h; or a point cloud, as
/// `load_points`). Its columns are one of
///
/// - `x y z`: particles at rest, of equal masses, 1 together;
/// - `x y z mass`: particles at rest;
/// - `x y z vx vy vz mass`;
/// - `x y z vx vy vz mass potential ax ay az time`: what `save_state` writes. Of a file with other columns
///   beside these, those of the first list that it has all of are read, from the last on.
///
/// The state's accelerations and potentials are empty where the file has none. Throws InputError for a file
/// that has none of these columns, for particles of a snapshot without masses, for numbers that are not
/// finite or beyond 2^480, for one of other faults, and for particles of a file of different times; Cancelled
/// if `progress` is cancelled. O(size of the file).
MotionState load_state(const std::filesystem::path& path, const Progress& progress = {});

/// Writes a state: a row a particle, with the columns above, in double; or, to `.hdf5` and `.h5`, a snapshot
/// as GADGET's of particles of type 1, with the side of a periodic cube as its BoxSize. The file appears once
/// it is finished, whole. Throws InputError for a state without accelerations and potentials (those of a
/// Motion have them), OutputError if it cannot be written, UsageError if its extension names no
/// format or one that the build lacks. O(n).
void save_state(const std::filesystem::path& path, const MotionState& state, double period = 0);

}  // namespace hedgerow
