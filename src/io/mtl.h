/// Wavefront material libraries.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <hedgerow/looks/material.h>

#include "named_once.h"
#include "texture_shelf.h"

namespace hedgerow::detail {

/// Materials by name; the first of equal names counts.
using MaterialsByName = std::map<std::string, Material, std::less<>>;

/// Reads an `.mtl` file. docs/formats.md tells what becomes of its words; words that are not used are added
/// to `not_shown`. Textures are found beside `path`. Throws InputError for a file that cannot be read and for
/// numbers that are none.
void read_mtl(const std::filesystem::path& path, MaterialsByName& materials, TextureShelf& textures,
              NamedOnce& not_shown);

}  // namespace hedgerow::detail
