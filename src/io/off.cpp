/// OFF meshes: normals, colours and texture coordinates are skipped.
#include "off_reader.h"
#include "readers.h"

namespace hedgerow::detail {

template <class T>
TriangleMesh<T> read_off(ByteSource& file) {
    NoOffLooks none;
    return OffReader<T, NoOffLooks>(file, none).read();
}

template TriangleMesh<float> read_off(ByteSource&);
template TriangleMesh<double> read_off(ByteSource&);

}  // namespace hedgerow::detail
