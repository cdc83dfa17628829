/// Random places on the surfaces of a scene.
#pragma once

#include <algorithm>
#include <vector>

#include "scene.h"

namespace hedgerow::measure {

/// Draws random places on all primitives, evenly by area (in the plane by length).
template <std::floating_point T, int D>
class SurfaceSamples {
public:
    /// `unit` is a length of the order of the scene's size. O(n) time, 8 bytes a primitive.
    SurfaceSamples(const Scene<T, D>& scene, double unit) : scene_(scene) {
        double sum = 0;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            const double share = scene.area(i, unit);
            if (share > 0) sum += share;
            until_.push_back(sum);
        }
    }
    /// Whether no primitive has an area (a length).
    bool empty() const { return until_.empty() || !(until_.back() > 0); }
    /// A random place. O(log n) time. Not if `empty()`.
    SurfacePlace<T, D> place(Random& random) const {
        const double at = product(random.uniform(), until_.back());
        const auto found = std::upper_bound(until_.begin(), until_.end(), at);
        const auto i =
            std::min<std::size_t>(static_cast<std::size_t>(found - until_.begin()), until_.size() - 1);
        return scene_.place_on(i, random);
    }

private:
    const Scene<T, D>& scene_;
    std::vector<double> until_;
};

}  // namespace hedgerow::measure
