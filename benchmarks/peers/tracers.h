/// Other ray tracers as Tracers, for pictures: one that was found when the build was configured, or null.
#pragma once

#include <memory>

#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow::measure {

/// How Embree gets the rays of a batch: one by one, or all in one call, as rays that differ or are alike.
enum class EmbreeCalls { single, stream, coherent_stream };

/// Embree as a Tracer. Its hits are not ours to the last bit, and of equal t it takes any. Borrows the mesh.
std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>& mesh,
                                             EmbreeCalls calls = EmbreeCalls::single);

#ifndef HEDGEROW_HAS_EMBREE
inline std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>&, EmbreeCalls) {
    return nullptr;
}
#endif

}  // namespace hedgerow::measure
