/// The choice of one of many lights by power alone.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <hedgerow/geometry/box.h>
#include <hedgerow/render/lighting/cumulative_table.h>
#include <hedgerow/render/lighting/emitters.h>

namespace hedgerow {

/// An emitter, and the probability with which it was chosen. `no_emitter` if none can light the point.
struct LightChoice {
    std::uint32_t emitter = no_emitter;
    float probability = 0;

    explicit operator bool() const { return emitter != no_emitter; }
};

namespace detail {

/// The radius of the sphere around a box. For a box without extent it is 1.
inline double radius_around(const Box3f& box) {
    if (box.empty()) return 1;
    const double radius = length(Vec3d(box.high) - Vec3d(box.low)) / 2;
    return radius > 0 && radius < std::numeric_limits<double>::infinity() ? radius : 1;
}
/// A probability that is not 0, as a float that is not 0.
inline float probability_in_float(double p) {
    return std::max(rounded_to<float>(p), std::numeric_limits<float>::min());
}

}  // namespace detail

/// Chooses emitters by their power, wherever the point is. Memory: 8 bytes an emitter.
class PowerLights {
public:
    /// `scene` bounds the surfaces, and says how much power the sun and the environment have. O(emitters).
    explicit PowerLights(const Emitters& emitters, const Box3f& scene = {}) {
        std::vector<double> powers(emitters.size());
        for (std::size_t i = 0; i < powers.size(); ++i)
            powers[i] = emitters.power(i, detail::radius_around(scene));
        table_ = CumulativeTable(powers);
    }

    /// Chooses by a number in [0, 1). O(log emitters).
    LightChoice choose(const Vec3f&, const Vec3f&, double u) const {
        if (table_.empty()) return {};
        const TableChoice c = table_.choose(u);
        return {c.entry, detail::probability_in_float(c.probability)};
    }
    /// The probability with which `choose` chooses this emitter, in the same bits. O(1).
    float probability(const Vec3f&, const Vec3f&, std::uint32_t emitter) const {
        return detail::probability_in_float(table_.probability(emitter));
    }

private:
    CumulativeTable table_;
};

}  // namespace hedgerow
