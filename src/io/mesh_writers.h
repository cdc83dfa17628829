/// The writers of meshes, one per format. STL and OFF are written without looks.
#pragma once

#include <hedgerow/io/mesh_file.h>
#include <hedgerow/primitives/triangle_mesh.h>

#include "output_file.h"

namespace hedgerow::detail {

template <class T>
void write_ply(OutputFile& file, const TriangleMesh<T>& mesh, const SavedLooks& looks);
template <class T>
void write_stl(OutputFile& file, const TriangleMesh<T>& mesh);
template <class T>
void write_obj(OutputFile& file, const TriangleMesh<T>& mesh, const SavedLooks& looks);
template <class T>
void write_off(OutputFile& file, const TriangleMesh<T>& mesh);

}  // namespace hedgerow::detail
