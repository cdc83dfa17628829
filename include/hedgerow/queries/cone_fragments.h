/// What a cone sees: fragments of triangles from front to back, each with the samples that it covers
/// (Carpenter, The A-buffer, an antialiased hidden surface method, SIGGRAPH 1984; cones: Amanatides,
/// SIGGRAPH 1984). One number of coverage could not tell surfaces that abut from those that overlap.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <hedgerow/queries/candidates.h>

namespace hedgerow {

/// 64 samples of a cone's cross section, the disc of radius 1: a (0, 6, 2)-net of the square (Hammersley's
/// points: each of the 64 boxes of any shape 2^-a × 2^(a−6) has one), mapped to the disc so that equal areas
/// stay equal (Shirley and Chiu 1997). A regular grid has 8 levels of coverage for an edge along an axis, a
/// net has 64.
struct ConeSamples {
    static constexpr int count = 64;
    std::array<double, count> x, y;

    /// Point i of the net.
    static constexpr Vec2d in_square(int i) {
        int reversed = 0;
        for (int bit = 0; bit < 6; ++bit) reversed |= (i >> bit & 1) << (5 - bit);
        return {(i + 0.5) / count, (reversed + 0.5) / count};
    }
    static const ConeSamples& all() {
        static const ConeSamples samples;
        return samples;
    }

private:
    ConeSamples() {
        for (int i = 0; i < count; ++i) {
            const Vec2d p = in_square(i) * 2.0 - Vec2d::all(1);
            const bool wide = std::abs(p[0]) > std::abs(p[1]);
            const double radius = wide ? p[0] : p[1];
            const double angle = wide ? 0.25 * pi * (p[1] / p[0]) : 0.5 * pi - 0.25 * pi * (p[0] / p[1]);
            x[static_cast<std::size_t>(i)] = radius * std::cos(angle);
            y[static_cast<std::size_t>(i)] = radius * std::sin(angle);
        }
    }
    static constexpr double pi = 3.14159265358979323846;
};

/// A triangle that is the nearest at some samples (a bit each), and its least depth at these.
template <std::floating_point T>
struct ConeFragment {
    T depth;
    PrimitiveId element;
    std::uint64_t samples;
    friend bool operator==(const ConeFragment&, const ConeFragment&) = default;

    /// The share of the cone's cross section.
    double coverage() const { return std::popcount(samples) / double(ConeSamples::count); }
};

/// Collects fragments in the caller's vector, which is cleared: ascending by (depth, element). A sample is a
/// ray from the apex's disc to the cross section, and belongs to the triangle that it hits first, with equal
/// depths to the lowest element; one on a common edge hits both triangles. All is computed in double, so that
/// the samples do not leak at edges, but may differ from `closest_hit` where rounding decides. Once all
/// samples have a triangle, what begins beyond the farthest of them is passed over. Needs a set of triangles.
///
/// The ray of sample w starts at o + r·w and goes along a + s·w, where r is the cone's radius, s its slope, a
/// its axis. So the function of an edge from B to C, the triple product of the ray's direction and of both
/// corners from its origin, is linear in w, as is the height of the origin over the triangle's plane.
template <class Set>
class ConeFragments {
public:
    using Scalar = typename Set::Scalar;
    using T = Scalar;
    using Probe = ConeProbe<T, 3>;
    static constexpr Order order = Order::nearest;
    static constexpr int count = ConeSamples::count;

    template <class Index>
    ConeFragments(const Index& index, const ConeRays<T, 3>& cone, std::vector<ConeFragment<T>>& found)
        : probe_(cone, index.bounds()), set_(index.primitives()), found_(found) {
        found_.clear();
        const Vec3d& a = cone.axis();
        Vec3d beside;
        beside[std::abs(a[0]) < 0.5 ? 0 : 1] = 1;
        across_[0] = normalized(cross(a, beside));
        across_[1] = cross(a, across_[0]);
        depth_.fill(std::numeric_limits<double>::infinity());
        element_.fill(no_primitive);
    }

