/// What closes the holes of a solid.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <hedgerow/geometry/lanes.h>
#include <hedgerow/index.h>
#include <hedgerow/probes/point_batch.h>
#include <hedgerow/queries/half_angles.h>

namespace hedgerow::detail {

/// Fans of triangles that close a surface with few open edges, in an index of their own. Mesh and caps
/// together have whole winding numbers, so what the mesh lacks of one is the share of the caps.
template <std::floating_point T>
class Caps {
public:
    /// A part of a winding number, and how far it may be off.
    struct Share {
        double number, error;
    };

    Caps() = default;
    Caps(const BoundingLoops& loops, Executor& executor) {
        TriangleMesh<T> mesh;
        std::vector<Cap> caps;
        loops.for_each([&](std::span<const Vec3d> loop) {
            Cap cap;
            cap.first = static_cast<std::uint32_t>(mesh.triangles.size());
            const auto corner = static_cast<std::uint32_t>(mesh.vertices.size());
            for (const Vec3d& p : loop) {
                cap.seen.box.expand(p);
                mesh.vertices.emplace_back(p);
            }
            for (std::uint32_t i = 1; i + 2 < loop.size(); ++i) {
                mesh.triangles.push_back({corner, corner + i + 1, corner + i});
                ++cap.count;
                // At least the triangle's area: the sum of the normal's components, whose squares may
                // underflow.
                const Vec3d n = abs(cross(loop[i] - loop[0], loop[i + 1] - loop[0]));
                cap.seen.area += (n[0] + n[1] + n[2]) / 2;
            }
            caps.push_back(cap);
            all_.add(cap.seen);
        });
        index_ = build<WideBvh>(std::move(mesh), {}, executor);
        group(std::move(caps));
    }

    bool empty() const { return fans_.empty(); }
    const auto& index() const { return index_; }
    /// What the caps are of the winding number at x. Caps that x sees under few directions, each under at
    /// most its area by the square of its distance, are only bounded, and so are groups of them.
    Share share_at(const Vec3d& x) const {
        constexpr double all_directions = 4 * std::numbers::pi, quarter = all_directions / 4;
        if (all_.area < quarter * distance2(x, all_.box)) return {0, 0.25};
        const Bounds of_groups(x, quarter / static_cast<double>(groups_.size() * 4));
        const Bounds of_caps(x, quarter / static_cast<double>(rows_in_group_ * 4));
        const double scale = scale_of_offsets(x, all_.box);
        L bounded = L::all(0);
        std::uint32_t summed = 0;
        SumOfAngles sum;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            for (unsigned near = of_groups.near(groups_[g], bounded); near != 0; near &= near - 1) {
                const std::size_t first = (4 * g + place_of(near)) * rows_in_group_;
                for (std::size_t r = first; r < first + rows_in_group_; ++r) {
                    for (unsigned caps = of_caps.near(rows_[r], bounded); caps != 0; caps &= caps - 1) {
                        const Fan& fan = fans_[4 * r + place_of(caps)];
                        if ((summed += fan.count) > most_summed) return {0, 1};
                        add(sum, fan, x, scale);
                    }
                }
            }
        }
        double sums[4];
        bounded.store(sums);
        const double error = (sums[0] + sums[1] + sums[2] + sums[3]) / all_directions;
        return {summed == 0 ? 0 : sum.turns(), error + 1e-9};
    }
    std::size_t bytes() const {
        return fans_.capacity() * sizeof(Fan) + (rows_.capacity() + groups_.capacity()) * sizeof(FourSeen) +
               index_.bytes() + index_.size() * (sizeof(TriangleIndices) + sizeof(Vec<T, 3>));
    }

private:
    using L = Lanes<double>;
    /// Triangles by a box around them, and their area.
    struct Seen {
        Box3d box;
        double area = 0;

        void add(const Seen& more) {
            box.expand(more.box);
            area += more.area;
        }
    };
    struct Fan {
        std::uint32_t first = 0, count = 0;  // of triangles
    };
    struct Cap : Fan {
        Seen seen;
    };
    /// Four of them side by side, or less: what is empty is infinitely far away.
    struct FourSeen {
        double low[3][4], high[3][4], area[4];

        void set(std::size_t i, const Seen& seen) {
            for (int k = 0; k < 3; ++k) low[k][i] = seen.box.low[k], high[k][i] = seen.box.high[k];
            area[i] = seen.area;
        }
    };
    /// The directions under which x sees what lies in boxes: those that may be more than `few` are near.
    class Bounds {
    public:
        Bounds(const Vec3d& x, double few)
            : x_{L::all(x[0]), L::all(x[1]), L::all(x[2])}, few_(L::all(few)) {}
        /// Bits of those that are near. Adds the bounds of the others, and as much as these may be of the
        /// near.
        unsigned near(const FourSeen& four, L& bounded) const {
            L square = L::all(0);
            for (int k = 0; k < 3; ++k) {
                const L outside =
                    max(max(L::load(four.low[k]) - x_[k], x_[k] - L::load(four.high[k])), L::all(0));
                square = square + outside * outside;
            }
            const L area = L::load(four.area);
            bounded = bounded + min(area / square, few_);
            return less_equal(few_ * square, area);
        }

    private:
        L x_[3], few_;
    };
    /// More triangles than these take longer than the angles of the loops.
    static constexpr std::uint32_t most_summed = 64;

    static std::size_t place_of(unsigned bits) { return static_cast<std::size_t>(std::countr_zero(bits)); }
    /// Divides caps into groups of neighbours: about as many as one has caps.
    void group(std::vector<Cap> caps) {
        const CurveOfPoints<double, 3> curve(all_.box);
        const auto code = [&](const Cap& cap) { return curve.code(cap.seen.box.center()); };
        std::sort(caps.begin(), caps.end(), [&](const Cap& a, const Cap& b) { return code(a) < code(b); });
        rows_in_group_ = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(caps.size())) / 4));
        const std::size_t in_group = 4 * rows_in_group_, groups = (caps.size() + in_group - 1) / in_group;
        FourSeen nothing;
        for (std::size_t i = 0; i < 4; ++i) nothing.set(i, {});
        rows_.assign(groups * rows_in_group_, nothing);
        groups_.assign((groups + 3) / 4, nothing);
        for (std::size_t g = 0; g < groups; ++g) {
            Seen whole;
            for (std::size_t i = g * in_group; i < std::min(caps.size(), (g + 1) * in_group); ++i) {
                rows_[i / 4].set(i % 4, caps[i].seen);
                fans_.push_back(caps[i]);
                whole.add(caps[i].seen);
            }
            groups_[g / 4].set(g % 4, whole);
        }
    }
    void add(SumOfAngles& sum, const Fan& fan, const Vec3d& x, double scale) const {
        for (std::uint32_t i = fan.first; i < fan.first + fan.count; ++i) {
            const Triangle<T, 3> t = index_.primitives().triangle(i);
            const HalfAngle h = HalfAngles::of({Vec3d(t.a), Vec3d(t.b), Vec3d(t.c)}, x, scale);
            sum.add(h.real, h.imaginary);
        }
    }

    std::vector<Fan> fans_;
    std::vector<FourSeen> rows_, groups_;  // of the fans, and of so many rows each
    std::size_t rows_in_group_ = 1;
    Seen all_;
    IndexOf<WideBvh, TriangleMesh<T>> index_;
};
}  // namespace hedgerow::detail
