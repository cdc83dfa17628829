#include "interior_flat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <hedgerow/geometry/box.h>

namespace hedgerow::detail {
namespace {

// Rooms are 2.8 m high; inner walls are 12 cm thick and outer walls 36 cm.
constexpr double length = 12.4, width = 8.6, height = 2.8, inner = 0.12, outer = 0.36, slab = 0.3;
constexpr double west_wall = 4.9, east_wall = 8.3, cross_wall = 4.7;  // the middles of inner walls
constexpr double boards = 0.012;                                      // thickness, below z = 0

/// A door or a window: its ends in the plan, on the middle of its wall, and its heights.
struct Hole {
    Vec2d from, to;
    double bottom, top;
    bool has_leaf;

    bool is_door() const { return bottom == 0; }
};
constexpr double door_height = 2.05, south_wall = -outer / 2, north_wall = width + outer / 2;
constexpr Hole holes[] = {
    {{west_wall, 1.2}, {west_wall, 3.0}, 0, 2.3, false},  // from the living room to the dining room
    {{east_wall, 0.5}, {east_wall, 1.4}, 0, door_height, true},
    {{6.1, cross_wall}, {7.0, cross_wall}, 0, door_height, true},
    {{3.6, cross_wall}, {4.5, cross_wall}, 0, door_height, true},
    {{west_wall, 5.6}, {west_wall, 6.5}, 0, door_height, true},
    {{east_wall, 5.4}, {east_wall, 6.3}, 0, door_height, true},
    {{6.1, north_wall}, {7.1, north_wall}, 0, door_height, true},
    {{0.5, south_wall}, {1.9, south_wall}, 0.85, 2.35, false},
    {{2.9, south_wall}, {4.3, south_wall}, 0.85, 2.35, false},
    {{5.8, south_wall}, {7.4, south_wall}, 0.85, 2.35, false},
    {{9.2, south_wall}, {11.0, south_wall}, 1.1, 2.2, false},
    {{south_wall, 1.5}, {south_wall, 3.1}, 0.85, 2.35, false},
    {{south_wall, 5.8}, {south_wall, 7.4}, 0.85, 2.35, false},
    {{length + outer / 2, 2.0}, {length + outer / 2, 3.4}, 1.1, 2.2, false},
    {{length + outer / 2, 5.8}, {length + outer / 2, 7.6}, 0.85, 2.35, false},
    {{1.2, north_wall}, {3.2, north_wall}, 0.85, 2.35, false},
    {{9.6, north_wall}, {11.2, north_wall}, 0.85, 2.35, false},
};

/// A hole as an opening in the wall that begins at `wall`. Nothing if the hole is further than `reach` from
/// the wall's line, or beyond an end of the wall.
std::optional<Opening> seen_from(const Pose& wall, double wall_length, double reach, const Hole& hole) {
    double x[2], across = 0;
    for (int i = 0; i < 2; ++i) {
        const Vec2d d = (i == 0 ? hole.from : hole.to) - Vec2d(wall.at[0], wall.at[1]);
        x[i] = wall.along[0] * d[0] + wall.along[1] * d[1];  // along is an axis
        across = std::max(across, std::fabs(wall.along[0] * d[1] - wall.along[1] * d[0]));
    }
    const auto [low, high] = std::minmax(x[0], x[1]);
    if (across > reach || low < 0 || high > wall_length) return std::nullopt;
    return Opening{{low, hole.bottom}, {high, hole.top}};
}

/// A wall of a room as seen from inside: its left end, and how long it is. The room is where y > 0.
struct Side {
    Pose pose;
    double length;
};
struct Room {
    Vec2d low, high;

    std::array<Side, 4> sides() const {
        const Vec2d size = high - low;
        return {Side{{{low[0], low[1], 0}, east}, size[0]}, Side{{{high[0], low[1], 0}, north}, size[1]},
                Side{{{high[0], high[1], 0}, west}, size[0]}, Side{{{low[0], high[1], 0}, south}, size[1]}};
    }
};
constexpr double half = inner / 2;
constexpr Room living{{0, 0}, {west_wall - half, cross_wall - half}},
    dining{{west_wall + half, 0}, {east_wall - half, cross_wall - half}},
    kitchen{{east_wall + half, 0}, {length, cross_wall - half}},
    study{{0, cross_wall + half}, {west_wall - half, width}},
    hall{{west_wall + half, cross_wall + half}, {east_wall - half, width}},
    bedroom{{east_wall + half, cross_wall + half}, {length, width}};
constexpr std::array rooms = {living, dining, kitchen, study, hall, bedroom};

class Furnishing {
public:
    std::vector<Thing> things;

