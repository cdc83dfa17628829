/// What cones see of a model.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <hedgerow/instances/instance_set.h>
#include <hedgerow/looks/model.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/render/visibility/cones.h>

namespace hedgerow {

/// Cones over a model, all of whose instances are written out, since a cone is none in the space of an object
/// that is stretched. Fragments name instances and elements as hits on a ModelScene do. Takes a mesh and an
/// index of all triangles in the world.
template <std::floating_point T>
class ModelCones final : public Cones<T> {
public:
    /// Throws as `Model::in_world` and `build` do.
    explicit ModelCones(const Model<T>& model, Executor& executor)
        : mesh_(model.in_world()), index_(build<WideBvh>(mesh_, executor)), cones_(index_) {
        std::uint32_t first = 0;
        for (const PlacedObject& placed : model.instances) {
            const auto size = static_cast<std::uint32_t>(model.objects[placed.object].mesh.size());
            if (size == 0) continue;  // not in a ModelScene either
            placed_.push_back({first, placed.mirrors(), model.objects[placed.object].mesh.view()});
            first += size;
        }
    }
    ModelCones(const ModelCones&) = delete;
    ModelCones& operator=(const ModelCones&) = delete;

    std::size_t bytes() const { return index_.bytes(); }
    void look(const ConeRays<T, 3>& cone, std::vector<SeenFragment<T>>& found) const override {
        cones_.look(cone, found);
        for (SeenFragment<T>& fragment : found) name_instance(fragment.hit);
    }
    float open(const ConeRays<T, 3>& cone) const override { return cones_.open(cone); }

private:
    struct Placed {
        std::uint32_t first;  // of its triangles, in the world
        bool mirrors;         // corners are then in the order c, b, a
        TriangleMeshView<T> mesh;
    };

    void name_instance(Hit<T>& hit) const {
        const auto next = std::upper_bound(placed_.begin(), placed_.end(), hit.element,
                                           [](std::uint32_t i, const Placed& p) { return i < p.first; });
        const Placed& placed = *std::prev(next);
        hit.instance = static_cast<std::uint32_t>(next - placed_.begin() - 1);
        hit.element -= placed.first;
        hit.primitive = placed.mesh.id(hit.element);
        if (placed.mirrors) hit.v = std::max(T(0), 1 - hit.u - hit.v);
    }

    const TriangleMesh<T> mesh_;
    const MeshIndex<T> index_;
    const IndexCones<MeshIndex<T>> cones_;
    std::vector<Placed> placed_;
};

}  // namespace hedgerow
