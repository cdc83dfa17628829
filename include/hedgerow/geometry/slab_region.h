/// What lies between planes as a region: half-spaces, frusta, oriented boxes, k-DOPs, and hulls of any
/// planes.
///
/// The planes count as they are given, as numbers of T. Whether a point is in a region of slabs is exact, and
/// so is whether a triangle or segment lies in it. A triangle or segment that overlaps the region is always
/// found; one that is found comes within 2^-43 of every plane's inside, relative to the sizes of the
/// coordinates and the offset. Balls are decided in double, with errors of that kind. Beside an edge that is
/// sharper than 2^-15 a ball may be found that is apart.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <hedgerow/base/scratch.h>
#include <hedgerow/geometry/frustum.h>
#include <hedgerow/geometry/hull.h>
#include <hedgerow/geometry/kdop.h>
#include <hedgerow/geometry/obb.h>
#include <hedgerow/geometry/region.h>

namespace hedgerow {

namespace detail {
/// Calls f(normal, offset) for each half-space of a volume, until f returns false. Returns false if f did.
template <SlabVolume V, class F>
bool for_each_face(const V& v, F f) {
    for (int i = 0; i < v.slab_count(); ++i) {
        const auto s = v.slab(i);
        if (s.high < std::numeric_limits<double>::infinity() && !f(s.normal, s.high)) return false;
        if (s.low > -std::numeric_limits<double>::infinity() && !f(-s.normal, -s.low)) return false;
    }
    return true;
}
/// The exact sign of normal·x − offset.
template <int D>
int height_sign(const Vec<double, D>& normal, double offset, const Vec<double, D>& x) {
    double sum = -offset, size = std::abs(offset);
    for (int k = 0; k < D; ++k) {
        const double p = product(normal[k], x[k]);
        sum += p, size += std::abs(p);
    }
    if (std::abs(sum) > product(8 * unit_roundoff<double>, size) + underflow) [[likely]]
        return sum > 0 ? 1 : -1;
    ExactSum exact;
    for (int k = 0; k < D; ++k) exact.add(normal[k], x[k]);
    return exact.subtract(offset, 1).sign();
}
/// What heights are compared with beyond their plane: errors of boxes exceed those of shapes in them.
inline double height_error(double of_size, double size) {
    return product(of_size, size) + 0x1p-1000;
}
inline constexpr double box_heights_err = 0x1p-42, clipped_heights_err = 0x1p-44;

/// Heights of a box along a normal, as computed, and the size of their products.
struct BoxHeights {
    double low = 0, high = 0, size = 0;

    template <class U, int D>
    BoxHeights(const Box<U, D>& box, const Vec<double, D>& normal) {
        for (int k = 0; k < D; ++k) {
            const double a = product(normal[k], static_cast<double>(box.low[k]));
            const double b = product(normal[k], static_cast<double>(box.high[k]));
            low += std::min(a, b), high += std::max(a, b);
            size += std::max(std::abs(a), std::abs(b));
        }
    }
};

/// Whether the convex hull of corners has a point in the region. Decides by the corners, exactly, if it can:
/// all are beyond one plane, or one is in the region. Else clips the hull by every plane, moved outward by
/// the error of heights (Sutherland and Hodgman 1974).
template <SlabVolume V, std::size_t n>
bool hull_overlaps(const std::array<Vec<double, V::dimension>, n>& corners, const V& region) {
    using Point = Vec<double, V::dimension>;
    constexpr unsigned all = (1u << n) - 1;
    unsigned inside = all;
    const bool near = for_each_face(region, [&](const Point& normal, double offset) {
        unsigned beyond = 0;
        for (std::size_t i = 0; i < n; ++i)
            beyond |= static_cast<unsigned>(height_sign(normal, offset, corners[i]) > 0) << i;
        inside &= ~beyond;
        return beyond != all;
    });
    if (!near) return false;
    if (inside != 0) return true;
    Point most;
    for (const Point& c : corners) most = max(most, abs(c));
    // Any number of planes may cut corners off.
    const Scratch<std::vector<Point>> polygon_memory, clipped_memory;
    std::vector<Point>&polygon = *polygon_memory, &clipped = *clipped_memory;
    polygon.assign(corners.begin(), corners.end());
    return for_each_face(region, [&](const Point& normal, double offset) {
        const double limit =
            offset + height_error(clipped_heights_err, dot(abs(normal), most) + std::abs(offset));
        clipped.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            const double from = dot(normal, p) - limit, to = dot(normal, q) - limit;
            if (from <= 0) clipped.push_back(p);
            if ((from < 0 && to > 0) || (from > 0 && to < 0))
                clipped.push_back(p + (q - p) * (from / (from - to)));
        }
        polygon.swap(clipped);
        return !polygon.empty();
    });
}

/// Whether some half-spaces separate a ball from what they have in common. For weights w >= 0, every point of
/// the region is at least (sum of w·height) / |sum of w·normal| away from the center; the greatest of these
/// bounds is the distance, and needs at most D half-spaces (the projection's multipliers). So this tries all
/// such sets of half-spaces whose plane meets the ball. If nothing is in all of these half-spaces, no more
/// than D + 1 of them have no point in common (Helly), so sets of that many are tried too unless a point is
/// found. Never true for a ball that overlaps the region.
template <int D>
class BallSeparation {
public:
    BallSeparation(const Vec<double, D>& center, double radius) : center_(center), radius_(radius) {
        faces_.clear();
    }

