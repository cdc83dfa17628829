/// Other ray tracers as Tracers, for pictures: one that was found when the build was configured, or null.
#pragma once

#include <memory>

#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow::measure {

/// Embree, ray by ray. Its hits are not ours to the last bit, and of equal t it takes any. Borrows the mesh.
std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>& mesh);

#ifndef HEDGEROW_HAS_EMBREE
inline std::unique_ptr<Tracer<float>> embree_tracer(const TriangleMesh<float>&) {
    return nullptr;
}
#endif

}  // namespace hedgerow::measure
