/// Snapshots in HDF5, laid out as those of GADGET (Springel 2005) and the codes that follow it.
#pragma once

#include <filesystem>

#include <hedgerow/nbody/particles.h>

namespace hedgerow::detail {

/// Whether the name of a file ends in .hdf5 or .h5.
bool names_hdf5(const std::filesystem::path& path);

/// Both throw UsageError where the build has no HDF5.
MotionState load_gadget(const std::filesystem::path& path);
void save_gadget(const std::filesystem::path& path, const MotionState& state, double period);

}  // namespace hedgerow::detail
