/// Draws scenes and queries of nasty numbers.
#pragma once

#include <algorithm>
#include <numbers>
#include <tuple>

#include "../nasty.h"
#include "regions.h"
#include "shapes.h"

namespace hedgerow::hunter {

/// Draws the points of a round. In half of the rounds each axis has its own kind of numbers.
template <class T, int D>
class Places {
public:
    explicit Places(Random& random) : random_(random) {
        const bool alike = random.bits() % 2 == 0;
        auto first = nasty::Numbers<T>::any(random);
        for (int k = 0; k < D; ++k) along_.push_back(alike ? first : nasty::Numbers<T>::any(random));
        scale_ = random.bits() % 4 == 0 ? std::ldexp(T(1), static_cast<int>(random.bits() % 61) - 30) : T(1);
        shift_ = random.bits() % 4 == 0 ? first() : T(0);
    }
    Vec<T, D> operator()() {
        Vec<T, D> v;
        for (int k = 0; k < D; ++k) v[k] = in_range(along_[static_cast<std::size_t>(k)]() * scale_ + shift_);
        return v;
    }
    Random& random() { return random_; }

private:
    static T in_range(T x) { return std::clamp(x, -largest_coordinate<T> / 8, largest_coordinate<T> / 8); }

    Random& random_;
    std::vector<nasty::Numbers<T>> along_;
    T scale_, shift_;
};

template <class T, int D>
Vec<T, D> shape_at(Places<T, D>& places, const Vec<T, D>&) {
    return places();
}
/// Draws a second point for a shape with a point p. A third of these are close to p, so some shapes are small
/// or have no area or length.
template <class T, int D>
Vec<T, D> beside(Places<T, D>& places, const Vec<T, D>& p) {
    const Vec<T, D> q = places();
    switch (places.random().bits() % 6) {
        case 0:
            return p + (q - p) * T(0x1p-10);
        case 1:
            return p + (q - p) * unit_roundoff<T> * T(8);
        default:
            return q;
    }
}
template <class T>
Triangle<T, 3> shape_at(Places<T, 3>& places, const Triangle<T, 3>&) {
    Triangle<T, 3> t;
    t.a = places(), t.b = beside(places, t.a), t.c = beside(places, t.b);
    if (places.random().bits() % 16 == 0) t.c = t.a;
    if (places.random().bits() % 16 == 0) t.c = (t.a + t.b) * T(0.5);
    return t;
}
template <class T>
Segment<T, 2> shape_at(Places<T, 2>& places, const Segment<T, 2>&) {
    Segment<T, 2> s;
    s.a = places(), s.b = beside(places, s.a);
    return s;
}
template <class T>
Sphere<T, 3> shape_at(Places<T, 3>& places, const Sphere<T, 3>&) {
    const Vec<T, 3> center = places(), other = beside(places, center);
    return {center, places.random().bits() % 16 == 0 ? T(0) : max_component(abs(other - center))};
}

/// Rotates pairs of a shape's numbers by an angle and back, as CAD programs turn scenes. Flat shapes stay
/// flat except for the last digits.
template <class T, class Shape>
void turn_and_turn_back(std::vector<Shape>& shapes, double angle) {
    const T c = static_cast<T>(std::cos(angle)), s = static_cast<T>(std::sin(angle));
    for (auto& shape : shapes) {
        T* before = nullptr;
        for_each_number(shape, [&](T& x) {
            if (before == nullptr) return void(before = &x);
            for (const T sine : {s, -s}) {
                const T turned = product(c, *before) - product(sine, x);
                x = product(sine, *before) + product(c, x), *before = turned;
            }
            before = nullptr;
        });
    }
}

/// A scene of 1 to 64 shapes, now and then of up to 1024. Shapes are drawn one by one, share a corner, are
/// repeated, lie in a wall, or are turned and turned back.
template <class Shape, class T, int D>
std::vector<Shape> scene(Places<T, D>& places) {
    Random& random = places.random();
    std::vector<Shape> shapes;
    const auto digits = random.bits() % 7 + (random.bits() % 32 == 0 ? 4 : 0);
    const std::size_t count = 1 + random.bits() % (std::size_t(1) << digits);
    const std::uint64_t kind = random.bits() % 6;
    const Vec<T, D> corner = places();
    const int flat = static_cast<int>(random.bits() % D);
    const T wall = places()[flat];
    while (shapes.size() < count) {
        Shape shape = shape_at(places, Shape());
        int number = 0;
        // Share a corner: the first one of the shape.
        if (kind == 1)
            for_each_number(shape, [&](T& x) { number < D ? void(x = corner[number]) : void(), ++number; });
        // Lie in a wall, up to the last digits. A sphere's radius is no coordinate.
        if (kind == 2)
            for_each_number(shape, [&](T& x) {
                if (number < 3 * D && number % D == flat &&
                    !(D == 3 && number == 3 && sizeof(Shape) == 4 * sizeof(T)))
                    x = nasty::nudged(wall, static_cast<int>(random.bits() % 4));
                ++number;
            });
        shapes.push_back(shape);
        // Repeat an earlier shape.
        if (kind == 3 && random.bits() % 2 == 0) shapes.push_back(shapes[random.bits() % shapes.size()]);
    }
    // Turn all shapes and turn them back.
    if constexpr (sizeof(Shape) % (D * sizeof(T)) == 0)
        if (kind == 4) turn_and_turn_back<T>(shapes, random.uniform(0, 2 * std::numbers::pi));
    return shapes;
}

/// What is given to questions.
template <class T, int D>
struct AllGiven {
    std::vector<Ray<T, D>> rays;
    std::vector<HitsAlong<T, D>> hits_along;
    std::vector<Vec<T, D>> points;
    std::vector<Box<T, D>> boxes;
    std::vector<Neighbours<T, D>> neighbours;
    std::vector<Ball<T, D>> balls;
    std::vector<Sphere<T, D>> solid_balls;
    std::vector<RegionThrough<T, D>> regions;

