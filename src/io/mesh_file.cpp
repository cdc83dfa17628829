/// Chooses the reader and the writer of a mesh by the extension.
#include <hedgerow/io/mesh_file.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/validate.h>

#include "load_report.h"
#include "memory.h"
#include "mesh_writers.h"
#include "readers.h"
#include "text.h"

namespace hedgerow {

namespace detail {

std::string format_of(const std::filesystem::path& path) {
    const std::string extension = lower_case(path.extension().string());
    return extension == ".gz" ? lower_case(path.stem().extension().string()) : extension;
}

namespace {

[[noreturn]] void fail_unknown(const std::filesystem::path& path, const std::string& known) {
    const std::string extension = path.extension().string();
    throw InputError(path.string() + ": " +
                     (extension.empty() ? "the name has no extension, which says the format"
                                        : "the extension " + shown(extension) + " is not known") +
                     ". Known are " + known);
}

template <class T>
using ReadMesh = TriangleMesh<T> (*)(ByteSource&, const std::filesystem::path&);

/// The reader that the extension names. Throws InputError for a file that is not there and for an extension
/// that is not known.
template <class T>
ReadMesh<T> reader_of(const std::filesystem::path& path) {
    const std::string format = format_of(path);
    ReadMesh<T> read = nullptr;
    if (format == ".ply") read = [](ByteSource& file, const auto&) { return read_ply_mesh<T>(file); };
    if (format == ".stl") read = [](ByteSource& file, const auto&) { return read_stl<T>(file); };
    if (format == ".obj") read = [](ByteSource& file, const auto&) { return read_obj<T>(file); };
    if (format == ".off") read = [](ByteSource& file, const auto&) { return read_off<T>(file); };
    if (format == ".gltf" || format == ".glb") read = read_gltf<T>;
    check_readable(path);
    if (read == nullptr)
        fail_unknown(path,
                     ".ply .stl .obj .off .gltf .glb, each also with .gz: convert the file to one of these");
    return read;
}

/// Throws InputError if an index is out of range. The writers need no other check.
template <class T>
void check_indices(const TriangleMesh<T>& mesh) {
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const std::uint32_t v : mesh.triangles[i])
            if (v >= mesh.vertices.size())
                throw InputError("triangle " + std::to_string(i) + " of the mesh to save names vertex " +
                                 std::to_string(v) + ", but there are only " +
                                 std::to_string(mesh.vertices.size()) + ". Repair the mesh");
}

/// Throws InputError if the format has no such looks, or normals are not as many as vertices.
void check_looks(const std::string& extension, std::size_t vertices, const SavedLooks& looks) {
    if (extension != ".obj" && !(looks.material.empty() && looks.material_file.empty()))
        throw InputError("materials are not saved as " + extension + ". Save the mesh as .obj");
    if (looks.normals.empty()) return;
    if (extension != ".obj" && extension != ".ply")
        throw InputError("normals are not saved as " + extension + ". Save the mesh as .ply or .obj");
    if (looks.normals.size() != vertices)
        throw InputError("the mesh to save has " + std::to_string(vertices) + " vertices and " +
                         std::to_string(looks.normals.size()) + " normals. Give each vertex one");
}

}  // namespace
}  // namespace detail

template <class T>
TriangleMesh<T> load_mesh(const std::filesystem::path& path, const LoadOptions& options,
                          const Progress& progress) {
    const auto read = detail::reader_of<T>(path);
    return detail::within_memory(path, [&] {
        detail::ByteSource file(path, progress);
        TriangleMesh<T> mesh = validated(read(file, path), path.string(), options);
        detail::report_on(file, mesh.vertices, options);
        return mesh;
    });
}

template <class T>
void save_mesh(const std::filesystem::path& path, const TriangleMesh<T>& mesh, const Progress& progress,
               RoundingReport* report, const SavedLooks& looks) {
    const std::string extension = detail::lower_case(path.extension().string());
    const bool ply = extension == ".ply", stl = extension == ".stl", obj = extension == ".obj";
    if (!ply && !stl && !obj && extension != ".off") detail::fail_unknown(path, ".ply .stl .obj .off");
    detail::check_looks(extension, mesh.vertices.size(), looks);
    detail::check_indices(mesh);
    detail::OutputFile file(path, progress);
    file.expect(mesh.vertices.size() + mesh.size());
    if (ply) detail::write_ply(file, mesh, looks);
    if (obj) detail::write_obj(file, mesh, looks);
    if (stl) detail::write_stl(file, mesh);
    if (extension == ".off") detail::write_off(file, mesh);
    file.commit();
    if (report != nullptr)
        *report =
            detail::rounding_report(file.rounding(), detail::box_of(mesh.vertices), mesh.vertices.size());
}

template TriangleMesh<float> load_mesh(const std::filesystem::path&, const LoadOptions&, const Progress&);
template TriangleMesh<double> load_mesh(const std::filesystem::path&, const LoadOptions&, const Progress&);
template void save_mesh(const std::filesystem::path&, const TriangleMesh<float>&, const Progress&,
                        RoundingReport*, const SavedLooks&);
template void save_mesh(const std::filesystem::path&, const TriangleMesh<double>&, const Progress&,
                        RoundingReport*, const SavedLooks&);

}  // namespace hedgerow
