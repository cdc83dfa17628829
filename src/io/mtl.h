/// Wavefront material libraries.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <hedgerow/looks/material.h>

#include "model_readers.h"

namespace hedgerow::detail {

/// Materials by name; the first of equal names counts.
using MaterialsByName = std::map<std::string, Material, std::less<>>;

/// Reads an `.mtl` file for the model of a context. docs/formats.md tells what becomes of its words; words
/// that are not used are added to `not_shown`, and negative colours to `warnings`. Textures are found beside
/// `path`. Throws InputError for a file that cannot be read and for numbers that are none.
void read_mtl(const std::filesystem::path& path, const ModelContext& context, MaterialsByName& materials);

}  // namespace hedgerow::detail
