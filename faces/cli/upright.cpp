#include "upright.h"

#include <filesystem>

namespace hedgerow::cli {

Upright upright_by_format(const std::string& path, const FlatBases& bases) {
    const auto lower_extension = [](const std::filesystem::path& p) {
        std::string text = p.extension().string();
        for (char& c : text)
            if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        return text;
    };
    std::string format = lower_extension(path);
    if (format == ".gz") format = lower_extension(std::filesystem::path(path).stem());
    if (format == ".gltf" || format == ".glb") return {1, "as glTF defines it"};
    if (format == ".dae") return {1, "as COLLADA files are read"};
    if (format == ".stl") return {2, "as in most STL files"};
    // OBJ, PLY, OFF and others do not say; a saved index does not know what it was made of.
    if (bases.z.large_beside(bases.y)) return {2, "since the mesh lies on a flat base there"};
    return {1, "as in most scans and models"};
}

}  // namespace hedgerow::cli