    /// Adds a half-space. Returns false if it holds no point of the ball.
    bool add(const Vec<double, D>& normal, double offset) {
        const double size = length(normal);
        if (!(size > 0)) return offset >= 0;
        const double height = dot(normal, center_) - offset;
        const double error = height_error(
            clipped_heights_err, dot(abs(normal), abs(center_)) + std::abs(offset) + product(size, radius_));
        if (height - error > product(size, radius_)) return false;
        if (height + error >= -product(size, radius_))
            faces_.push_back({normal / size, height / size, error / size});
        return true;
    }
    bool separates() const {
        for (std::size_t i = 0; i < faces_.size(); ++i)
            for (std::size_t j = i + 1; j < faces_.size(); ++j) {
                const Face &a = faces_[i], &b = faces_[j];
                const double ab = dot(a.normal, b.normal);
                if (apart({&a, &b}, {a.height - ab * b.height, b.height - ab * a.height})) return true;
                if constexpr (D == 3)
                    for (std::size_t k = j + 1; k < faces_.size(); ++k) {
                        // The multipliers solve the Gram matrix; its adjugate gives them but for a factor >
                        // 0.
                        const Face& c = faces_[k];
                        const double ac = dot(a.normal, c.normal), bc = dot(b.normal, c.normal);
                        if (apart({&a, &b, &c}, {a.height * (1 - bc * bc) + b.height * (ac * bc - ab) +
                                                     c.height * (ab * bc - ac),
                                                 a.height * (ac * bc - ab) + b.height * (1 - ac * ac) +
                                                     c.height * (ab * ac - bc),
                                                 a.height * (ab * bc - ac) + b.height * (ab * ac - bc) +
                                                     c.height * (1 - ab * ab)}))
                            return true;
                    }
            }
        return faces_.size() > D && !have_a_point() && no_point_in_some(0, 0);
    }

private:
    struct Face {
        Vec<double, D> normal;  // of length 1
        double height, error;
    };
    /// Whether projections onto violated planes, and as far again beyond, soon reach a point that is clearly
    /// in all half-spaces. Mostly they do if there is one.
    bool have_a_point() const {
        Vec<double, D> x;  // from the center
        for (int round = 0; round < 8; ++round) {
            bool inside = true;
            for (const Face& f : faces_) {
                const double height = dot(f.normal, x) + f.height;
                const double error = f.error + 0x1p-48 * (std::abs(f.height) + length(x));
                if (height <= -error) continue;
                inside = false;
                x = x - f.normal * (2 * (height + 2 * error));
            }
            if (inside) return true;
        }
        return false;
    }
    /// Tries all sets of D + 1 half-spaces, of which `chosen` are in chosen_ and the others come from
    /// `first` on. The normals' combination by the weights is 0: if that of the heights is more, no point is
    /// in all of them.
    bool no_point_in_some(int chosen, std::size_t first) const {
        if (chosen <= D) {
            for (std::size_t i = first; i < faces_.size(); ++i) {
                chosen_[chosen] = &faces_[i];
                if (no_point_in_some(chosen + 1, i + 1)) return true;
            }
            return false;
        }
        double weights[D + 1];
        const auto n = [&](int i) { return chosen_[i]->normal; };
        if constexpr (D == 2) {
            const auto area = [&](int i, int j) {
                return product(n(i)[0], n(j)[1]) - product(n(i)[1], n(j)[0]);
            };
            weights[0] = area(1, 2), weights[1] = area(2, 0), weights[2] = area(0, 1);
        } else {
            const auto volume = [&](int i, int j, int k) { return dot(n(i), cross(n(j), n(k))); };
            weights[0] = volume(1, 2, 3), weights[1] = -volume(0, 2, 3);
            weights[2] = volume(0, 1, 3), weights[3] = -volume(0, 1, 2);
        }
        if (weights[0] < 0)
            for (double& w : weights) w = -w;
        return apart(chosen_, weights);
    }
    template <std::size_t n>
    bool apart(const Face* const (&faces)[n], const double (&weights)[n]) const {
        Vec<double, D> direction;
        double height = 0, error = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (!(weights[i] >= 0)) return false;
            direction = direction + faces[i]->normal * weights[i];
            height += product(faces[i]->height, weights[i]);
            error += product(faces[i]->error + 0x1p-48 * (radius_ + std::abs(faces[i]->height)), weights[i]);
        }
        return height - error > product(length(direction), radius_);
    }

    Vec<double, D> center_;
    double radius_;
    Scratch<std::vector<Face>> memory_;
    std::vector<Face>& faces_ = *memory_;
    mutable const Face* chosen_[D + 1] = {};
};
}  // namespace detail

