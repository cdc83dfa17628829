/// The control points of the Utah teapot, in the short form that their symmetry allows.
///
/// All 32 patches are mirror images of ten. Six of these are quarters of surfaces of revolution: a ring of
/// four control points runs from (r, 0, z) over (r, −q·r, z) and (q·r, −r, z) to (0, −r, z), with q = 0.56 (a
/// circle to 0.2 %) but for the ring at the knob, 0.5625. In the other four, halves of handle and spout, a
/// ring runs from (x0, 0, z0) over (x0, −w, z0) and (x1, −w, z1) to (x1, 0, z1).
///
/// Data: Newell 1975, with the later bottom; as widely printed since Crow 1987. x to the spout, z up.
#pragma once

#include <array>

namespace hedgerow::detail {

/// A quarter circle of control points.
struct TeapotRing {
    double radius, z, bulge = 0.56;
};

/// Half an oval of control points.
struct TeapotOval {
    double x0, z0, x1, z1, half_width;
};

/// Patches run from the inner side of the rim outward and downward; those of the lid run from its top.
inline constexpr std::array<std::array<TeapotRing, 4>, 6> teapot_revolved = {{
    {{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},  // rim
    {{{1.5, 2.4}, {1.75, 1.875}, {2, 1.35}, {2, 0.9}}},                // upper body
    {{{2, 0.9}, {2, 0.45}, {1.5, 0.225}, {1.5, 0.15}}},                // lower body
    {{{0, 3.15}, {0.8, 3.15, 0.5625}, {0, 2.85}, {0.2, 2.7}}},         // knob
    {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}},              // lid
    {{{1.5, 0.15}, {1.5, 0.075}, {1.425, 0}, {0, 0}}},                 // bottom
}};

/// Patches of the handle run from its upper end to its lower end, across from the inner side to the outer.
/// Patches of the spout run from its root to its mouth, across from the upper side to the lower.
inline constexpr std::array<std::array<TeapotOval, 4>, 4> teapot_swept = {{
    {{{-1.6, 2.025, -1.5, 2.25, 0.3},
      {-2.3, 2.025, -2.5, 2.25, 0.3},
      {-2.7, 2.025, -3, 2.25, 0.3},
      {-2.7, 1.8, -3, 1.8, 0.3}}},  // upper handle
    {{{-2.7, 1.8, -3, 1.8, 0.3},
      {-2.7, 1.575, -3, 1.35, 0.3},
      {-2.5, 1.125, -2.65, 0.9375, 0.3},
      {-2, 0.9, -1.9, 0.6, 0.3}}},  // lower handle
    {{{1.7, 1.425, 1.7, 0.6, 0.66},
      {2.6, 1.425, 3.1, 0.825, 0.66},
      {2.3, 2.1, 2.4, 2.025, 0.25},
      {2.7, 2.4, 3.3, 2.4, 0.25}}},  // lower spout
    {{{2.7, 2.4, 3.3, 2.4, 0.25},
      {2.8, 2.475, 3.525, 2.49375, 0.25},
      {2.9, 2.475, 3.45, 2.5125, 0.15},
      {2.8, 2.4, 3.2, 2.4, 0.15}}},  // spout's mouth
}};

}  // namespace hedgerow::detail
