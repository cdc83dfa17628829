/// Lamps, crockery, books, pictures, plants and rugs.
#include "interior_things.h"

#include <algorithm>

namespace hedgerow::detail {
namespace {

void sphere(Model& m, const Pose& p, const Vec3d& middle, double radius) {
    // Two arcs, each nearly a quarter of a circle.
    const double k = 0.42;
    m.loft(
        p, middle, Axis::z, m.disc(radius),
        m.curve({{0, -radius}, {k, -radius}, {1, -k * radius}, {1, k * radius}, {k, radius}, {0, radius}}));
}

}  // namespace

void pendant_lamp(Model& m, const Pose& p, double length) {
    m.bar(p, {0, 0, -length}, Axis::z, m.disc(0.003), length);
    m.loft(p, {}, Axis::z, m.disc(0.05), m.curve({{0, -0.04}, {0.4, -0.04}, {1, -0.02}, {1, 0}, {0, 0}}));
    // The shade: outside upward, inside downward, 2 mm thick.
    m.loft(p, {0, 0, -length - 0.2}, Axis::z, m.disc(0.2),
           m.curve({{0.99, 0},
                    {1, 0},
                    {0.95, 0.08},
                    {0.5, 0.16},
                    {0.2, 0.2},
                    {0.19, 0.2},
                    {0.19, 0.198},
                    {0.49, 0.157},
                    {0.94, 0.077},
                    {0.99, 0}}));
    sphere(m, p, {0, 0, -length - 0.1}, 0.04);
}
void standing_lamp(Model& m, const Pose& p) {
    m.loft(p, {}, Axis::z, m.disc(0.14),
           m.curve({{0, 0},
                    {1, 0},
                    {1, 0},
                    {1, 0.01},
                    {0.9, 0.02},
                    {0.1, 0.03},
                    {0.08, 0.06},
                    {0.08, 0.06},
                    {0.08, 1.4},
                    {0, 1.4}}));
    m.loft(p, {0, 0, 1.35}, Axis::z, m.disc(0.2),
           {{1, 0}, {0.98, 0.03}, {0.6, 0.3}, {0.59, 0.3}, {0.97, 0.03}, {0.99, 0}, {1, 0}});
    sphere(m, p, {0, 0, 1.47}, 0.035);
}

void vase(Model& m, const Pose& p, double height) {
    const double h = height;
    m.loft(p, {}, Axis::z, m.disc(0.3 * h),
           m.curve({{0, 0},
                    {0.5, 0},
                    {0.5, 0.01 * h},
                    {0.6, 0.15 * h},
                    {1, 0.4 * h},
                    {0.9, 0.6 * h},
                    {0.3, 0.8 * h},
                    {0.35, 0.95 * h},
                    {0.5, h},
                    {0.47, h},
                    {0.3, 0.93 * h},
                    {0.25, 0.8 * h},
                    {0, 0.7 * h}}));
}
void fruit_bowl(Model& m, const Pose& p, Random random) {
    m.loft(p, {}, Axis::z, m.disc(0.16),
           m.curve({{0, 0.004},
                    {0.4, 0},
                    {0.4, 0.01},
                    {0.6, 0.012},
                    {0.95, 0.05},
                    {1, 0.08},
                    {1, 0.082},
                    {0.98, 0.082},
                    {0.9, 0.05},
                    {0.5, 0.018},
                    {0, 0.016}}));
    for (int i = 0; i < 9; ++i) {
        const double radius = random.uniform(0.03, 0.04), ring = i < 6 ? 0.075 : 0.035;
        const Vec2d toward = random.direction<2>();
        sphere(m, p, {product(toward[0], ring), product(toward[1], ring), i < 6 ? 0.055 : 0.11}, radius);
    }
}

void table_setting(Model& m, const Pose& p) {
    // The plate.
    m.loft(p, {}, Axis::z, m.disc(0.13),
           m.curve({{0, 0.003},
                    {0.6, 0.001},
                    {0.65, 0.004},
                    {0.95, 0.016},
                    {1, 0.018},
                    {1, 0.02},
                    {0.95, 0.02},
                    {0.65, 0.007},
                    {0, 0.006}}));
    // The glass.
    m.loft(p, {0.16, 0.14, 0}, Axis::z, m.disc(0.035),
           m.curve({{0, 0},
                    {1, 0},
                    {1, 0.003},
                    {0.12, 0.006},
                    {0.1, 0.02},
                    {0.1, 0.08},
                    {0.5, 0.09},
                    {1.1, 0.12},
                    {0.9, 0.18},
                    {0.88, 0.18},
                    {1.07, 0.12},
                    {0.4, 0.094},
                    {0, 0.092}}));
    m.block(p, {0.16, 0, 0}, {0.015, 0.2, 0.001});  // the knife
    for (int i = -1; i <= 1; ++i) m.block(p, {-0.16 + 0.006 * i, 0.075, 0.001}, {0.002, 0.05, 0.001});
    m.block(p, {-0.16, -0.03, 0.001}, {0.012, 0.14, 0.001});  // the fork, below its prongs
}
void cup(Model& m, const Pose& p) {
    m.loft(p, {}, Axis::z, m.disc(0.04),
           m.curve({{0, 0},
                    {0.7, 0},
                    {0.75, 0.01},
                    {0.98, 0.04},
                    {1, 0.08},
                    {1, 0.081},
                    {0.95, 0.081},
                    {0.93, 0.04},
                    {0.7, 0.012},
                    {0, 0.01}}));
    // The handle is a ring of a flat strip.
    m.loft(p, {0.05, 0.004, 0.045}, Axis::y, m.disc(0.022),
           {{1, -0.008}, {1, 0}, {0.75, 0}, {0.75, -0.008}, {1, -0.008}});
}
void pot(Model& m, const Pose& p, double radius) {
    const double r = radius;
    m.loft(p, {}, Axis::z, m.disc(r),
           m.curve({{0, 0},
                    {0.95, 0},
                    {1, 0.05 * r},
                    {1, 1.2 * r},
                    {1.04, 1.2 * r},
                    {1.04, 1.22 * r},
                    {1, 1.23 * r},
                    {0.6, 1.35 * r},
                    {0.1, 1.4 * r},
                    {0.1, 1.4 * r},
                    {0.1, 1.45 * r},
                    {0.25, 1.5 * r},
                    {0.2, 1.6 * r},
                    {0, 1.6 * r}}));
    for (const double side : {-1.0, 1.0})
        m.loft(p, {side * 1.15 * r, 0, r}, Axis::z, m.disc(0.3 * r),
               {{1, 0}, {1, 0.02 * r}, {0.8, 0.02 * r}, {0.8, 0}, {1, 0}});
}

void books(Model& m, const Pose& p, double width, Random random) {
    const double cover = 0.002;
    for (double x = 0; x < width - 0.05;) {
        const double thick = random.uniform(0.012, 0.05), height = random.uniform(0.17, 0.27);
        const double depth = random.uniform(0.12, 0.19), from = random.uniform(0.06, 0.08);
        const double front = from + depth;
        m.box(p, {x, from, 0}, {x + cover, front, height});
        m.box(p, {x + thick - cover, from, 0}, {x + thick, front, height});
        m.box(p, {x + cover, front - cover, 0}, {x + thick - cover, front, height});
        m.box(p, {x + cover, from + 0.004, 0.004}, {x + thick - cover, front - cover, height - 0.004});
        x += thick + (random.uniform() < 0.06 ? 0.08 : 0.001);
    }
}
void pens(Model& m, const Pose& p, Random random) {
    m.loft(p, {}, Axis::z, m.disc(0.04), {{0, 0}, {1, 0}, {1, 0.1}, {0.96, 0.1}, {0.96, 0.003}, {0, 0.003}});
    for (int i = 0; i < 7; ++i) {
        const Vec2d at = random.direction<2>() * 0.028;
        m.loft(p, {at[0], at[1], 0.004}, Axis::z, m.disc(0.004),
               {{0, 0}, {0.2, 0.002}, {1, 0.02}, {1, 0.15}, {0.9, 0.155}, {0, 0.155}});
    }
}

void picture(Model& m, const Pose& p, const Vec2d& size) {
    const double a = size[1] / 2, b = size[0] / 2;  // across y the outline is in (z, x)
    m.loft(p, {}, Axis::y, rectangle(a, b),
           m.curve({{1, 0},
                    {1, 0.02},
                    {1, 0.02},
                    {0.97, 0.028},
                    {0.94, 0.02},
                    {0.92, 0.024},
                    {0.9, 0.01},
                    {0.9, 0.01},
                    {0, 0.01}}));
}

void plant(Model& m, const Pose& p, int leaves, Random random) {
    m.loft(p, {}, Axis::z, m.disc(0.15),
           m.curve({{0, 0},
                    {0.7, 0},
                    {0.7, 0},
                    {0.95, 0.25},
                    {1, 0.26},
                    {1, 0.28},
                    {0.95, 0.28},
                    {0.9, 0.24},
                    {0.9, 0.24},
                    {0, 0.24}}));
    for (int i = 0; i < leaves; ++i) {
        const double out = random.uniform(0.1, 0.45), up = random.uniform(0.25, 0.9);
        const Pose leaf = p({0, 0, 0.24}, random.direction<2>());
        m.leaf(
            leaf,
            m.curve(
                {{0.01, 0}, {0.1 * out, 0.5 * up}, {0.4 * out, up}, {0.9 * out, 0.9 * up}, {out, 0.6 * up}}),
            random.uniform(0.02, 0.06));
    }
}

void rug(Model& m, const Pose& p, const Vec2d& size) {
    m.loft(p, {}, Axis::z, m.rounded(size[0] / 2, size[1] / 2, 0.05),
           {{0, 0}, {0.995, 0}, {1, 0.003}, {0.995, 0.008}, {0, 0.008}});
    const int fringes = static_cast<int>(size[1] / 0.02);
    for (const double side : {-1.0, 1.0})
        for (int i = 1; i < fringes; ++i)
            m.block(p, {side * (size[0] / 2 + 0.03), 0.02 * i - size[1] / 2, 0}, {0.07, 0.003, 0.002});
}

}  // namespace hedgerow::detail
