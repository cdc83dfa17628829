/// The mesh that blocks of the documents may take for granted.
#include <hedgerow/scenes/meshes.h>

hedgerow::TriangleMesh<float> mesh_of_blocks();

hedgerow::TriangleMesh<float> mesh_of_blocks() {
    return hedgerow::teapot<float>(1000);
}
