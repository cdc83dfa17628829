/// The default index over triangles of float, compiled once.
#include <hedgerow/mesh_index.h>

namespace hedgerow {

template class Index<WideBvh<float, 3>, TriangleMeshView<float>>;
template Hit<float> closest_hit(const MeshIndex<float>&, const Ray3f&, const KeepAll&, const NoVisits&);
template bool any_hit(const MeshIndex<float>&, const Ray3f&, const KeepAll&, const NoVisits&);
template Near<float, 3> closest_point(const MeshIndex<float>&, const Vec3f&, const PointOptions&,
                                      const KeepAll&, const NoVisits&);

}  // namespace hedgerow
