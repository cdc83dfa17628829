#include "upright.h"

#include <filesystem>

#include "common.h"

namespace hedgerow::cli {

Upright upright_by_format(const std::string& path, const FlatBases& bases) {
    std::string format = ending_of(path);
    if (format == ".gz") format = ending_of(std::filesystem::path(path).stem().string());
    if (format == ".gltf" || format == ".glb") return {1, "as glTF defines it"};
    if (format == ".stl") return {2, "as in most STL files"};
    // OBJ, PLY, OFF and others do not define an upward axis. A saved index does not record its source's
    // format.
    if (bases.z.large_beside(bases.y)) return {2, "since the mesh lies on a flat base there"};
    return {1, "as in most scans and models"};
}

}  // namespace hedgerow::cli
