/// What a cone sees: fragments of triangles from front to back, each with the samples that it covers
/// (Carpenter, The A-buffer, an antialiased hidden surface method, SIGGRAPH 1984; cones: Amanatides,
/// SIGGRAPH 1984). One number of coverage could not tell surfaces that abut from those that overlap.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numbers>
#include <vector>

#include <hedgerow/queries/candidates.h>

namespace hedgerow {

/// 64 samples of a cone's cross section, the disc of radius 1: a (0, 6, 2)-net of the square (Hammersley's
/// points: each of the 64 boxes of any shape 2^-a × 2^(a−6) has one), mapped to the disc so that equal areas
/// stay equal (Shirley and Chiu 1997). A regular grid has 8 levels of coverage for an edge along an axis, a
/// net has 64.
struct ConeSamples {
    static constexpr int count = 64;
    alignas(64) std::array<double, count> x, y;

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
    static constexpr double pi = std::numbers::pi;
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

/// The edges and the plane of triangles as functions of a cone's samples.
///
/// The ray of sample w starts at o + r·w and goes along a + s·w, where r is the cone's radius, s its slope, a
/// its axis. So the function of an edge from B to C, the triple product of the ray's direction and of both
/// corners from its origin, is linear in w, as is the height of the origin over the triangle's plane.
class ConeFrame {
public:
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
    /// The functions of a triangle: of its edges, and of the height of the origin over its plane. A sample's
    /// ray hits the triangle if the edges have one sign, at the depth height / (u + v + w).
    struct Triangle {
        Linear u, v, w, height;

        /// Whether two edges have opposite signs in all of the disc, so that no sample hits.
        bool misses() const {
            const bool above = u.surely_above() || v.surely_above() || w.surely_above(),
                       below = (-u).surely_above() || (-v).surely_above() || (-w).surely_above();
            return above && below;
        }
    };

    template <std::floating_point T>
    explicit ConeFrame(const ConeRays<T, 3>& cone)
        : axis_(cone.axis()), radius_(cone.radius()), slope_(cone.slope()) {
        Vec3d beside;
        beside[std::abs(axis_[0]) < 0.5 ? 0 : 1] = 1;
        across_[0] = normalized(cross(axis_, beside));
        across_[1] = cross(axis_, across_[0]);
    }

    /// The functions of a triangle that is given from the apex.
    Triangle triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
        const Vec3d normal = cross(b - a, c - a);
        return {edge(b, c),
                edge(c, a),
                edge(a, b),
                {dot(normal, a), -product(radius_, dot(normal, across_[0])),
                 -product(radius_, dot(normal, across_[1]))}};
    }

    /// The ray of a sample, or of any place in the disc, where its direction has length 1 along the axis.
    Ray<double, 3> ray(const Vec3d& apex, double x, double y) const {
        const Vec3d w = across_[0] * x + across_[1] * y;
        return {apex + w * radius_, axis_ + w * slope_};
    }

private:
    Linear edge(const Vec3d& b, const Vec3d& c) const {
        const Vec3d normal = cross(b, c), along = c - b;
        return {dot(axis_, normal),
                product(slope_, dot(across_[0], normal)) - product(radius_, dot(across_[1], along)),
                product(slope_, dot(across_[1], normal)) + product(radius_, dot(across_[0], along))};
    }

    Vec3d axis_, across_[2];
    double radius_, slope_;
};

/// What the samples of a cone see so far: the nearest triangle at each, and its depth, which is infinite
/// where there is none. All is computed in double, so that samples do not leak at edges.
struct ConeView {
    static constexpr int count = ConeSamples::count;
    alignas(64) std::array<double, count> depth;
    std::array<std::uint64_t, count> element;

    ConeView() { depth.fill(std::numeric_limits<double>::infinity()), element.fill(no_primitive); }

