/// The importance of groups of lights for a point: upper bounds of the light that may arrive, by which a
/// light tree is descended (Conty Estevez & Kulla, Importance Sampling of Many Lights with Adaptive Tree
/// Splitting, HPG 2018). The component `render` has it compiled.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <hedgerow/render/lighting/light_bounds.h>

namespace hedgerow {

/// Bounds of four groups of lights, side by side for the processor's vectors. Groups that are not set have no
/// light.
struct LightGroups {
    static constexpr std::size_t width = 4;
    using Lanes = std::array<double, width>;

    void set(std::size_t i, const LightBounds& b) {
        const Vec3d low(b.box.low), high(b.box.high), middle = (low + high) / 2.0, reach = (high - low) / 2.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            centre[k][i] = middle[axis], half[k][i] = reach[axis];
            normal[k][i] = static_cast<double>(b.normals.axis[axis]);
        }
        radius[i] = length(reach);
        most_nearness[i] = 1 / std::max(length2(reach), 0x1p-200);
        cosine[i] = static_cast<double>(b.normals.cosine), sine[i] = static_cast<double>(b.normals.sine);
        cos_emission[i] = static_cast<double>(b.cos_emission);
        back[i] = b.both_sides ? -1 : 1;
        intensity[i] = b.intensity;
        count = std::max(count, i + 1);
    }

    /// Bounds the light that arrives at a point from each group: intensity · cos · cos / d². The first cosine
    /// is of the least angle between a light's normal and the way to the point, less what the cone of normals
    /// and the extent of the box take off. The second is of the least angle between the receiver's normal and
    /// the way to a light. A receiver's normal has length 1; a normal of 0 leaves the second cosine out, as
    /// for volumes and transparent surfaces. Distances less than half the box's diagonal count as that.
    ///
    /// An importance is 0 only where no light of the group can arrive: cosines are raised by more than they
    /// may err by.
    Lanes importances(const Vec3f& point, const Vec3f& receiver) const;

    std::array<Lanes, 3> centre{}, half{};  ///< of the boxes
    std::array<Lanes, 3> normal{};          ///< the axes of the cones of normals
    Lanes radius{}, most_nearness{};        ///< half the boxes' diagonals; the most that 1/d² counts
    Lanes cosine{}, sine{}, cos_emission{};
    Lanes back{};  ///< −1 where a light emits alike about the opposite of its normal, else 1
    Lanes intensity{};
    std::size_t count = 0;  ///< groups from this one on are not set
};

}  // namespace hedgerow
