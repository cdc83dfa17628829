/// Tables, chairs, sofas, shelves, beds and cupboards.
#include "interior_things.h"

namespace hedgerow::detail {
namespace {

/// A cushion, rounded above, below and at its corners.
void cushion(Model& m, const Pose& p, const Vec3d& foot, const Vec3d& size) {
    const double h = size[2];
    m.loft(p, foot, Axis::z,
           m.rounded(size[0] / 2, size[1] / 2, 0.3 * (size[0] < size[1] ? size[0] : size[1])),
           m.curve({{0, 0},
                    {0.5, 0.02 * h},
                    {0.9, 0.02 * h},
                    {1, 0.25 * h},
                    {1, 0.75 * h},
                    {0.9, 0.92 * h},
                    {0.5, h},
                    {0, h}}));
}

/// A board whose edges are bevelled by 2 mm.
void board(Model& m, const Pose& p, const Vec3d& foot, const Vec3d& size) {
    const double a = size[0] / 2, b = size[1] / 2, edge = 0.002, inner = 1 - edge / (a < b ? b : a);
    m.loft(p, foot, Axis::z, rectangle(a, b),
           {{0, 0}, {inner, 0}, {1, edge}, {1, size[2] - edge}, {inner, size[2]}, {0, size[2]}});
}

void turned_leg(Model& m, const Pose& p, const Vec3d& foot, double radius, double height) {
    const double h = height;
    m.loft(p, foot, Axis::z, m.disc(radius),
           m.curve({{0, 0},
                    {0.5, 0},
                    {0.5, 0},
                    {0.6, 0.03 * h},
                    {0.4, 0.06 * h},
                    {0.5, 0.1 * h},
                    {0.7, 0.5 * h},
                    {0.9, 0.68 * h},
                    {0.5, 0.72 * h},
                    {0.5, 0.74 * h},
                    {1, 0.78 * h},
                    {1, 0.84 * h},
                    {0.7, 0.86 * h},
                    {1, 0.88 * h},
                    {1, h},
                    {1, h},
                    {0, h}}));
}

}  // namespace

void table(Model& m, const Pose& p, const Vec3d& size) {
    const double x = size[0] / 2, y = size[1] / 2, z = size[2], top = 0.03, leg = 0.035, inset = 0.06;
    m.loft(p, {0, 0, z - top}, Axis::z, m.rounded(x, y, 0.04),
           m.curve({{0, 0},
                    {0.98, 0},
                    {0.98, 0},
                    {1, 0.3 * top},
                    {1, 0.9 * top},
                    {0.995, top},
                    {0.995, top},
                    {0, top}}));
    for (const double sx : {-1.0, 1.0}) {
        for (const double sy : {-1.0, 1.0})
            turned_leg(m, p, {sx * (x - inset), sy * (y - inset), 0}, leg, z - top);
        m.block(p, {sx * (x - inset), 0, z - top - 0.09}, {0.02, 2 * (y - inset - leg), 0.088});
        m.block(p, {0, sx * (y - inset), z - top - 0.09}, {2 * (x - inset - leg), 0.02, 0.088});
    }
}

void chair(Model& m, const Pose& p) {
    const double side = 0.2, seat = 0.45;
    cushion(m, p, {0, 0, seat}, {0.42, 0.42, 0.05});
    for (const double sx : {-1.0, 1.0}) {
        turned_leg(m, p, {sx * side, side, 0}, 0.018, seat);
        m.bar(p, {sx * side, -side, 0}, Axis::z, m.disc(0.014), 0.95);
        m.bar(p, {sx * side, -side, 0.2}, Axis::y, m.disc(0.008), 2 * side);
    }
    m.bar(p, {-side, side, 0.25}, Axis::x, m.disc(0.008), 2 * side);
    for (int i = -3; i <= 3; ++i)
        m.loft(p, {0.055 * i, -side, seat + 0.06}, Axis::z, m.disc(0.007),
               m.curve({{0.7, 0}, {0.7, 0.1}, {1.4, 0.16}, {0.7, 0.22}, {0.7, 0.42}}));
    m.loft(p, {-side - 0.02, -side, 0.9}, Axis::x, m.rounded(0.012, 0.05, 0.01),
           m.curve({{0, 0}, {0.8, 0}, {1, 0.02}, {1, 0.42}, {0.8, 0.44}, {0, 0.44}}));
}

void sofa(Model& m, const Pose& p, double width) {
    const double depth = 0.9, arm = 0.16;
    const int seats = width > 1.7 ? 3 : 2;
    const double seat = (width - 2 * arm) / seats;
    board(m, p, {0, depth / 2, 0.1}, {width - 0.04, depth - 0.04, 0.18});
    for (const double side : {-1.0, 1.0}) {
        cushion(m, p, {side * (width - arm) / 2, depth / 2, 0.1}, {arm, depth, 0.5});
        for (const double y : {0.08, depth - 0.08})
            m.bar(p, {side * (width / 2 - 0.08), y, 0}, Axis::z, m.disc(0.02), 0.1);
    }
    for (int i = 0; i < seats; ++i) {
        const double x = (i - (seats - 1) / 2.0) * seat;
        cushion(m, p, {x, 0.52, 0.28}, {seat - 0.005, 0.74, 0.17});
        cushion(m, p, {x, 0.14, 0.42}, {seat - 0.01, 0.2, 0.45});
    }
    cushion(m, p({-0.3 * width, 0.42, 0.45}, {0.96, 0.28}), {}, {0.42, 0.12, 0.4});
    cushion(m, p({0.28 * width, 0.4, 0.45}, {0.8, -0.6}), {}, {0.38, 0.12, 0.36});
}

void bookcase(Model& m, const Pose& p, double width, int shelves) {
    const double depth = 0.28, side = 0.02, height = 0.32 * shelves + 0.1;
    for (const double s : {-1.0, 1.0})
        board(m, p, {s * (width - side) / 2, depth / 2, 0}, {side, depth, height});
    for (int i = 0; i <= shelves; ++i)
        board(m, p, {0, depth / 2, 0.06 + 0.32 * i}, {width - 2 * side, depth, 0.018});
    m.box(p, {-width / 2 + side, 0, 0.06}, {width / 2 - side, 0.005, height});
}

void bed(Model& m, const Pose& p) {
    const double width = 1.6, length = 2.05;
    // Sides, legs and pillows.
    for (const double side : {-1.0, 1.0}) {
        board(m, p, {side * (width / 2 + 0.02), length / 2, 0.18}, {0.03, length, 0.2});
        turned_leg(m, p, {side * (width / 2 + 0.02), 0.03, 0}, 0.04, 1.1);
        turned_leg(m, p, {side * (width / 2 + 0.02), length, 0}, 0.04, 0.6);
        cushion(m, p, {side * 0.38, 0.3, 0.52}, {0.7, 0.45, 0.14});
    }
    // Slats, the headboard and the mattress.
    for (int i = 0; i < 18; ++i) m.block(p, {0, 0.1 + 0.11 * i, 0.28}, {width, 0.07, 0.012});
    board(m, p, {0, 0.03, 0.4}, {width, 0.03, 0.6});
    cushion(m, p, {0, length / 2 + 0.02, 0.295}, {width - 0.02, length - 0.06, 0.22});
    // A blanket over the foot, in folds along the bed.
    std::vector<Vec2d> folds = {{-0.84, 0}};
    for (int i = 0; i < 40; ++i) folds.push_back({-0.82 + 0.042 * i, i % 2 ? 0.012 : 0.03});
    folds.push_back({0.84, 0});
    std::vector<Vec2d> across;  // the outline across y is in (z, x)
    for (const Vec2d& f : m.curve(folds)) across.push_back({f[1], f[0]});
    m.loft(p, {0, 0.95, 0.505}, Axis::y, {across, false}, {{1, 0}, {1, 0.3}, {1, 0.7}, {1, 1.05}});
}

void cupboard(Model& m, const Pose& p, const Vec3d& size, int doors) {
    const double plinth = 0.08, leaf = 0.02, gap = 0.002;
    const double width = size[0] / doors, height = size[2] - plinth;
    // The body and the plinth.
    m.box(p, {-size[0] / 2, 0, plinth}, {size[0] / 2, size[1] - leaf - gap, size[2]});
    m.box(p, {-size[0] / 2 + 0.02, 0, 0}, {size[0] / 2 - 0.02, size[1] - 0.07, plinth});
    for (int i = 0; i < doors; ++i) {
        const double x = (i - (doors - 1) / 2.0) * width;
        // A bevelled panel. The outline across y is in (z, x).
        const double a = (height - gap) / 2, b = (width - gap) / 2;
        const Vec3d middle(x, size[1] - leaf, plinth + height / 2);
        m.loft(p, middle, Axis::y, rectangle(a, b),
               {{0, 0},
                {1, 0},
                {1, leaf - 0.001},
                {0.995, leaf},
                {0.8, leaf},
                {0.78, leaf - 0.006},
                {0.72, leaf - 0.006},
                {0.66, leaf - 0.001},
                {0, leaf - 0.001}});
        // A handle, left and right by turns.
        const double side = i % 2 ? -1 : 1;
        m.loft(p, middle + Vec3d(side * (b - 0.03), leaf, 0), Axis::y, m.disc(0.012),
               m.curve({{0.5, 0}, {0.4, 0.01}, {1, 0.015}, {1.1, 0.025}, {0, 0.03}}));
    }
}

}  // namespace hedgerow::detail
