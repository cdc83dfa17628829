/// Checks of the values at corners that a file gives.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <hedgerow/looks/attributes.h>

#include "byte_source.h"
#include "named_once.h"

namespace hedgerow::detail {

template <int D>
bool is_finite(const Vec<float, D>& value) {
    return finite(value);
}
inline bool is_finite(const Rgba& value) {
    return finite(value.colour) && std::isfinite(value.alpha);
}

/// Throws InputError if a corner names a value that does not exist. Leaves out ordinals where there are no
/// values at all, and values that are not finite, with a warning. `what` names one of them.
/// O(triangles + values).
template <class T, class V>
void check_values(const ByteSource& file, const TriangleMesh<T>& mesh, CornerValues<V>& values,
                  const std::string& what, NamedOnce& warnings) {
    const std::size_t count = values.values.size();
    // Programs that write no coordinates name them all the same.
    if (count == 0 && !values.corners.empty()) {
        warnings.add(file.name() + ": faces name " + what + "s, and there are none. They are left out");
        values.corners.clear();
    }
    const auto face = [&](std::size_t i) { return mesh.faces.empty() ? i : mesh.faces[i]; };
    for (std::size_t i = 0; i < values.corners.size(); ++i)
        for (const std::uint32_t v : values.corners[i])
            if (v >= count && v != no_value)
                file.fail("face " + std::to_string(face(i)) + " names " + what + " " + std::to_string(v) +
                          ", but there are only " + std::to_string(count) +
                          " (counted from 0). Repair the file");
    if (std::all_of(values.values.begin(), values.values.end(), [](const V& v) { return is_finite(v); }))
        return;
    warnings.add(file.name() + ": a " + what + " is not finite. It is left out where it is used");
    if (values.corners.empty()) values.corners = mesh.triangles;
    for (TriangleIndices& corners : values.corners)
        for (std::uint32_t& v : corners)
            if (v < count && !is_finite(values.values[v])) v = no_value;
}

/// Checks all values of a mesh.
template <class T>
void check_attributes(const ByteSource& file, const TriangleMesh<T>& mesh, Attributes& attributes,
                      NamedOnce& warnings) {
    check_values(file, mesh, attributes.normals, "normal", warnings);
    for (auto& set : attributes.texture_coordinates)
        check_values(file, mesh, set, "texture coordinate", warnings);
    check_values(file, mesh, attributes.colours, "colour", warnings);
}

}  // namespace hedgerow::detail