    /// Adds a thing that calls f(model) or f(model, random).
    template <class F>
    void add(F f) {
        if constexpr (std::is_invocable_v<F, Model&, Random>)
            things.emplace_back(std::move(f));
        else
            things.emplace_back([f](Model& m, Random) { f(m); });
    }

    void shell();
    void openings();
    void furniture();
    void mouldings();
    void small_things();
    void library();
    void dressings();

private:
    void wall(const Pose& p, double wall_length, double thickness, bool with_ends);
    void dining_table();
    void shelves(const Pose& p, double shelf_width, int count);

    std::vector<std::pair<Pose, std::pair<double, int>>> bookcases_;
};

void Furnishing::wall(const Pose& p, double wall_length, double thickness, bool with_ends) {
    std::vector<Opening> all;
    for (const Hole& h : holes)
        if (auto o = seen_from(p, wall_length, 0.01, h)) {
            o->low[1] += boards, o->high[1] += boards;
            all.push_back(*o);
        }
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.low[0] < b.low[0]; });
    add([=](Model& m) { m.wall(p, wall_length, height + boards, thickness, all, with_ends); });
}
void Furnishing::shell() {
    for (const double bottom : {-boards - slab, height})
        add([=](Model& m) {
            m.box({}, {-outer, -outer, bottom}, {length + outer, width + outer, bottom + slab});
        });
    for (const double y : {south_wall, north_wall})
        wall({{-outer, y, -boards}, east}, length + 2 * outer, outer, true);
    for (const double x : {south_wall, length + outer / 2})
        wall({{x, 0, -boards}, north}, width, outer, false);
    wall({{0, cross_wall, -boards}, east}, length, inner, false);
    for (const double x : {west_wall, east_wall})
        for (const Room& r : {living, study})
            wall({{x, r.low[1], -boards}, north}, r.high[1] - r.low[1], inner, false);
}

void Furnishing::openings() {
    for (const Hole& h : holes) {
        // A leaf is hung once, in the first room that the door leads to.
        bool hung = false;
        for (const Room& r : rooms)
            for (const Side& s : r.sides()) {
                const auto o = seen_from(s.pose, s.length, 0.25, h);
                if (!o) continue;
                const Vec2d size = o->high - o->low;
                if (!h.is_door())
                    add([=](Model& m) { window(m, s.pose({o->low[0], -0.15, h.bottom}, east), size); });
                if (h.has_leaf && !std::exchange(hung, true))
                    add([=](Model& m, Random random) {
                        const Vec2d ajar = normalized(Vec2d(random.uniform(), 1));
                        door(m, s.pose({o->low[0], 0, 0}, east), size, ajar);
                    });
            }
    }
}

