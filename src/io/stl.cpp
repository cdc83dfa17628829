/// STL meshes: ascii and binary, corners joined where they are equal.
#include "readers.h"
#include "stl_facets.h"

namespace hedgerow::detail {

template <class T>
TriangleMesh<T> read_stl(ByteSource& file) {
    Welder<T> welder{file};
    FaceList faces{file};
    std::vector<std::uint32_t> indices;
    std::vector<Vec<T, 3>> corners;
    for (StlFacets<T> facets(file); facets.next(corners);) {
        for (const Vec<T, 3>& p : corners) {
            check_room(file, welder.size(), "vertices");
            append(file, indices, welder.vertex(p));
        }
        check_room(file, faces.face_count(), "faces");
        faces.add(indices);
        indices.clear();
    }
    TriangleMesh<T> mesh;
    mesh.vertices = welder.take();
    faces.move_to(mesh);
    return mesh;
}

template TriangleMesh<float> read_stl(ByteSource&);
template TriangleMesh<double> read_stl(ByteSource&);

}  // namespace hedgerow::detail