    template <class Given>
    const std::vector<Given>& given() const {
        return std::get<const std::vector<Given>&>(
            std::tie(rays, hits_along, points, boxes, neighbours, balls, solid_balls, regions));
    }
};

/// The points that define the shapes.
template <class Shape, class T, int D>
std::vector<Vec<T, D>> corners_of(std::vector<Shape> shapes, const Vec<T, D>&) {
    std::vector<Vec<T, D>> corners;
    for (auto& shape : shapes) {
        Vec<T, D> v;
        int k = 0;
        for_each_number(shape, [&](T& x) {
            v[k++] = x;
            if (k == D) corners.push_back(v), k = 0;
        });
    }
    return corners;
}

/// Draws rays, points and boxes at, near and away from the corners of a scene.
template <class T, int D>
class Asking {
public:
    Asking(Places<T, D>& places, std::vector<Vec<T, D>> corners)
        : places_(places), random_(places.random()), corners_(std::move(corners)) {}

    AllGiven<T, D> questions(std::size_t rays, std::size_t others) {
        AllGiven<T, D> all;
        const bool picture = below(8) == 0;
        const Vec<T, D> eye = place(), target = place(), across = place() - eye;
        // In one round of eight the rays are those of a picture, 16 to a row.
        for (std::size_t i = 0; i < rays; ++i) {
            all.rays.push_back(ray());
            if (!picture) continue;
            Vec<T, D> d = target - eye;
            d[0] += across[0] * T(i % 16) / 64, d[1] += across[1] * T(i / 16) / 64;
            all.rays.back() = {eye, d};
        }
        for (const auto& r : all.rays) all.hits_along.push_back(hits_along(r));
        // Boxes may be flat or a single point.
        for (std::size_t i = 0; i < others; ++i) {
            all.points.push_back(place());
            Box<T, D> box = Box<T, D>().expand(place()).expand(place());
            if (below(4) == 0) box.high[0] = box.low[0];
            if (below(8) == 0) box.low = box.high;
            all.boxes.push_back(box);
            all.neighbours.push_back(neighbours());
            const T reach = distance();
            all.balls.push_back({place(), reach * reach});
            all.solid_balls.push_back({place(), below(16) == 0 ? special() : distance()});
            all.regions.push_back(region());
        }
        return all;
    }

private:
    /// A distance from a place to a corner along one axis or in all, and now and then none.
    T distance() {
        const Vec<T, D> away = place() - corner();
        if (below(16) == 0) return T(0);
        return below(2) == 0 ? std::abs(away[0]) : length(away);
    }
    Neighbours<T, D> neighbours() {
        constexpr std::size_t counts[] = {1, 1, 2, 4, 9, 33, 1000, 0};
        constexpr T factors[] = {T(1), T(1), T(1), T(1.5), T(10)};
        Neighbours<T, D> n{place(), counts[below(std::size(counts))]};
        if (below(2) == 0) n.options.radius = distance();
        n.options.factor = factors[below(std::size(factors))];
        return n;
    }
    /// The next hits after the start of a ray, or after a place on it: that of a corner or a special one.
    HitsAlong<T, D> hits_along(const Ray<T, D>& r) {
        constexpr std::size_t counts[] = {1, 1, 2, 4, 9, 1000, 0};
        HitsAlong<T, D> along{r, counts[below(std::size(counts))]};
        if (below(2) == 0) return along;
        along.after.t = below(8) == 0 ? special() : T(below(3)) / 2;
        if (below(2) == 0) along.after.t = (corner() - r.origin)[0] / r.direction[0];
        along.after.element = static_cast<std::uint32_t>(below(below(2) == 0 ? 4 : 64));
        return along;
    }
    RegionThrough<T, D> region() {
        constexpr T sizes[] = {T(0), T(0x1p-10), T(0.5), T(1), T(8)};
        return {static_cast<RegionKind>(below(region_kinds)), place(), place(), place(),
                sizes[below(std::size(sizes))]};
    }
    std::uint64_t below(std::uint64_t n) { return random_.bits() % n; }
    Vec<T, D> corner() { return corners_[below(corners_.size())]; }
    /// A corner, a point next to a corner or between some, a near or far point on a line through two, or a
    /// point anywhere.
    Vec<T, D> place() {
        Vec<T, D> p = corner();
        switch (below(6)) {
            case 0:
                return p;
            case 1:
                for (int k = 0; k < D; ++k) p[k] = nasty::nudged(p[k], static_cast<int>(below(5)) - 2);
                return in_range(p);
            case 2:
                return p * T(0.5) + corner() * T(0.5);
            case 3: {
                const Vec<T, D> q = corner(), r = corner();
                const T w = static_cast<T>(random_.uniform()),
                        u = static_cast<T>(random_.uniform()) * (1 - w);
                return p * (1 - w - u) + q * w + r * u;
            }
            case 4: {
                const T times = below(2) == 0 ? T(1e3) : T(0x1p-12);
                return in_range(p + (corner() - p) * times);
            }
            default:
                return places_();
        }
    }
    static Vec<T, D> in_range(const Vec<T, D>& p) {
        return map(p,
                   [](T x) { return std::clamp(x, -largest_coordinate<T> / 8, largest_coordinate<T> / 8); });
    }
    T special() {
        using limits = std::numeric_limits<T>;
        constexpr T all[] = {T(0),
                             T(-0.0),
                             limits::denorm_min(),
                             limits::min(),
                             -limits::min(),
                             limits::epsilon(),
                             limits::infinity(),
                             limits::quiet_NaN(),
                             largest_coordinate<T>,
                             T(1)};
        return all[below(std::size(all))];
    }
    Ray<T, D> ray() {
        Ray<T, D> r;
        r.origin = place();
        r.direction = place() - r.origin;
        // Change the direction: along an axis, nearly along one, or any.
        const auto axis = static_cast<int>(below(D));
        switch (below(8)) {
            case 0: {  // along an axis
                for (int k = 0; k < D; ++k)
                    if (k != axis) r.direction[k] = T(0);
                break;
            }
            case 1: {  // nearly along an axis
                const T little = std::ldexp(T(1), -static_cast<int>(below(60)));
                for (int k = 0; k < D; ++k)
                    if (k != axis) r.direction[k] *= little;
                break;
            }
            case 2:
                r.direction = places_();
                break;
            default:
                break;
        }
        // Multiply one direction in eight by a power of two.
        constexpr int most = std::is_same_v<T, float> ? 148 : 1073;  // lengths down to subnormal ones
        if (const auto lengths = below(16); lengths < 2) {
            const int reach = lengths == 0 ? 60 : most;
            const T length =
                std::ldexp(T(1), static_cast<int>(below(2 * static_cast<std::uint64_t>(reach) + 1)) - reach);
            r.direction = r.direction * length;
        }
        // Set special numbers, and intervals that begin or end on the way.
        if (below(16) == 0) r.direction[axis] = special();
        if (below(64) == 0) r.origin[axis] = special();
        if (below(4) == 0) r.t_min = below(2) ? T(1) : T(0.5);
        if (below(4) == 0) r.t_max = below(2) ? T(1) : T(2);
        if (below(64) == 0) r.t_max = special();
        if (below(64) == 0) r.t_min = std::abs(special());
        return r;
    }

    Places<T, D>& places_;
    Random& random_;
    std::vector<Vec<T, D>> corners_;
};

}  // namespace hedgerow::hunter