void Furnishing::shelves(const Pose& p, double shelf_width, int count) {
    bookcases_.push_back({p, {shelf_width, count}});
    add([=](Model& m) { bookcase(m, p, shelf_width, count); });
}
void Furnishing::dining_table() {
    const Pose t{{6.6, 2.3, 0}, north};
    add([=](Model& m) { table(m, t, {2.2, 0.95, 0.74}); });
    for (const double side : {-1.0, 1.0})
        for (int i = -1; i <= 1; ++i) {
            // Pushed back a little, and none quite straight.
            const double turn = (i * 5 + (side > 0 ? 3 : -2)) * 0.02;
            const Vec2d facing = Vec2d(-side, turn) / std::sqrt(1 + product(turn, turn));
            add([=](Model& m) { chair(m, t({0.62 * i, side * (0.55 + 0.04 * std::abs(i)), 0}, facing)); });
        }
    add([=](Model& m) { chair(m, t({1.35, 0, 0}, north)); });
    add([=](Model& m) { chair(m, t({-1.4, 0, 0}, south)); });
}
void Furnishing::furniture() {
    // Sofas, the dining table with its chairs, the bed, and the tables of the living room and the study.
    add([](Model& m) { sofa(m, {{0.35, 2.3, 0}, south}, 2.2); });
    add([](Model& m) { sofa(m, {{1.75, 4.5, 0}, west}, 1.6); });
    dining_table();
    add([](Model& m) { bed(m, {{10.6, 4.78, 0}, east}); });
    add([](Model& m) { table(m, {{1.95, 2.35, 0.008}, north}, {1.1, 0.6, 0.4}); });
    add([](Model& m) { table(m, {{2.2, 8.05, 0}, east}, {1.7, 0.75, 0.74}); });
    add([](Model& m) { chair(m, {{2.3, 7.35, 0}, {0.96, 0.28}}); });
    // Cupboards of the kitchen, the bedroom, the dining room and the hall, and the kitchen's worktops.
    add([](Model& m) { cupboard(m, {{10.4, kitchen.high[1], 0}, west}, {3.6, 0.6, 0.9}, 6); });
    add([](Model& m) { cupboard(m, {{length, 2.7, 0}, north}, {2.4, 0.6, 0.9}, 4); });
    add([](Model& m) { cupboard(m, {{10.4, kitchen.high[1], 1.45}, west}, {3.6, 0.35, 0.75}, 6); });
    add([](Model& m) { cupboard(m, {{8.36, 7.6, 0}, south}, {1.9, 0.6, 2.3}, 4); });
    add([](Model& m) { cupboard(m, {{8.24, 3.2, 0}, north}, {1.7, 0.45, 0.85}, 4); });
    add([](Model& m) { cupboard(m, {{4.96, 7.6, 0}, south}, {1.5, 0.5, 2.2}, 3); });
    add([](Model& m) { m.block({{10.4, 4.33, 0.9}}, {}, {3.62, 0.62, 0.03}); });  // worktops
    add([](Model& m) { m.block({{12.09, 2.7, 0.9}}, {}, {0.62, 2.42, 0.03}); });
    // The kitchen's table and its chairs.
    add([](Model& m) { table(m, {{9.9, 1.5, 0}, east}, {0.9, 0.8, 0.74}); });
    add([](Model& m) { chair(m, {{9.9, 0.95, 0}, {0.96, -0.28}}); });
    add([](Model& m) { chair(m, {{10.55, 1.55, 0}, {0.28, 0.96}}); });
    // Bookcases, bedside cupboards and lamps.
    shelves({{4.84, 3.85, 0}, north}, 1.3, 6);
    shelves({{2.4, 0, 0}, east}, 0.8, 6);
    for (const double x : {0.7, 1.9, 3.0}) shelves({{x, study.low[1], 0}, east}, 1.1, 7);
    shelves({{4.84, 7.6, 0}, north}, 1.6, 5);
    for (const double x : {9.5, 11.7})
        add([=](Model& m) { cupboard(m, {{x, 4.76, 0}, east}, {0.45, 0.4, 0.5}, 1); });
    for (const Room& r : rooms)
        add([=](Model& m) {
            const Vec2d middle = (r.low + r.high) / 2.0;
            pendant_lamp(m, {{middle[0], middle[1], height}}, 0.75);
        });
    for (const auto& [x, y] : {std::pair(0.45, 0.75), {4.4, 0.5}, {11.9, 8.1}})
        add([x = x, y = y](Model& m) { standing_lamp(m, {{x, y, 0}}); });
}

void Furnishing::mouldings() {
    for (const Room& r : rooms)
        for (const Side& s : r.sides()) {
            add([=](Model& m) { cornice(m, s.pose, s.length, height); });
            double from = 0;
            std::vector<Opening> doors;
            for (const Hole& h : holes)
                if (const auto o = seen_from(s.pose, s.length, 0.25, h); o && h.is_door()) {
                    add([=](Model& m) { casing(m, s.pose({o->low[0], 0, 0}, east), o->high - o->low); });
                    doors.push_back(*o);
                }
            std::sort(doors.begin(), doors.end(),
                      [](const auto& a, const auto& b) { return a.low[0] < b.low[0]; });
            const auto run = [&](double to) {
                if (to > from) add([=](Model& m) { skirting(m, s.pose({from, 0, 0}, east), to - from); });
            };
            for (const Opening& d : doors) run(d.low[0] - 0.08), from = d.high[0] + 0.08;
            run(s.length);
        }
}

