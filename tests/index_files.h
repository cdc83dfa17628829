/// Helpers for tests of saved indexes.
#pragma once

#include <hedgerow/io/index_file.h>
#include <hedgerow/scenes/meshes.h>

#include "io_support.h"
#include "matrix.h"

namespace hedgerow::testing_io {

inline constexpr LoadIndexOptions ways_to_load[] = {{Verify::contents, true},  {Verify::contents, false},
                                                    {Verify::checksums, true}, {Verify::checksums, false},
                                                    {Verify::header, true},    {Verify::header, false}};

inline WideOptions options_of(int width, WideBuilder builder = WideBuilder::medium) {
    WideOptions options;
    options.width = width;
    options.builder = builder;
    return options;
}

template <class T>
MeshIndex<T> built(const TriangleMesh<T>& mesh, int width = 8, Executor& executor = serial_executor()) {
    return build<WideBvh>(mesh, options_of(width), executor);
}

template <class T>
TriangleMesh<T> with_faces(TriangleMesh<T> mesh) {
    for (std::uint32_t i = 0; i < mesh.size(); ++i) mesh.faces.push_back(7 + i / 3);
    return mesh;
}

template <class T>
TriangleMesh<T> one_triangle() {
    return {{{0, 0, 0.25f}, {1, 0, 0.5f}, {0, 1, 0.75f}}, {{0, 1, 2}}, {}};
}

/// The bytes of a saved index of 30 triangles with face ids.
inline std::string small_file(const TempFolder& folder) {
    save_index(folder / "small.hedgerow", built(with_faces(soup<float>(30)), 4));
    return contents(folder / "small.hedgerow");
}

}  // namespace hedgerow::testing_io
