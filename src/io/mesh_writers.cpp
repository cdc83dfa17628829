/// PLY, STL, OBJ and OFF.
#include "mesh_writers.h"

#include <cmath>

#include <hedgerow/base/error.h>

#include "text.h"

namespace hedgerow::detail {

namespace {
template <class T>
void append_point(std::string& line, const Vec<T, 3>& p) {
    for (int i = 0; i < 3; ++i) {
        if (i > 0) line += ' ';
        append_number(line, p[i]);
    }
    line += '\n';
}
template <class T>
void write_point(OutputFile& file, const Vec<T, 3>& p) {
    for (int i = 0; i < 3; ++i) file.little(p[i]);
}

/// Throws InputError for a finite coordinate that a float makes infinite.
template <class T>
void expect_floats(const Vec<T, 3>& p, std::uint32_t vertex) {
    for (int i = 0; i < 3; ++i)
        if (std::isfinite(p[i]) && std::isinf(rounded<float>(static_cast<double>(p[i]))))
            throw InputError("vertex " + std::to_string(vertex) + " of the mesh to save has the coordinate " +
                             shortest_text(p[i]) +
                             ", but STL has floats, which end at 3.4e+38. Save it as .ply, .obj or .off");
}
}  // namespace

template <class T>
void write_ply(OutputFile& file, const TriangleMesh<T>& mesh, const SavedLooks& looks) {
    const std::string type = std::is_same_v<T, float> ? "float" : "double";
    const bool small = mesh.vertices.size() < (std::size_t(1) << 31);
    std::string header = "ply\nformat binary_little_endian 1.0\n";
    header += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
    for (const char axis : {'x', 'y', 'z'}) header += "property " + type + " " + axis + "\n";
    if (!looks.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
    header += "element face " + std::to_string(mesh.size()) + "\n";
    header +=
        std::string("property list uchar ") + (small ? "int" : "uint") + " vertex_indices\nend_header\n";
    file.write(header);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        write_point(file, mesh.vertices[i]);
        if (!looks.normals.empty()) write_point(file, looks.normals[i]);
        file.advance();
    }
    for (const TriangleIndices& t : mesh.triangles) {
        file.advance();
        file.little(std::uint8_t(3));
        for (const std::uint32_t v : t) file.little(v);
    }
}

template <class T>
void write_stl(OutputFile& file, const TriangleMesh<T>& mesh) {
    if (mesh.size() > 0xFFFFFFFFu)
        throw InputError("a mesh of more than 4294967295 triangles does not fit STL. Save it as .ply");
    file.expect(mesh.size());  // vertices are written with the triangles
    std::string header = "binary STL";
    header.resize(80, ' ');
    file.write(header);
    file.little(static_cast<std::uint32_t>(mesh.size()));
    for (const auto& [a, b, c] : mesh.triangles) {
        file.advance();
        for (const std::uint32_t v : {a, b, c}) expect_floats(mesh.vertices[v], v);
        const Vec3d p(mesh.vertices[a]), q(mesh.vertices[b]), r(mesh.vertices[c]);
        write_point(file, Vec3f(normalized(cross(q - p, r - p))));
        for (const std::uint32_t v : {a, b, c}) {
            const Vec<T, 3>& corner = mesh.vertices[v];
            for (int i = 0; i < 3; ++i)
                file.little(coordinate<float>(static_cast<double>(corner[i]), file.rounding()));
        }
        file.little(std::uint16_t(0));
    }
}

template <class T>
void write_obj(OutputFile& file, const TriangleMesh<T>& mesh, const SavedLooks& looks) {
    std::string line;
    if (!looks.material_file.empty()) file.write("mtllib " + looks.material_file + "\n");
    for (const Vec<T, 3>& p : mesh.vertices) {
        line.assign("v ", 2);
        append_point(line, p);
        file.write(line);
        file.advance();
    }
    for (std::size_t i = 0; i < looks.normals.size(); ++i) {
        line.assign("vn ", 3);
        append_point(line, looks.normals[i]);
        file.write(line);
    }
    if (!looks.material.empty()) file.write("usemtl " + looks.material + "\n");
    for (const auto& [a, b, c] : mesh.triangles) {
        file.advance();
        line.assign(1, 'f');
        for (const std::uint32_t v : {a, b, c}) {
            line += ' ', append_number(line, std::uint64_t(v) + 1);
            if (!looks.normals.empty()) line += "//", append_number(line, std::uint64_t(v) + 1);
        }
        file.write(line += '\n');
    }
}

template <class T>
void write_off(OutputFile& file, const TriangleMesh<T>& mesh) {
    file.write("OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.size()) + " 0\n");
    std::string line;
    for (const Vec<T, 3>& p : mesh.vertices) {
        line.clear();
        append_point(line, p);
        file.write(line);
        file.advance();
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        file.advance();
        line.assign(1, '3');
        for (const std::uint32_t v : {a, b, c}) line += ' ', append_number(line, v);
        file.write(line += '\n');
    }
}

template void write_ply(OutputFile&, const TriangleMesh<float>&, const SavedLooks&);
template void write_ply(OutputFile&, const TriangleMesh<double>&, const SavedLooks&);
template void write_stl(OutputFile&, const TriangleMesh<float>&);
template void write_stl(OutputFile&, const TriangleMesh<double>&);
template void write_obj(OutputFile&, const TriangleMesh<float>&, const SavedLooks&);
template void write_obj(OutputFile&, const TriangleMesh<double>&, const SavedLooks&);
template void write_off(OutputFile&, const TriangleMesh<float>&);
template void write_off(OutputFile&, const TriangleMesh<double>&);

}  // namespace hedgerow::detail
