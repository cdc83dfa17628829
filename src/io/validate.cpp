/// Checks meshes and points, and leaves out bad ones.
#include <hedgerow/io/validate.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <hedgerow/base/error.h>

#include "no_faces.h"
#include "text.h"

namespace hedgerow {

namespace {

template <class T, int D>
bool is_good(const Vec<T, D>& p) {
    for (int i = 0; i < D; ++i)
        if (!(std::abs(p[i]) <= largest_coordinate<T>)) return false;  // false for NaN too
    return true;
}

/// "vertex 7 is (nan, 0, 1): ..."
template <class T, int D>
std::string bad_coordinates(std::string_view name, const std::string& what, const Vec<T, D>& p) {
    std::string message = std::string(name) + ": " + what + " is (";
    for (int i = 0; i < D; ++i) message += (i == 0 ? "" : ", ") + detail::shortest_text(p[i]);
    return message + "), which is " + (std::is_same_v<T, float> ? "not within ±2^60" : "not within ±2^480") +
           ". Repair the file, or drop what is bad (--drop-bad, LoadOptions::drop_bad)";
}

/// The face that a triangle belongs to in the file.
template <class T>
std::string face_name(const TriangleMesh<T>& mesh, std::size_t triangle) {
    return "face " + std::to_string(mesh.faces.empty() ? triangle : mesh.faces[triangle]);
}

template <class T>
void validate_faces(const TriangleMesh<T>& mesh, std::string_view name) {
    const std::string start = std::string(name) + ": ";
    const std::size_t count = mesh.vertices.size();
    // There must be triangles.
    if (mesh.triangles.empty() && count == 0)
        throw detail::NoFaces(start + "holds neither faces nor points. Is it the right file?");
    if (mesh.triangles.empty())
        throw detail::NoFaces(
            start + "holds only points (" + std::to_string(count) +
            " vertices, and no face with three corners), and a mesh is needed. load_points reads "
            "them, and load_scene, as most verbs do");
    // Ids: none, or one per triangle, never descending.
    if (!mesh.faces.empty() && mesh.faces.size() != mesh.triangles.size())
        throw InputError(start + "has " + std::to_string(mesh.faces.size()) + " face ids for " +
                         std::to_string(mesh.triangles.size()) + " triangles. Give one a triangle, or none");
    const auto step = std::adjacent_find(mesh.faces.begin(), mesh.faces.end(), std::greater<>());
    if (step != mesh.faces.end())
        throw InputError(start + "face id " + std::to_string(*step) + " stands before " +
                         std::to_string(*(step + 1)) + ". Sort the triangles by face id");
    // Every index must name a vertex.
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t v : mesh.triangles[i])
            if (v >= count)
                throw InputError(start + face_name(mesh, i) + " names vertex " + std::to_string(v) +
                                 ", but there are only " + std::to_string(count) +
                                 " vertices (counted from 0). Repair the file");
}

/// A copy of a mesh without bad vertices, and without all triangles of the faces that name one.
template <class T>
TriangleMesh<T> without_bad(const TriangleMesh<T>& mesh) {
    constexpr std::uint32_t gone = 0xFFFFFFFFu;
    TriangleMesh<T> kept;
    // Keep the good vertices, and renumber them.
    std::vector<std::uint32_t> renumbered(mesh.vertices.size(), gone);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        if (!is_good(mesh.vertices[i])) continue;
        renumbered[i] = static_cast<std::uint32_t>(kept.vertices.size());
        kept.vertices.push_back(mesh.vertices[i]);
    }
    // Keep the faces all of whose triangles name good vertices.
    const auto face = [&](std::size_t i) {
        return mesh.faces.empty() ? static_cast<std::uint32_t>(i) : mesh.faces[i];
    };
    for (std::size_t begin = 0, end = 0; begin < mesh.size(); begin = end) {
        bool good = true;
        for (end = begin; end < mesh.size() && face(end) == face(begin); ++end)
            for (const std::uint32_t v : mesh.triangles[end]) good = good && renumbered[v] != gone;
        for (std::size_t i = begin; good && i < end; ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            kept.triangles.push_back({renumbered[a], renumbered[b], renumbered[c]});
            kept.faces.push_back(face(i));
        }
    }
    // If no face was left out, the ids are those from before: perhaps none.
    if (kept.size() == mesh.size()) kept.faces = mesh.faces;
    return kept;
}

