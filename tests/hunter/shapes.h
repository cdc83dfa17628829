/// The shapes that the hunter makes scenes of, how sets are made of them, and how they are written as code.
#pragma once

#include <cstdio>
#include <ostream>
#include <vector>

#include <hedgerow/questions.h>

namespace hedgerow::hunter {

template <class T>
TriangleMesh<T> set_of(const std::vector<Triangle<T, 3>>& shapes) {
    TriangleMesh<T> mesh;
    for (const auto& t : shapes) {
        const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {t.a, t.b, t.c});
        mesh.triangles.push_back({at, at + 1, at + 2});
    }
    return mesh;
}
template <class T>
SphereSet<T, 3> set_of(const std::vector<Sphere<T, 3>>& shapes) {
    return {shapes};
}
template <class T, int D>
PointCloud<T, D> set_of(const std::vector<Vec<T, D>>& shapes) {
    return {shapes};
}
template <class T>
SegmentSet<T> set_of(const std::vector<Segment<T, 2>>& shapes) {
    return {shapes};
}

/// Calls f(number) for every number that a shape or a question is made of, so that it can be changed.
template <class T, class F>
void for_each_number(T& x, F f) requires std::floating_point<T> {
    f(x);
}
template <class T, int D, class F>
void for_each_number(Vec<T, D>& v, F f) {
    for (int k = 0; k < D; ++k) f(v[k]);
}
template <class T, int D, class F>
void for_each_number(Triangle<T, D>& t, F f) {
    for (auto* v : {&t.a, &t.b, &t.c}) for_each_number(*v, f);
}
template <class T, int D, class F>
void for_each_number(Segment<T, D>& s, F f) {
    for (auto* v : {&s.a, &s.b}) for_each_number(*v, f);
}
template <class T, int D, class F>
void for_each_number(Sphere<T, D>& s, F f) {
    for_each_number(s.center, f);
    f(s.radius);
}
template <class T, int D, class F>
void for_each_number(Box<T, D>& b, F f) {
    for_each_number(b.low, f);
    for_each_number(b.high, f);
}
template <class T, int D, class F>
void for_each_number(Ray<T, D>& r, F f) {
    for_each_number(r.origin, f);
    for_each_number(r.direction, f);
    f(r.t_min), f(r.t_max);
}
template <class T, int D, class F>
void for_each_number(HitsAlong<T, D>& h, F f) {
    for_each_number(h.ray, f);
    f(h.after.t);
}

template <class T, int D, class F>
void for_each_number(Neighbours<T, D>& n, F f) {
    for_each_number(n.point, f);
}
template <class T, int D, class F>
void for_each_number(Ball<T, D>& b, F f) {
    for_each_number(b.center, f);
    f(b.radius2);
}

/// Writes C++ code that gives the same bits.
template <std::floating_point T>
void write(std::ostream& out, T x) {
    if (x != x)
        out << "NAN";
    else if (std::abs(x) == std::numeric_limits<T>::infinity())
        out << (x < 0 ? "-INFINITY" : "INFINITY");
    else if (x == std::nearbyint(x) && std::abs(x) < 1000 && (x != 0 || !std::signbit(x)))
        out << static_cast<int>(x);
    else {
        char text[40];
        std::snprintf(text, sizeof text, std::is_same_v<T, float> ? "%af" : "%a", static_cast<double>(x));
        out << text;
    }
}
template <class T, int D>
void write(std::ostream& out, const Vec<T, D>& v) {
    out << '{';
    for (int k = 0; k < D; ++k) {
        if (k > 0) out << ", ";
        write(out, v[k]);
    }
    out << '}';
}
template <class A, class... More>
void write_list(std::ostream& out, const A& first, const More&... more) {
    out << '{';
    write(out, first);
    ((out << ", ", write(out, more)), ...);
    out << '}';
}
template <class T, int D>
void write(std::ostream& out, const Triangle<T, D>& t) {
    write_list(out, t.a, t.b, t.c);
}
template <class T, int D>
void write(std::ostream& out, const Segment<T, D>& s) {
    write_list(out, s.a, s.b);
}
template <class T, int D>
void write(std::ostream& out, const Sphere<T, D>& s) {
    write_list(out, s.center, s.radius);
}
template <class T, int D>
void write(std::ostream& out, const Box<T, D>& b) {
    write_list(out, b.low, b.high);
}
template <class T, int D>
void write(std::ostream& out, const Ball<T, D>& b) {
    write_list(out, b.center, b.radius2);
}
template <class T, int D>
void write(std::ostream& out, const Neighbours<T, D>& n) {
    out << '{';
    write(out, n.point);
    out << ", " << n.k << ", {.radius = ";
    write(out, n.options.radius), out << ", .factor = ", write(out, n.options.factor);
    out << "}}";
}
template <class T, int D>
void write(std::ostream& out, const Ray<T, D>& r) {
    write_list(out, r.origin, r.direction, r.t_min, r.t_max);
}
template <class T, int D>
void write(std::ostream& out, const HitsAlong<T, D>& h) {
    out << '{';
    write(out, h.ray);
    out << ", " << h.k << ", {";
    write(out, h.after.t);
    out << ", " << h.after.instance << ", " << h.after.element << "}}";
}

template <class T>
constexpr const char* scalar_name = std::is_same_v<T, float> ? "float" : "double";
template <template <class, int> class Shape>
inline constexpr const char* word_for = "RegionThrough";
template <>
inline constexpr const char* word_for<Triangle> = "Triangle";
template <>
inline constexpr const char* word_for<Segment> = "Segment";
template <>
inline constexpr const char* word_for<Sphere> = "Sphere";
template <>
inline constexpr const char* word_for<Vec> = "Vec";
template <>
inline constexpr const char* word_for<Box> = "Box";
template <>
inline constexpr const char* word_for<Ray> = "Ray";
template <>
inline constexpr const char* word_for<HitsAlong> = "HitsAlong";

template <>
inline constexpr const char* word_for<Neighbours> = "Neighbours";
template <>
inline constexpr const char* word_for<Ball> = "Ball";

template <template <class, int> class Shape, class T, int D>
std::string name_of(const Shape<T, D>&) {
    return word_for<Shape> + std::string("<") + scalar_name<T> + ", " + std::to_string(D) + ">";
}

}  // namespace hedgerow::hunter
