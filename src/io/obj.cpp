/// Wavefront OBJ meshes.
#include "obj_reader.h"
#include "readers.h"

namespace hedgerow::detail {

template <class T>
TriangleMesh<T> read_obj(ByteSource& file) {
    NoObjLooks none;
    return ObjReader<T, NoObjLooks>(file, none).read();
}

template TriangleMesh<float> read_obj(ByteSource&);
template TriangleMesh<double> read_obj(ByteSource&);

}  // namespace hedgerow::detail
