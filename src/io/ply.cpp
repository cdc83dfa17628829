/// PLY meshes and points: ascii, little and big endian, any elements and properties.
#include "mesh_parts.h"
#include "ply_elements.h"
#include "ply_header.h"
#include "readers.h"

namespace hedgerow::detail {

template <class T>
TriangleMesh<T> read_ply_mesh(ByteSource& file) {
    const PlyHeader header = read_ply_header(file);
    PlyValues<T> values(file, header);
    TriangleMesh<T> mesh;
    FaceList faces(file);
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            const PlyWanted wanted = coordinates_of(file, element);
            if (element.count > 0) need_axes(file, wanted, 3);
            read_element(values, element, wanted, sizeof(Vec<T, 3>),
                         [&](const PlyEntry<T>& entry) { append(file, mesh.vertices, entry.point); });
        } else if (element.name == "face") {
            read_element(values, element, corners_of(file, element), sizeof(TriangleIndices),
                         [&](const PlyEntry<T>& entry) { faces.add(entry.corners); });
        } else if (element.name == "tristrips") {
            read_element(values, element, corners_of(file, element), sizeof(TriangleIndices),
                         [&](const PlyEntry<T>& entry) {
                             for_each_of_strips(entry.corners, [&](const auto& t) { faces.add(t); });
                         });
        } else {
            read_element(values, element, PlyWanted{}, 0, [](const PlyEntry<T>&) {});
        }
    }
    values.tell_surplus();
    faces.move_to(mesh);
    return mesh;
}

template <class T, int D>
PointCloud<T, D> read_ply_points(ByteSource& file) {
    const PlyHeader header = read_ply_header(file);
    PlyValues<T> values(file, header);
    PointCloud<T, D> cloud;
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex") {
            read_element(values, element, PlyWanted{}, 0, [](const PlyEntry<T>&) {});
            continue;
        }
        const PlyWanted wanted = coordinates_of(file, element);
        // Read the points, and nothing after them.
        if (element.count > 0) need_axes(file, wanted, D);
        read_element(values, element, wanted, sizeof(Vec<T, D>), [&](const PlyEntry<T>& entry) {
            const Vec<T, 3>& p = entry.point;
            if constexpr (D == 3) {
                append(file, cloud.points, p);
            } else {
                if (p[2] != 0) values.fail("z is not 0, but the points are read in 2D. Read them in 3D");
                append(file, cloud.points, Vec<T, D>(p[0], p[1]));
            }
        });
        break;
    }
    return cloud;
}

template TriangleMesh<float> read_ply_mesh(ByteSource&);
template TriangleMesh<double> read_ply_mesh(ByteSource&);
template PointCloud<float, 2> read_ply_points(ByteSource&);
template PointCloud<float, 3> read_ply_points(ByteSource&);
template PointCloud<double, 2> read_ply_points(ByteSource&);
template PointCloud<double, 3> read_ply_points(ByteSource&);

}  // namespace hedgerow::detail
