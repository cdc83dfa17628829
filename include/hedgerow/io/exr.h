/// Images with named channels of numbers, and OpenEXR files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <hedgerow/base/strided.h>
#include <hedgerow/io/notes.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

/// One value per pixel, in rows from the top, each from left to right. Borrows the caller's array.
struct Channel {
    /// A name such as "R", or "normal.X" for X of the layer "normal": 1 to 255 bytes, none of them 0.
    std::string name;
    std::variant<Strided<float>, Strided<std::uint32_t>> values;
};

/// Channels of width × height pixels each. Viewers show R, G and B, as linear light with the primaries of
/// sRGB.
struct Layers {
    int width = 0, height = 0;
    std::vector<Channel> channels;
};

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
