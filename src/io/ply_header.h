/// The header of a PLY file (Turk 1994): elements, and the properties of each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "byte_source.h"

namespace hedgerow::detail {

enum class PlyEncoding { ascii, little, big };
enum class PlyType { i1, u1, i2, u2, i4, u4, i8, u8, f4, f8 };

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count;  // the type of a list's length; none: not a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::uint64_t lines = 0;
    std::vector<std::string> textures;  // image files, in comments "TextureFile NAME" as MeshLab writes them

    const PlyElement* find(std::string_view name) const;
    /// Whether the file has vertices, and nothing that connects them.
    bool is_cloud() const;
};

PlyHeader read_ply_header(ByteSource& file);

}  // namespace hedgerow::detail
