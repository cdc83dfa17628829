/// Images of numbers in layers, and OpenEXR files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/strided.h>

namespace hedgerow {

/// One number a pixel, in rows from the top, left to right; borrowed from where it lies.
struct Channel {
    /// "R", or of a layer "normal.X": from 1 to 255 bytes.
    std::string name;
    std::variant<Strided<float>, Strided<std::uint32_t>> values;
};

/// Channels of width × height pixels. R, G and B are what viewers show: linear light, of sRGB's primaries.
struct Layers {
    int width = 0, height = 0;
    std::vector<Channel> channels;
};

/// Writes an EXR file: scan lines of FLOAT and UINT channels, packed without loss (ZIP), so that every value
/// is kept as it is, infinities and NaN too. By way of a file beside `path` that is then renamed. Throws
/// InputError if there are no pixels or no channels, a channel has other than width × height values, a name
/// is bad or there twice; OutputError if the path cannot be written (a pipe cannot: the format is not written
/// in one go). The format is "OpenEXR File Layout", openexr.com/en/latest/OpenEXRFileLayout.html. O(values),
/// in the memory of some rows.
///
/// `progress` is told of the pixels. Throws Cancelled if it is cancelled: the file of before then stays.
void save_exr(const std::filesystem::path& path, const Layers& layers, const Progress& progress = {});

/// Whether this build has OpenEXR (HEDGEROW_EXR=ON). Without it `save_exr` throws InputError.
bool exr_supported();

}  // namespace hedgerow
