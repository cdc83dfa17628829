/// A set of primitives of any kind, as a comparison sees it.
#pragma once

#include <memory>
#include <string_view>

#include <hedgerow/any_index.h>

#include "motion.h"
#include "surface_places.h"

namespace hedgerow::measure {

template <std::floating_point T, int D>
class Scene {
public:
    virtual ~Scene() = default;
    /// What the primitives are called, in the plural.
    virtual const char* noun() const = 0;
    virtual std::size_t size() const = 0;
    /// An index over the scene, which must outlive it. Throws as `build_any` does.
    virtual std::unique_ptr<AnyIndex<T, D>> build(std::string_view structure, Executor& executor) const = 0;
    /// A copy, whose primitives can be moved within their arrays.
    virtual std::unique_ptr<Scene> copy() const = 0;
    /// Moves the primitives of a copy.
    virtual void move(const Bend<T, D>& motion) = 0;
    /// Whether the primitives have surfaces (in the plane: lengths) that rays can hit.
    virtual bool has_surfaces() const = 0;
    /// The middle of a primitive's box, a random place on the primitive, and its area (surface_places.h).
    virtual Vec<T, D> middle(std::size_t i) const = 0;
    virtual SurfacePlace<T, D> place_on(std::size_t i, Random& random) const = 0;
    virtual double area(std::size_t i, double unit) const = 0;
};

template <class T>
Triangle<T, 3> shape_of(const TriangleMeshView<T>& set, std::size_t i) {
    return set.triangle(i);
}
template <class T, int D>
Sphere<T, D> shape_of(const SphereSetView<T, D>& set, std::size_t i) {
    return set.sphere(i);
}
template <class T>
Segment<T, 2> shape_of(const SegmentSetView<T>& set, std::size_t i) {
    return set.segment(i);
}
template <class T, int D>
Vec<T, D> shape_of(const PointCloudView<T, D>& set, std::size_t i) {
    return set.point(i);
}

template <class T>
const char* noun_of(const TriangleMesh<T>&) {
    return "triangles";
}
template <class T, int D>
const char* noun_of(const SphereSet<T, D>&) {
    return "spheres";
}
template <class T>
const char* noun_of(const SegmentSet<T>&) {
    return "segments";
}
template <class T, int D>
const char* noun_of(const PointCloud<T, D>&) {
    return "points";
}

template <class P>
class SceneOf final : public Scene<typename P::Scalar, P::dimension> {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;

    /// Borrows the primitives, unless `own` holds them.
    explicit SceneOf(const P& primitives, std::unique_ptr<P> own = nullptr)
        : primitives_(primitives), view_(view_of(primitives)), own_(std::move(own)) {}

    const char* noun() const override { return noun_of(primitives_); }
    std::size_t size() const override { return view_.size(); }
    std::unique_ptr<AnyIndex<T, D>> build(std::string_view structure, Executor& executor) const override {
        return build_any(structure, view_, executor);
    }
    std::unique_ptr<Scene<T, D>> copy() const override {
        auto own = std::make_unique<P>(primitives_);
        const P& primitives = *own;
        return std::make_unique<SceneOf>(primitives, std::move(own));
    }
    void move(const Bend<T, D>& motion) override { motion(*own_); }
    bool has_surfaces() const override { return !PointSet<ViewOf<P>>; }
    Vec<T, D> middle(std::size_t i) const override { return view_.bounds(i).center(); }
    SurfacePlace<T, D> place_on(std::size_t i, Random& random) const override {
        return measure::place_on(shape_of(view_, i), random);
    }
    double area(std::size_t i, double unit) const override { return area_of(shape_of(view_, i), unit); }

private:
    const P& primitives_;
    ViewOf<P> view_;
    std::unique_ptr<P> own_;
};

}  // namespace hedgerow::measure