void Furnishing::small_things() {
    add([](Model& m) { rug(m, {{1.95, 2.3, 0}}, {2.6, 2.2}); });
    add([](Model& m) { rug(m, {{6.6, 6.7, 0}, north}, {2.4, 1.2}); });
    add([](Model& m, Random r) { fruit_bowl(m, {{1.95, 2.5, 0.408}}, r); });
    add([](Model& m, Random r) { fruit_bowl(m, {{6.6, 2.3, 0.74}}, r); });
    for (const double side : {-1.0, 1.0})
        for (int i = -1; i <= 1; ++i)
            add([=](Model& m) {
                table_setting(m, {{6.6 + side * 0.3, 2.3 + 0.62 * i, 0.74}, side > 0 ? north : south});
            });
    add([](Model& m) { vase(m, {{8.0, 3.6, 0.85}}, 0.4); });
    add([](Model& m) { vase(m, {{8.05, 2.8, 0.85}}, 0.25); });
    for (int i = 0; i < 5; ++i)
        add([=](Model& m) { pot(m, {{9.0 + 0.45 * i, 4.3, 0.93}, {0.8, 0.6}}, 0.08 + 0.012 * i); });
    for (int i = 0; i < 6; ++i)
        add([=](Model& m) { cup(m, {{12.0 + 0.01 * i, 1.8 + 0.14 * i, 0.93}, {0.6, 0.8}}); });
    add([](Model& m) { cup(m, {{1.75, 2.05, 0.408}, {0.28, 0.96}}); });
    add([](Model& m) { cup(m, {{2.7, 7.9, 0.74}, {-0.6, 0.8}}); });
    add([](Model& m, Random r) { pens(m, {{1.6, 8.2, 0.74}}, r); });
    add([](Model& m) { picture(m, {{2.4, 4.64, 1.6}, west}, {1.2, 0.8}); });
    add([](Model& m) { picture(m, {{8.24, 3.2, 1.6}, north}, {0.9, 1.1}); });
    add([](Model& m) { picture(m, {{10.6, 4.76, 1.7}, east}, {1.4, 0.6}); });
    for (int i = 0; i < 3; ++i)
        add([=](Model& m) { picture(m, {{4.96, 6.9 - 0.02 * i, 1.2 + 0.5 * i}, south}, {0.3, 0.4}); });
    add([](Model& m) { tiles(m, {{12.2, kitchen.high[1], 0.94}, west}, 36, 5); });
}
void Furnishing::library() {
    for (const auto& [p, size] : bookcases_)
        for (int i = 0; i < size.second; ++i)
            add([p = p, w = size.first, i](Model& m, Random r) {
                books(m, p({0.03 - w / 2, 0, 0.078 + 0.32 * i}, east), w - 0.06, r);
            });
    add([](Model& m, Random r) { books(m, {{1.5, 8.3, 0.74}, {0.96, 0.28}}, 0.3, r); });
}

void Furnishing::dressings() {
    for (const Room& r : rooms)
        for (const Side& s : r.sides())
            for (const Hole& h : holes) {
                const auto o = seen_from(s.pose, s.length, 0.25, h);
                if (!o || h.is_door()) continue;
                const double from = o->low[0], to = o->high[0];
                const Vec2d size(to - from, h.top - h.bottom);
                add([=](Model& m) { radiator(m, s.pose({(from + to) / 2, 0, 0}, east), size[0] - 0.2); });
                if (h.bottom > 1 || r.low == study.low)
                    add([=](Model& m) { blind(m, s.pose({from, -0.06, h.bottom}, east), size); });
                else
                    for (const double x : {from - 0.3, to - 0.05})
                        add([=](Model& m) { curtain(m, s.pose({x, 0.2, 0.03}, east), 0.4, 2.45); });
            }
    for (const auto& [x, y] : {std::pair(4.3, 1.0), {7.7, 0.5}, {0.5, 8.1}, {5.4, 5.1}})
        add([x = x, y = y](Model& m, Random r) { plant(m, {{x, y, 0}}, 90, r); });
    for (const Room& r : rooms)
        add([=](Model& m, Random random) {
            floorboards(m, {{r.low[0], r.low[1], -boards}}, r.high - r.low, random);
        });
}

}  // namespace

std::vector<Thing> flat() {
    Furnishing f;
    f.shell();
    f.openings();
    f.furniture();
    f.mouldings();
    f.small_things();
    f.library();
    f.dressings();
    return std::move(f.things);
}

}  // namespace hedgerow::detail