    const Probe& probe() const { return probe_; }
    T limit() const { return limit_; }
    Flow offer(const FamilyCandidate<T>& c) {
        const auto triangle = set_.triangle(c.element);
        const Vec3d o = probe_.rays().origin();
        take(Vec3d(triangle.a) - o, Vec3d(triangle.b) - o, Vec3d(triangle.c) - o, c.element);
        return Flow::go_on;
    }
    std::size_t answer() {
        for (std::size_t i = 0; i < count; ++i) {
            if (element_[i] == no_primitive) continue;
            const auto same = [&](const auto& f) { return f.element == element_[i]; };
            auto it = std::find_if(found_.begin(), found_.end(), same);
            if (it == found_.end()) it = found_.insert(it, {static_cast<T>(depth_[i]), element_[i], 0});
            it->depth = std::min(it->depth, static_cast<T>(depth_[i]));
            it->samples |= std::uint64_t(1) << i;
        }
        std::sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
            return a.depth != b.depth ? a.depth < b.depth : a.element < b.element;
        });
        return found_.size();
    }

private:
    /// A function that is linear in the sample.
    struct Linear {
        double constant, x, y;
        double at(double wx, double wy) const { return constant + product(x, wx) + product(y, wy); }
        /// Whether it is above 0 by more than roundings in all of the disc.
        bool surely_above() const {
            return constant > (1 + 0x1p-40) * std::sqrt(product(x, x) + product(y, y));
        }
        Linear operator-() const { return {-constant, -x, -y}; }
    };
    /// The function of the edge from b to c.
    Linear edge(const Vec3d& b, const Vec3d& c) const {
        const auto& rays = probe_.rays();
        const Vec3d normal = cross(b, c), along = c - b;
        return {
            dot(rays.axis(), normal),
            product(rays.slope(), dot(across_[0], normal)) - product(rays.radius(), dot(across_[1], along)),
            product(rays.slope(), dot(across_[1], normal)) + product(rays.radius(), dot(across_[0], along))};
    }
    /// Tests a triangle, given from the apex, at all samples.
    void take(const Vec3d& a, const Vec3d& b, const Vec3d& c, PrimitiveId element) {
        const auto& samples = ConeSamples::all();
        const Linear u = edge(b, c), v = edge(c, a), w = edge(a, b);
        // Functions of opposite signs in all of the disc: no sample is covered.
        const bool above = u.surely_above() || v.surely_above() || w.surely_above(),
                   below = (-u).surely_above() || (-v).surely_above() || (-w).surely_above();
        if (above && below) return;
        const Vec3d normal = cross(b - a, c - a);
        const double radius = probe_.rays().radius();
        const Linear height{dot(normal, a), -product(radius, dot(normal, across_[0])),
                            -product(radius, dot(normal, across_[1]))};
        const Interval<double> depths = probe_.rays().depths();
        for (std::size_t i = 0; i < count; ++i) {
            const double x = samples.x[i], y = samples.y[i];
            const double eu = u.at(x, y), ev = v.at(x, y), ew = w.at(x, y), sum = eu + ev + ew;
            const bool one_sign = (eu >= 0 && ev >= 0 && ew >= 0) || (eu <= 0 && ev <= 0 && ew <= 0);
            if (!one_sign || sum == 0) continue;
            const double depth = height.at(x, y) / sum;
            if (!(depth >= depths.entry && depth <= depths.exit)) continue;
            if (depth > depth_[i] || (depth == depth_[i] && element > element_[i])) continue;
            depth_[i] = depth, element_[i] = element;
        }
        // No farther than the farthest sample, rounded up by more than depths err by.
        const double farthest = *std::max_element(depth_.begin(), depth_.end());
        const double most = static_cast<double>(std::numeric_limits<T>::max());
        limit_ = farthest < most ? static_cast<T>(farthest * (1 + 0x1p-18)) : limit_;
    }

    Probe probe_;
    const Set& set_;
    std::vector<ConeFragment<T>>& found_;
    Vec3d across_[2];
    T limit_ = std::numeric_limits<T>::max();
    std::array<double, count> depth_;
    std::array<PrimitiveId, count> element_;
};

}  // namespace hedgerow