/// True if a normal is not finite or an offset is NaN, and for slabs whose low side is beyond the high one.
template <SlabVolume V>
bool is_empty(const V& region) {
    for (int i = 0; i < region.slab_count(); ++i) {
        const auto s = region.slab(i);
        if (!finite(s.normal) || !(s.low <= s.high) || s.high == -std::numeric_limits<double>::infinity() ||
            s.low == std::numeric_limits<double>::infinity())
            return true;
    }
    return false;
}
/// Tests the planes alone: a box that is beyond no single plane, but beside an edge, counts as across.
template <SlabVolume V, class U>
Containment containment(const V& region, const Box<U, V::dimension>& box) {
    bool inside = true;
    const bool meets =
        detail::for_each_face(region, [&](const Vec<double, V::dimension>& normal, double offset) {
            const detail::BoxHeights heights(box, normal);
            const double error =
                detail::height_error(detail::box_heights_err, heights.size + std::abs(offset));
            inside = inside && heights.high + error <= offset;
            return !(heights.low - error > offset);
        });
    if (!meets) return Containment::outside;
    return inside ? Containment::inside : Containment::across;
}
/// Moves each side of the box inward to where every plane leaves room between the other sides, twice. Not the
/// smallest box.
template <SlabVolume V>
Box<double, V::dimension> bounds_in(const V& region, const Box<double, V::dimension>& box, double margin) {
    constexpr int D = V::dimension;
    Box<double, D> part = box;
    for (int pass = 0; pass < 2; ++pass)
        detail::for_each_face(region, [&](const Vec<double, D>& normal, double offset) {
            const double size = detail::BoxHeights(box, normal).size + std::abs(offset);
            const double wider = detail::height_error(detail::box_heights_err, size) +
                                 product(margin, dot(abs(normal), Vec<double, D>::all(1)));
            const double room = offset + wider - detail::BoxHeights(part, normal).low;
            for (int k = 0; k < D; ++k) {
                const double side = room / normal[k] * (1 + 0x1p-40);  // from the lowest corner to the plane
                if (normal[k] > 0) part.high[k] = std::min(part.high[k], part.low[k] + side);
                if (normal[k] < 0) part.low[k] = std::max(part.low[k], part.high[k] + side);
            }
            return true;
        });
    return part;
}
/// Of oriented boxes and k-DOPs, the sum of the extents along orthonormal axes; of frusta, that of their
/// corners; of others, everything.
template <SlabVolume V>
Extent extent(const V& region, const Vec<double, V::dimension>& normal) {
    if constexpr (requires { region.extent(normal); }) {
        return region.extent(normal);
    } else if constexpr (V::orthonormal < V::dimension) {
        return {};
    } else {
        double low = 0, high = 0, size = 0;
        for (int i = 0; i < V::dimension; ++i) {
            const auto s = region.slab(i);
            const double along = dot(normal, s.normal), a = product(along, s.low), b = product(along, s.high);
            low += std::min(a, b), high += std::max(a, b);
            size += product(length(normal), std::max(std::abs(s.low), std::abs(s.high)));
        }
        const double error = product(0x1p-18, size) + 0x1p-500;
        return {low - error, high + error};
    }
}

template <class T, SlabVolume V>
bool lies_in(const Vec<T, V::dimension>& p, const V& region) {
    using Point = Vec<double, V::dimension>;
    return detail::for_each_face(region, [x = Point(p)](const Point& normal, double offset) {
        return detail::height_sign(normal, offset, x) <= 0;
    });
}
template <class T, SlabVolume V>
bool lies_in(const Sphere<T, V::dimension>& s, const V& region) {
    using Point = Vec<double, V::dimension>;
    return lies_in(s.center, region) &&
           detail::for_each_face(region, [&](const Point& normal, double offset) {
               return dot(normal, Point(s.center)) + product(length(normal), static_cast<double>(s.radius)) <=
                      offset;
           });
}
template <class T, SlabVolume V>
bool overlap(const Triangle<T, V::dimension>& t, const V& region) {
    using Point = Vec<double, V::dimension>;
    return detail::hull_overlaps(std::array{Point(t.a), Point(t.b), Point(t.c)}, region);
}
template <class T, SlabVolume V>
bool overlap(const Segment<T, V::dimension>& s, const V& region) {
    using Point = Vec<double, V::dimension>;
    return detail::hull_overlaps(std::array{Point(s.a), Point(s.b)}, region);
}
template <class T, SlabVolume V>
bool overlap(const Sphere<T, V::dimension>& s, const V& region) {
    using Point = Vec<double, V::dimension>;
    if (lies_in(s.center, region)) return true;
    detail::BallSeparation<V::dimension> planes(Point(s.center), static_cast<double>(s.radius));
    return detail::for_each_face(
               region, [&](const Point& normal, double offset) { return planes.add(normal, offset); }) &&
           !planes.separates();
}

}  // namespace hedgerow