/// The positions of the good points.
template <class T, int D>
std::vector<std::uint32_t> good_ones(const PointCloud<T, D>& cloud) {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (is_good(cloud.points[i])) kept.push_back(static_cast<std::uint32_t>(i));
    return kept;
}

/// The number of faces that have triangles.
template <class T>
std::size_t face_count(const TriangleMesh<T>& mesh) {
    std::size_t faces = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        faces += mesh.faces.empty() || i == 0 || mesh.faces[i] != mesh.faces[i - 1];
    return faces;
}

template <class Points>
std::size_t first_bad(const Points& points) {
    return static_cast<std::size_t>(
        std::find_if(points.begin(), points.end(), [](const auto& p) { return !is_good(p); }) -
        points.begin());
}

template <class T>
void validate_vertices(const TriangleMesh<T>& mesh, std::string_view name) {
    if (const std::size_t i = first_bad(mesh.vertices); i < mesh.vertices.size())
        throw InputError(bad_coordinates(name, "vertex " + std::to_string(i), mesh.vertices[i]));
}

template <class T, int D>
void validate_count(const PointCloud<T, D>& cloud, std::string_view name) {
    if (cloud.points.empty())
        throw InputError(std::string(name) + ": holds no points. Is it the right file?");
}

}  // namespace

template <class T>
void validate_mesh(const TriangleMesh<T>& mesh, std::string_view name) {
    validate_faces(mesh, name);
    validate_vertices(mesh, name);
}

template <class T>
TriangleMesh<T> validated(TriangleMesh<T> mesh, std::string_view name, const LoadOptions& options) {
    validate_faces(mesh, name);
    if (!options.drop_bad) {
        validate_vertices(mesh, name);
    } else if (first_bad(mesh.vertices) < mesh.vertices.size()) {
        const std::size_t vertices = mesh.vertices.size(), faces = face_count(mesh);
        mesh = without_bad(mesh);
        if (options.report != nullptr) {
            options.report->dropped_points += vertices - mesh.vertices.size();
            options.report->dropped_faces += faces - face_count(mesh);
        }
        if (mesh.triangles.empty())
            throw InputError(std::string(name) +
                             ": every face has a vertex that is NaN, infinite or too far " +
                             "away, so none is left. Repair the file");
    }
    return mesh;
}

template <class T, int D>
void validate_points(const PointCloud<T, D>& cloud, std::string_view name) {
    validate_count(cloud, name);
    if (const std::size_t i = first_bad(cloud.points); i < cloud.points.size())
        throw InputError(bad_coordinates(name, "point " + std::to_string(i), cloud.points[i]));
}

template <class T, int D>
PointCloud<T, D> validated(PointCloud<T, D> cloud, std::string_view name, const LoadOptions& options) {
    validate_count(cloud, name);
    if (options.drop_bad && first_bad(cloud.points) < cloud.size()) {
        std::vector<std::uint32_t> kept = good_ones(cloud);
        for (std::size_t i = 0; i < kept.size(); ++i) cloud.points[i] = cloud.points[kept[i]];
        if (options.report != nullptr) {
            options.report->dropped_points += cloud.size() - kept.size();
            options.report->kept_points = kept;
        }
        cloud.points.resize(kept.size());
        if (cloud.points.empty())
            throw InputError(std::string(name) +
                             ": every point is NaN, infinite or too far away, so none is " +
                             "left. Repair the file");
    }
    validate_points(cloud, name);
    return cloud;
}

template void validate_mesh(const TriangleMesh<float>&, std::string_view);
template void validate_mesh(const TriangleMesh<double>&, std::string_view);
template TriangleMesh<float> validated(TriangleMesh<float>, std::string_view, const LoadOptions&);
template TriangleMesh<double> validated(TriangleMesh<double>, std::string_view, const LoadOptions&);
template void validate_points(const PointCloud<float, 2>&, std::string_view);
template void validate_points(const PointCloud<float, 3>&, std::string_view);
template void validate_points(const PointCloud<double, 2>&, std::string_view);
template void validate_points(const PointCloud<double, 3>&, std::string_view);
template PointCloud<float, 2> validated(PointCloud<float, 2>, std::string_view, const LoadOptions&);
template PointCloud<float, 3> validated(PointCloud<float, 3>, std::string_view, const LoadOptions&);
template PointCloud<double, 2> validated(PointCloud<double, 2>, std::string_view, const LoadOptions&);
template PointCloud<double, 3> validated(PointCloud<double, 3>, std::string_view, const LoadOptions&);

}  // namespace hedgerow
