/// A scene with its looks: objects, their instances, cameras, materials, textures and lights.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/looks/attributes.h>
#include <hedgerow/looks/light.h>
#include <hedgerow/looks/material.h>
#include <hedgerow/looks/texture.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Triangles in a space of their own, with what they look like.
template <class T>
struct Object {
    std::string name;
    TriangleMesh<T> mesh;
    Attributes attributes;
    /// The material of each triangle, as an ordinal in the model. If it is empty, all have `material`.
    std::vector<std::uint32_t> materials;
    std::uint32_t material = 0;

    std::uint32_t material_of(std::size_t triangle) const {
        return materials.empty() ? material : materials[triangle];
    }
};

/// An object in the world. Where the transform mirrors, the fronts of triangles stay fronts: corners are
/// then counterclockwise in the order c, b, a.
struct PlacedObject {
    std::string name;
    std::uint32_t object = 0;
    Transform<3> to_world;

    bool mirrors() const {
        const auto& m = to_world.there().linear;
        return dot(cross(m[0], m[1]), m[2]) < 0;
    }
};

/// What a perspective camera sees: the vertical field of view in radians.
struct PerspectiveView {
    double field_of_view = 0.7853981633974483;
};
/// What an orthographic camera sees: the height of the picture in the world's units.
struct OrthographicView {
    double height = 2;
};

/// A camera of a file. In its own space it looks along −z, with y up.
struct FileCamera {
    std::string name;
    std::variant<PerspectiveView, OrthographicView> view;
    std::optional<double> aspect;  ///< width over height
    Affine<3> to_world;
};

/// A scene with its looks. T is float or double.
///
/// Every ordinal in it names something that exists: objects of instances, materials of triangles, textures
/// of materials, and values of corners (or `no_value`). There is at least one material.
template <class T>
struct Model {
    std::vector<Object<T>> objects;
    std::vector<PlacedObject> instances;
    std::vector<FileCamera> cameras;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::optional<Environment> environment;

    /// What the file says and nothing here represents, such as "KHR_materials_clearcoat". Each is named once,
    /// in the order of the file.
    std::vector<std::string> not_shown;
    /// What was missing or damaged, and what takes its place. Each is told once.
    std::vector<std::string> warnings;

    /// The number of triangles, with all instances written out.
    std::uint64_t triangles() const {
        std::uint64_t sum = 0;
        for (const PlacedObject& i : instances) sum += objects[i.object].mesh.size();
        return sum;
    }
    /// All instances as one mesh in the world, whose fronts stay fronts. It has no ids of faces. O(vertices
    /// and triangles of all instances). Throws InputError for more than 2^32 − 1 of either.
    TriangleMesh<T> in_world() const {
        TriangleMesh<T> all;
        for (const PlacedObject& placed : instances) {
            const TriangleMesh<T>& mesh = objects[placed.object].mesh;
            const std::size_t first = all.vertices.size();
            if (std::max(first + mesh.vertices.size(), all.size() + mesh.size()) > 0xFFFFFFFFu)
                throw InputError("the instances have too many triangles or vertices for one mesh");
            for (const auto& v : mesh.vertices)
                all.vertices.push_back(transformed(placed.to_world.there(), v));
            for (TriangleIndices corners : mesh.triangles) {
                for (std::uint32_t& v : corners) v += static_cast<std::uint32_t>(first);
                if (placed.mirrors()) std::swap(corners[0], corners[2]);
                all.triangles.push_back(corners);
            }
        }
        return all;
    }
};

}  // namespace hedgerow
