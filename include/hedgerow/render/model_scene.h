/// A model that rays can be cast at, on two levels: an index for each object, and one over the instances.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <hedgerow/instances/instance_set.h>
#include <hedgerow/looks/model.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/render/shading/appearance.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow {

/// The indexes of a model, and what pictures ask of it. Borrows the model.
template <std::floating_point T>
class ModelScene {
public:
    using Instances = InstanceSet<MeshIndex<T>>;

    /// Builds an index for each object that has triangles and is placed somewhere, and one over the
    /// instances. Throws as `build` does, and InputError for a model without triangles.
    explicit ModelScene(const Model<T>& model, Executor& executor)
        : instances_(placed(model, executor)),
          index_(build<WideBvh>(instances_, executor)),
          tracer_(index_),
          of_object_(tracer_of_object()),
          surfaces_(instances_),
          lookups_(model, std::move(numbers_)),
          appearances_(lookups_) {}
    ModelScene(const ModelScene&) = delete;
    ModelScene& operator=(const ModelScene&) = delete;

    const Instances& instances() const { return instances_; }
    const Box<T, 3>& bounds() const { return index_.bounds(); }
    /// Of one object that stands where it is, its own index answers: one level, and the same hits.
    const Tracer<T>& tracer() const {
        return of_object_ ? static_cast<const Tracer<T>&>(*of_object_) : tracer_;
    }
    const SurfacesOf<Instances>& surfaces() const { return surfaces_; }
    const Appearances<T>& appearances() const { return appearances_; }
    const ModelLookups<T>& lookups() const { return lookups_; }
    /// Bytes of all indexes.
    std::size_t bytes() const {
        std::size_t sum = index_.bytes();
        for (const auto& index : objects_)
            if (index) sum += index->bytes();
        return sum;
    }

private:
    Instances placed(const Model<T>& model, Executor& executor) {
        objects_.resize(model.objects.size());
        std::vector<Instance<MeshIndex<T>>> all;
        for (std::uint32_t i = 0; i < model.instances.size(); ++i) {
            const std::uint32_t object = model.instances[i].object;
            const TriangleMesh<T>& mesh = model.objects[object].mesh;
            if (mesh.size() == 0) continue;
            if (!objects_[object])
                objects_[object] = std::make_unique<const MeshIndex<T>>(build<WideBvh>(mesh, executor));
            all.push_back(Instance(*objects_[object], model.instances[i].to_world));
            numbers_.push_back(i);
        }
        if (all.empty()) throw InputError("the model has no triangles, so there is nothing to see");
        return Instances(all);
    }

    std::optional<IndexTracer<MeshIndex<T>>> tracer_of_object() const {
        if (instances_.size() != 1 || !(instances_.view()[0].transform() == Transform<3>()))
            return std::nullopt;
        return std::make_optional<IndexTracer<MeshIndex<T>>>(instances_.view()[0].index());
    }

    std::vector<std::unique_ptr<const MeshIndex<T>>> objects_;
    std::vector<std::uint32_t> numbers_;  // of the instances, in the model
    const Instances instances_;
    const IndexOf<WideBvh, Instances> index_;
    const IndexTracer<IndexOf<WideBvh, Instances>> tracer_;
    const std::optional<IndexTracer<MeshIndex<T>>> of_object_;
    const SurfacesOf<Instances> surfaces_;
    const ModelLookups<T> lookups_;
    const ModelAppearances<T> appearances_;
};

}  // namespace hedgerow
