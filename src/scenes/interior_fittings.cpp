/// Doors, windows, mouldings, boards and tiles.
#include <algorithm>

#include "interior_things.h"

namespace hedgerow::detail {
namespace {

/// A moulding whose profile in (y, z) runs along x.
void moulding(Model& m, const Pose& p, const std::vector<Vec2d>& profile, double length) {
    m.loft(p, {}, Axis::x, {profile, false}, {{1, 0}, {1, length}});
}

}  // namespace

void casing(Model& m, const Pose& p, const Vec2d& size) {
    const double width = 0.08;
    const std::vector<Vec2d> profile = m.curve({{0, 0},
                                                {0, 0.012},
                                                {0, 0.012},
                                                {0.02, 0.02},
                                                {0.04, 0.012},
                                                {0.06, 0.02},
                                                {width, 0.02},
                                                {width, 0.02},
                                                {width, 0}});
    // Place the profile at the left, the right and the upper side of the opening.
    Outline left{{}, false}, right{{}, false}, above{{}, false};
    for (const Vec2d& q : profile) {
        left.points.push_back({-q[0], q[1]});
        right.points.insert(right.points.begin(), q);
        above.points.push_back({q[1], q[0]});
    }
    m.loft(p, {0, 0, 0}, Axis::z, left, {{1, 0}, {1, size[1] + width}});
    m.loft(p, {size[0], 0, 0}, Axis::z, right, {{1, 0}, {1, size[1] + width}});
    m.loft(p, {0, 0, size[1]}, Axis::x, above, {{1, 0}, {1, size[0]}});
}

void door(Model& m, const Pose& p, const Vec2d& size, const Vec2d& ajar) {
    const Pose leaf = p({0.005, -0.03, 0.004}, ajar);
    const double width = size[0] - 0.01, height = size[1] - 0.006, thick = 0.04;
    // The leaf, and two panels on each of its faces.
    m.box(leaf, {0, -thick, 0}, {width, 0, height});
    const double low[] = {0.15, 1.05}, high[] = {0.95, height - 0.12};
    for (int row = 0; row < 2; ++row)
        for (const double side : {0.0, -thick}) {
            // The frame of a raised panel. The outline across y is in (z, x), and on the back it is turned
            // over.
            const double a = (high[row] - low[row]) / 2, b = width / 2 - 0.1, out = side == 0 ? 1 : -1;
            m.loft(leaf, {width / 2, side, (low[row] + high[row]) / 2}, Axis::y, rectangle(a, b * out),
                   {{1, 0}, {0.98, 0.009 * out}, {0.96, 0.009 * out}, {0.94, 0.003 * out}, {0, 0.003 * out}});
        }
    // A knob on each face.
    for (const double out : {1.0, -1.0}) {
        const Pose side = leaf({width - 0.06, out > 0 ? 0 : -thick, 1.02}, out > 0 ? east : west);
        m.loft(side, {}, Axis::y, m.disc(0.025),
               m.curve({{0, 0.002},
                        {1, 0.002},
                        {1, 0.006},
                        {0.3, 0.008},
                        {0.3, 0.04},
                        {1.1, 0.045},
                        {1.1, 0.06},
                        {0, 0.066}}));
    }
}

void window(Model& m, const Pose& p, const Vec2d& size) {
    const double frame = 0.06, bar = 0.015;
    m.box(p, {0, -0.03, 0}, {size[0], 0.03, frame});
    m.box(p, {0, -0.03, size[1] - frame}, {size[0], 0.03, size[1]});
    m.box(p, {0, -0.03, frame}, {frame, 0.03, size[1] - frame});
    m.box(p, {size[0] - frame, -0.03, frame}, {size[0], 0.03, size[1] - frame});
    for (int i = 1; i < 4; ++i)
        m.bar(p, {size[0] * i / 4, 0, frame}, Axis::z, rectangle(bar / 2, bar / 2), size[1] - 2 * frame);
    for (int i = 1; i < 4; ++i)
        m.bar(p, {frame, 0, size[1] * i / 4}, Axis::x, rectangle(bar / 2, bar / 2), size[0] - 2 * frame);
    m.loft(p, {-0.06, 0.18, -0.015}, Axis::x, m.rounded(0.14, 0.015, 0.01),
           {{0, 0}, {1, 0}, {1, size[0] + 0.12}, {0, size[0] + 0.12}});
}

void curtain(Model& m, const Pose& p, double width, double height) {
    // Folds as deep as a hand, wider towards the floor.
    const int folds = 9;
    const double fold = width / folds;
    std::vector<Vec2d> wave = {{0, 0}};
    for (int i = 0; i < folds; ++i)
        wave.insert(wave.end(), {{(i + 0.25) * fold, 0.07}, {(i + 0.75) * fold, -0.05}});
    wave.push_back({width, 0});
    m.loft(p, {}, Axis::z, {m.curve(wave), false},
           {{1, 0.02}, {0.99, 0.3 * height}, {0.94, 0.6 * height}, {0.9, 0.85 * height}, {0.88, height}});
    for (int i = 0; i < folds; ++i) {  // rings of 2 mm on the rod
        const Vec3d middle((i + 0.5) * fold * 0.88, 0, height + 0.02);
        m.loft(p, middle, Axis::x, m.disc(0.02),
               {{1, -0.001}, {1, 0.001}, {0.9, 0.001}, {0.9, -0.001}, {1, -0.001}});
    }
    m.bar(p, {-0.1, 0, height + 0.025}, Axis::x, m.disc(0.012), width + 0.1);
}

void blind(Model& m, const Pose& p, const Vec2d& size) {
    const double spacing = 0.022;
    const int slats = static_cast<int>(size[1] / spacing);
    const std::vector<Vec2d> slat = m.curve({{0.011, -0.007}, {0.001, 0.004}, {-0.011, 0.007}});
    for (int i = 0; i < slats; ++i)
        m.loft(p, {0.01, 0, spacing * (i + 0.5)}, Axis::x, {slat, false}, {{1, 0}, {1, size[0] - 0.02}});
    for (int i = 1; i < 4; ++i)  // cords
        m.bar(p, {size[0] * i / 4, 0, 0}, Axis::z, rectangle(0.0005, 0.0005), size[1]);
    m.box(p, {0, -0.02, size[1]}, {size[0], 0.02, size[1] + 0.03});
}

void radiator(Model& m, const Pose& p, double width) {
    const int columns = static_cast<int>(width / 0.05);
    for (int i = 0; i < columns; ++i)
        for (const double y : {0.05, 0.11})
            m.loft(p, {0.05 * (i + 0.5) - width / 2, y, 0.1}, Axis::z, m.disc(0.016),
                   m.curve({{0, 0}, {0.8, 0}, {1, 0.03}, {1, 0.57}, {0.8, 0.6}, {0, 0.6}}));
    for (const double z : {0.15, 0.65}) m.bar(p, {-width / 2, 0.08, z}, Axis::x, m.disc(0.025), width);
    m.bar(p, {-width / 2 + 0.02, 0.08, 0}, Axis::z, m.disc(0.008), 0.15);
}

void skirting(Model& m, const Pose& p, double length) {
    moulding(m, p,
             m.curve({{0.016, 0},
                      {0.016, 0.08},
                      {0.016, 0.08},
                      {0.014, 0.085},
                      {0.006, 0.088},
                      {0.01, 0.1},
                      {0.008, 0.11},
                      {0, 0.11}}),
             length);
}
void cornice(Model& m, const Pose& p, double length, double height) {
    const double h = height;
    moulding(m, p,
             m.curve({{0, h - 0.14},
                      {0.012, h - 0.14},
                      {0.012, h - 0.12},
                      {0.012, h - 0.12},
                      {0.03, h - 0.11},
                      {0.03, h - 0.06},
                      {0.09, h - 0.035},
                      {0.11, h - 0.03},
                      {0.11, h - 0.012},
                      {0.11, h - 0.012},
                      {0.14, h - 0.01},
                      {0.14, h}}),
             length);
}

void floorboards(Model& m, const Pose& p, const Vec2d& size, Random random) {
    const double pitch = 0.09, gap = 0.002, top = 0.012;
    const int rows = static_cast<int>(size[1] / pitch);
    for (int i = 0; i < rows; ++i) {
        const double middle = (i + 0.5) * pitch, half = (pitch - gap) / 2;
        const Outline across = {{{half, 0},
                                 {half, top - 0.001},
                                 {half - 0.001, top},
                                 {0.001 - half, top},
                                 {-half, top - 0.001},
                                 {-half, 0}},
                                false};
        for (double x = 0; x < size[0] - 0.01;) {
            const double end = std::min(size[0], x + random.uniform(0.8, 2.4));
            const bool last = size[0] - end < 0.3;
            m.loft(p, {x, middle, 0}, Axis::x, across, {{1, 0}, {1, (last ? size[0] : end) - x - gap}});
            x = last ? size[0] : end;
        }
    }
}

void tiles(Model& m, const Pose& p, int columns, int rows) {
    const double pitch = 0.1, half = (pitch - 0.003) / 2;
    for (int i = 0; i < columns; ++i)
        for (int k = 0; k < rows; ++k)
            m.loft(p, {(i + 0.5) * pitch, 0, (k + 0.5) * pitch}, Axis::y, rectangle(half, half),
                   {{1, 0}, {1, 0.005}, {0.97, 0.007}, {0, 0.007}});
}

}  // namespace hedgerow::detail
