/// Ray casting: for each sample of a picture, the closest hit of its ray (the lecture's second loop).
#pragma once

#include <functional>
#include <utility>

#include <hedgerow/render/tracer.h>
#include <hedgerow/render/visibility/visibility.h>

namespace hedgerow {

template <std::floating_point T>
class RayCasting final : public Visibility<T> {
public:
    /// Borrows the tracer. `keeps` may refuse hits.
    explicit RayCasting(const Tracer<T>& tracer, std::function<bool(const Hit<T>&)> keeps = {})
        : tracer_(tracer) {
        if (keeps) keeps_ = [only = std::move(keeps)](std::size_t, const Hit<T>& hit) { return only(hit); };
    }
    void look(const PixelBox&, std::span<const Ray<T, 3>> rays, std::span<Hit<T>> hits,
              std::span<Visits> visits, PictureCosts& costs) const override {
        costs.rays += rays.size();
        costs.use += tracer_.closest_hits(rays, hits, visits, keeps_);
    }

private:
    const Tracer<T>& tracer_;
    typename Tracer<T>::Filter keeps_;
};

}  // namespace hedgerow
