/// Ray casting: for each sample of a picture, the closest hit of its ray (the lecture's second loop).
#pragma once

#include <hedgerow/render/tracer.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

template <std::floating_point T>
class RayCasting final : public Visibility<T> {
public:
    /// Borrows the tracer.
    explicit RayCasting(const Tracer<T>& tracer) : tracer_(tracer) {}
    void look(const PixelBox&, std::span<const Ray<T, 3>> rays, std::span<Hit<T>> hits,
              std::span<Visits> visits, PictureCosts& costs) const override {
        costs.rays += rays.size();
        costs.use += tracer_.closest_hits(rays, hits, visits);
    }

private:
    const Tracer<T>& tracer_;
};

}  // namespace hedgerow
