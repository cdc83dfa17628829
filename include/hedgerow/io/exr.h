/// OpenEXR files.
#pragma once

#include <filesystem>

#include <hedgerow/io/notes.h>
#include <hedgerow/looks/layers.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// Writes an EXR file: scan lines of FLOAT and UINT channels, compressed without loss (ZIP), so that every
/// value is kept, infinities and NaN included. The format is "OpenEXR File Layout",
/// openexr.com/en/latest/OpenEXRFileLayout.html. The file is written under another name beside `path` and
/// then renamed. O(values) time, memory for a few rows.
///
/// Throws InputError if there are no pixels or no channels, if a channel does not have width × height values,
/// or if a name is invalid or used twice, or for a note that cannot be kept. Throws OutputError if the path
/// cannot be written; a pipe cannot, because the writer goes back in the file. Throws Cancelled if
/// `progress`, which counts pixels, is cancelled; a file that was there before is kept.
void save_exr(const std::filesystem::path& path, const Layers& layers, const Progress& progress = {},
              const Notes& notes = {});

/// Whether this build has OpenEXR (HEDGEROW_EXR=ON). Without it `save_exr` throws InputError.
bool exr_supported();

}  // namespace hedgerow
