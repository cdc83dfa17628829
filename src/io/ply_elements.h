/// The elements of PLY files, entry by entry.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/geometry/vec.h>

#include "mesh_parts.h"
#include "ply_header.h"
#include "ply_values.h"

namespace hedgerow::detail {

/// Which properties of an element are wanted: their positions in the element, −1 if there is none.
struct PlyWanted {
    int axis[3] = {-1, -1, -1};
    int corners = -1;
    std::vector<int> numbers;  // further properties that are no lists
    int list = -1;             // a further list
    bool strips = false;       // corners are those of strips, each but the last with a −1 behind it

    int axis_of(int property) const {
        return static_cast<int>(std::find(axis, axis + 3, property) - axis);  // 3: none
    }
};

/// Stands between the strips of an entry.
inline constexpr auto end_of_strip = static_cast<std::uint32_t>(most_ordinals);

/// The wanted values of an entry of an element.
template <class T>
struct PlyEntry {
    Vec<T, 3> point;
    std::vector<std::uint32_t> corners;
    std::vector<float> numbers;  // in the order in which they are wanted
    std::vector<float> list;
};

/// Calls take(entry) for each entry of the element, in their order. `memory_bytes` is what the wanted
/// properties of an entry take in memory, 0 if none is wanted.
template <class T, class F>
void read_element(PlyValues<T>& values, const PlyElement& element, const PlyWanted& wanted,
                  std::size_t memory_bytes, F take) {
    values.enter(element);
    if (element.properties.empty()) return;
    // Refuse a count that the file or the memory cannot hold.
    if (memory_bytes > 0)
        check_declared(values.file(), element.count, values.least_bytes(element), memory_bytes,
                       wanted.corners >= 0 ? element.name == "face" ? "faces" : "strips" : "vertices");
    PlyEntry<T> entry;
    entry.numbers.resize(wanted.numbers.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
        values.enter(i);
        entry.point = {};
        // Read the wanted properties of the entry and skip the others.
        for (int k = 0; k < static_cast<int>(element.properties.size()); ++k) {
            const PlyProperty& p = element.properties[static_cast<std::size_t>(k)];
            const std::uint64_t n = p.count ? values.list_size(*p.count) : 1;
            if (k == wanted.corners) {
                entry.corners.clear();
                for (std::uint64_t j = 0; j < n; ++j) {
                    const std::int64_t v = values.integer(p.type);
                    if (v == -1 && wanted.strips) {
                        append(values.file(), entry.corners, end_of_strip);
                        continue;
                    }
                    if (v < 0 || v >= static_cast<std::int64_t>(most_ordinals))
                        values.fail("names vertex " + std::to_string(v) + ", which cannot be");
                    append(values.file(), entry.corners, static_cast<std::uint32_t>(v));
                }
            } else if (const int axis = wanted.axis_of(k); axis < 3) {
                entry.point[axis] = values.coordinate(p.type);
            } else if (k == wanted.list) {
                entry.list.clear();
                for (std::uint64_t j = 0; j < n; ++j)
                    append(values.file(), entry.list,
                           rounded<float>(static_cast<double>(values.real(p.type))));
            } else if (const auto number = std::find(wanted.numbers.begin(), wanted.numbers.end(), k);
                       number != wanted.numbers.end()) {
                entry.numbers[static_cast<std::size_t>(number - wanted.numbers.begin())] =
                    rounded<float>(static_cast<double>(values.real(p.type)));
            } else {
                values.skip(p.type, n);
            }
        }
        take(entry);
    }
}

inline PlyWanted coordinates_of(const ByteSource& file, const PlyElement& element) {
    PlyWanted wanted;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        if (p.name != "x" && p.name != "y" && p.name != "z") continue;
        if (p.count)
            file.fail("the property '" + p.name + "' of the vertices is a list. Write it as a number");
        wanted.axis[p.name[0] - 'x'] = static_cast<int>(k);
    }
    return wanted;
}

inline void need_axes(const ByteSource& file, const PlyWanted& wanted, int dimension) {
    for (int a = 0; a < dimension; ++a)
        if (wanted.axis[a] < 0)
            file.fail(std::string("the vertices have no property '") + "xyz"[a] + "'. Write them with it");
}

/// Calls add(corners) for each triangle of strips, whose every second triangle is turned over.
template <class F>
void for_each_of_strips(std::span<const std::uint32_t> corners, F add) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] == end_of_strip) {
            begin = i + 1;
        } else if (i >= begin + 2) {
            const bool is_turned = (i - begin) % 2 != 0;
            add(TriangleIndices{corners[i - (is_turned ? 1 : 2)], corners[i - (is_turned ? 2 : 1)],
                                corners[i]});
        }
    }
}

/// The corners of faces or of strips.
inline PlyWanted corners_of(const ByteSource& file, const PlyElement& element) {
    PlyWanted wanted;
    wanted.strips = element.name == "tristrips";
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        if (wanted.corners >= 0 || (p.name != "vertex_indices" && p.name != "vertex_index")) continue;
        if (!p.count || p.type >= PlyType::f4)
            file.fail("the property '" + p.name + "' of the element '" + element.name +
                      "' is not a list of whole numbers. Write it as " +
                      "'property list uchar int vertex_indices'");
        wanted.corners = static_cast<int>(k);
    }
    if (wanted.corners < 0 && element.count > 0)
        file.fail("the element '" + element.name + "' has no property 'vertex_indices'. Write them with it");
    return wanted;
}

}  // namespace hedgerow::detail