    /// Takes a triangle at the samples that hit it between two depths, and nothing nearer or, at the same
    /// depth, with a lower ordinal.
    void take(const ConeFrame::Triangle& t, const Interval<double>& depths, PrimitiveId id) {
        const auto& samples = ConeSamples::all();
        for (std::size_t i = 0; i < count; ++i) {
            const double x = samples.x[i], y = samples.y[i];
            const double eu = t.u.at(x, y), ev = t.v.at(x, y), ew = t.w.at(x, y), sum = eu + ev + ew;
            const bool one_sign = (eu >= 0 && ev >= 0 && ew >= 0) || (eu <= 0 && ev <= 0 && ew <= 0);
            if (!one_sign || sum == 0) continue;
            const double here = t.height.at(x, y) / sum;
            if (!(here >= depths.entry && here <= depths.exit)) continue;
            if (here > depth[i] || (here == depth[i] && id > element[i])) continue;
            depth[i] = here, element[i] = id;
        }
    }
    /// The depth beyond which nothing is seen if `farthest` is the greatest depth of a sample: rounded up by
    /// more than depths err by.
    template <std::floating_point T>
    static T limit(double farthest) {
        const double limit = farthest * (1 + 0x1p-18);
        return limit < static_cast<double>(std::numeric_limits<T>::max()) ? static_cast<T>(limit)
                                                                          : std::numeric_limits<T>::max();
    }
    /// The samples that see a triangle, and its least depth there.
    struct Share {
        std::uint64_t samples;
        double nearest;
    };
    Share share(std::uint64_t id) const {
        Share share{0, std::numeric_limits<double>::infinity()};
        for (std::size_t i = 0; i < count; ++i) {
            const bool same = element[i] == id;
            share.samples |= std::uint64_t(same) << i;
            share.nearest = same ? std::min(share.nearest, depth[i]) : share.nearest;
        }
        return share;
    }
    /// Writes the fragments to a vector, which is cleared: ascending by (depth, element). Returns how many
    /// there are. share_of(view, id) is `share(id)`.
    template <std::floating_point T, class ShareOf>
    std::size_t write(std::vector<ConeFragment<T>>& found, ShareOf share_of) const {
        found.clear();
        std::uint64_t left = ~share_of(*this, no_primitive).samples;
        while (left != 0) {
            const auto id = element[static_cast<std::size_t>(std::countr_zero(left))];
            const auto [samples, nearest] = share_of(*this, id);
            found.push_back({static_cast<T>(nearest), static_cast<PrimitiveId>(id), samples});
            left &= ~samples;
        }
        std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
            return a.depth != b.depth ? a.depth < b.depth : a.element < b.element;
        });
        return found.size();
    }
};

/// Collects fragments in the caller's vector, which is cleared: ascending by (depth, element). A sample is a
/// ray from the apex's disc to the cross section, and belongs to the triangle that it hits first, with equal
/// depths to the lowest element; one on a common edge hits both triangles. It may differ from `closest_hit`
/// where rounding decides. Once all samples have a triangle, what begins beyond the farthest of them is
/// passed over. Needs a set of triangles.
template <class Set>
class ConeFragments {
public:
    using Scalar = typename Set::Scalar;
    using T = Scalar;
    using Probe = ConeProbe<T, 3>;
    static constexpr Order order = Order::nearest;

    template <class Index>
    ConeFragments(const Index& index, const ConeRays<T, 3>& cone, std::vector<ConeFragment<T>>& found)
        : probe_(cone, index.bounds()), frame_(cone), set_(index.primitives()), found_(found) {}

    const Probe& probe() const { return probe_; }
    T limit() const { return limit_; }
    Flow offer(const FamilyCandidate<T>& c) {
        const auto triangle = set_.triangle(c.element);
        const Vec3d o = probe_.rays().origin();
        const auto functions =
            frame_.triangle(Vec3d(triangle.a) - o, Vec3d(triangle.b) - o, Vec3d(triangle.c) - o);
        if (functions.misses()) return Flow::go_on;
        view_.take(functions, probe_.rays().depths(), c.element);
        limit_ = ConeView::limit<T>(*std::max_element(view_.depth.begin(), view_.depth.end()));
        return Flow::go_on;
    }
    std::size_t answer() {
        return view_.write(found_, [](const ConeView& view, std::uint64_t id) { return view.share(id); });
    }

private:
    Probe probe_;
    const ConeFrame frame_;
    const Set& set_;
    std::vector<ConeFragment<T>>& found_;
    ConeView view_;
    T limit_ = std::numeric_limits<T>::max();
};

}  // namespace hedgerow
