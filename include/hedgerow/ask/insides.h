/// The questions of a solid: whether a point is inside of a surface, how often the surface winds around it,
/// and how far away it is with a sign.
#pragma once

#include <optional>
#include <string_view>

#include <hedgerow/ask/insides/caps.h>
#include <hedgerow/ask/points.h>
#include <hedgerow/base/scratch.h>
#include <hedgerow/engine/expanded_index.h>
#include <hedgerow/geometry/closing_angle.h>
#include <hedgerow/primitives/pseudonormals.h>
#include <hedgerow/queries/signed_crossings.h>

namespace hedgerow {

enum class Side : std::uint8_t { outside, on, inside };

/// How a Solid tells its sides.
/// - `crossings`: the winding number, by the signed crossings of one ray and the angle of what would close
///   the surface. Right for every mesh.
/// - `parity`: whether a ray crosses the surface an odd number of times. Triangles may be turned either way,
///   but the surface must be closed.
/// - `pseudonormal`: the side of the surface at the closest point (Bærentzen and Aanæs 2005), for open
///   surfaces that are oriented and do not meet themselves: in front of them is outside, behind them inside,
///   however far their holes. Of a closed and oriented surface it is the side by crossings, which are exact
///   and cost less than it takes to make sure of a pseudonormal. Crossings decide too where roundings leave
///   in doubt which primitive is closest, and these disagree.
/// - `expansion`: the winding number within a promised error, by multipole expansions (Barill et al. 2018).
///   For soups of triangles in space, most of whose edges are open. Points on the surface are not told.
enum class SideBy : std::uint8_t { crossings, parity, pseudonormal, expansion };
inline constexpr std::string_view side_by_names[] = {"crossings", "parity", "pseudonormal", "expansion"};

struct SolidOptions {
    SideBy by = SideBy::crossings;
    /// How far winding numbers by expansion may be off, from 1e-9 to 1.
    double error = 1e-3;
};

/// A distance to a surface: negative inside, +0 on the surface.
template <std::floating_point T, int D>
struct SignedDistance {
    T distance = std::numeric_limits<T>::infinity();
    Side side = Side::outside;
    SideBy by = SideBy::crossings;
    Near<T, D> near;

    /// False for a point that is not finite, and where there is no surface: infinitely far outside.
    explicit operator bool() const { return static_cast<bool>(near); }
    friend bool operator==(const SignedDistance&, const SignedDistance&) = default;
};

namespace detail {
template <class I>
void expect_all_held(const I& index) {
    const std::size_t count = held_count(index.structure(), index.size());
    if (count < index.size())
        throw InputError("a solid is made of all primitives of a set, but the index holds " +
                         std::to_string(count) + " of " + std::to_string(index.size()) +
                         ": build an index of those that it is to have");
}
inline void expect_possible_error(double error) {
    if (!(error >= 1e-9 && error <= 1))
        throw UsageError("winding numbers can be promised to be within an error of 1e-9 to 1, not " +
                         std::to_string(error));
}

struct NoExpansion {
    static std::size_t bytes() { return 0; }
};
template <class I>
using ExpansionOf = typename std::conditional_t<
    I::dimension == 3, std::type_identity<ExpandedIndex<I, WindingTriangles<typename I::Primitives>>>,
    std::type_identity<NoExpansion>>::type;

/// In the plane, ends are as quick to look at as caps.
struct NoCaps {
    static std::size_t bytes() { return 0; }
};
template <class I>
using CapsOf = typename std::conditional_t<I::dimension == 3, std::type_identity<Caps<typename I::Scalar>>,
                                           std::type_identity<NoCaps>>::type;
}  // namespace detail

/// An index as the surface of a solid: of triangles in space, counterclockwise seen from outside, or of
/// segments in the plane, which go around it counterclockwise. Made once, in O(n); its questions are
/// thread-safe and allocate nothing, but for memory that threads keep. The index must outlive it, and must
/// hold every primitive of its set. Vertices are joined by position.
///
/// *Winding number.* How often the surface winds around a point: 1 in a solid, 0 outside, −1 in one turned
/// inside out, a sum where parts overlap, and a fraction where the surface is open. It is the sum of signed
/// crossings of a ray along an axis, by exact signs, and for the edges left open the solid angle towards
/// infinity of what would close them (Jacobson, Kavan and Sorkine-Hornung 2013 define it; Martens and
/// Bessmeltsev 2025 reduce it to a ray and the boundary). A whole number for closed and oriented surfaces;
/// otherwise it errs by some roundings of double. It does not depend on the structure of the index.
///
/// *Side.* `on` is exact: the point lies in a primitive, edges and corners included. Else a point is inside
/// of a closed surface if the winding number is not 0, and inside of an open one if that is at least one
/// half. Where triangles are turned so that edges are open although each has two triangles, the surface
/// counts as open.
///
/// A point that is not finite is outside, with the winding number NaN and an infinite distance.
template <class I>
class Solid {
public:
    using Scalar = typename I::Scalar;
    static constexpr int dimension = I::dimension;
    using Point = Vec<Scalar, dimension>;
    using Points = PointBatch<Scalar, dimension>;
    using Distance = SignedDistance<Scalar, dimension>;
    static_assert(FacetSet<typename I::Primitives>,
                  "a solid is made of triangles in space or of segments in the plane");

    /// Throws InputError if the index lacks primitives of its set, and UsageError for an error that cannot be
    /// promised and for expansions in the plane.
    explicit Solid(const I& index, const SolidOptions& options = {}, Threads threads = {})
        : index_(&index), options_(options) {
        expect_possible(options);
        in_ieee_mode([&] {
            detail::expect_all_held(index);
            IeeeExecutor executor(threads.over(index.size()));
            for (std::size_t i = 0; i < index.size(); ++i) bounds_.expand(index.primitives().bounds(i));
            boundary_ = boundary_of(index.primitives(), executor);
            closing_ = closing_of(boundary_);
            if constexpr (dimension == 3)
                if (!closing_.empty() && closing_.edges() <= index.size() / few_open)
                    caps_ = detail::Caps<Scalar>(closing_, executor);
            if (by_near()) pseudonormals_ = Pseudonormals<Scalar, dimension>(index.primitives(), executor);
            if constexpr (dimension == 3)
                if (by() == SideBy::expansion)
                    expansion_.emplace(
                        index, [this](double scale) { return parts(scale); }, executor);
        });
    }
    explicit Solid(I&&, const SolidOptions& = {}, Threads = {}) = delete;

    /// Whether each edge has an even number of triangles.
    bool closed() const { return boundary_.closed(); }
    /// Whether neighbours are turned the same way.
    bool oriented() const { return boundary_.oriented(); }
    /// The edges (in the plane: ends) that are left open, and counts of others that are odd.
    const Boundary<Scalar, dimension>& boundary() const { return boundary_; }
    SideBy by() const { return options_.by; }
    const SolidOptions& options() const { return options_; }
    const I& index() const { return *index_; }
    std::size_t bytes_of_index() const { return index_->bytes(); }
    /// Bytes beyond the index.
    std::size_t bytes() const {
        return boundary_.open.capacity() * sizeof(boundary_.open[0]) + closing_.bytes() + caps_.bytes() +
               pseudonormals_.bytes() + (expansion_ ? expansion_->bytes() : 0);
    }

    // What the functions below ask.

    template <class Count>
    Side tell_side(const Point& point, Count& count) const {
        if (!finite(point)) return Side::outside;
        if (by_near()) return tell_distance(point, count).side;
        return in_ieee_mode([&] { return side_by_number(point, count); });
    }
    template <class Count>
    double tell_winding_number(const Point& point, Count& count) const {
        if (!finite(point)) return std::numeric_limits<double>::quiet_NaN();
        return in_ieee_mode([&] {
            if constexpr (dimension == 3)
                if (by() == SideBy::expansion)
                    return expansion_->winding_number(parts(expansion_->scale()), Vec3d(point),
                                                      options_.error, count);
            if (plainly_outside(point)) return 0.0;
            const Ray asked = soonest_out(point, bounds_);
            return number_of(asked, crossings(*index_, asked, true, count));
        });
    }
    template <class Count>
    Distance tell_distance(const Point& point, Count& count) const {
        if (!finite(point)) return Distance{.by = by(), .near = {}};
        const auto near = closest_point(*index_, point, PointOptions(), KeepAll(), count);
        return in_ieee_mode([&] {
            return with_side(near,
                             by_near() ? side_beside(near, point, count) : side_by_number(point, count));
        });
    }

    /// The box around all primitives.
    const Box<Scalar, dimension>& bounds() const { return bounds_; }
    /// Write the answer to point number n to place n. Rays and closest points are asked some at a time.
    void write_sides(const Points& points, std::span<Side> sides) const {
        if (by_near() || by() == SideBy::expansion) {
            for (std::size_t i = 0; i < points.size(); ++i)
                sides[points.number(i)] = tell_side(points[i], no_visits);
            return;
        }
        for_each_crossed(points, false, [&](std::size_t i, const Ray& asked, const CrossingCount& found) {
            sides[points.number(i)] = finite(points[i]) ? side_of(asked, found, no_visits) : Side::outside;
        });
    }
    void write_winding_numbers(const Points& points, std::span<double> numbers) const {
        if (by() == SideBy::expansion) {
            for (std::size_t i = 0; i < points.size(); ++i)
                numbers[points.number(i)] = tell_winding_number(points[i], no_visits);
            return;
        }
        for_each_crossed(points, true, [&](std::size_t i, const Ray& asked, const CrossingCount& found) {
            numbers[points.number(i)] =
                finite(points[i]) ? number_of(asked, found) : std::numeric_limits<double>::quiet_NaN();
        });
    }
    void write_distances(const Points& points, std::span<Scalar> distances) const {
        std::array<Point, at_once> some;
        std::array<Near<Scalar, dimension>, at_once> near;
        std::array<Side, at_once> sides;
        for (std::size_t begin = 0; begin < points.size(); begin += at_once) {
            const std::size_t count = std::min(at_once, points.size() - begin);
            for (std::size_t k = 0; k < count; ++k) some[k] = points[begin + k];
            const std::span<const Point> asked(some.data(), count);
            closest_points(*index_, asked, near, {.threads = serial_executor()});
            if (by_near()) {
                for (std::size_t k = 0; k < count; ++k)
                    if (near[k]) pseudonormals_.prefetch(near[k].element);
                for (std::size_t k = 0; k < count; ++k) sides[k] = side_beside(near[k], some[k], no_visits);
            } else {
                write_sides(Points(asked), sides);
            }
            for (std::size_t k = 0; k < count; ++k)
                distances[points.number(begin + k)] = finite(some[k])
                                                          ? with_side(near[k], sides[k]).distance
                                                          : std::numeric_limits<Scalar>::infinity();
        }
    }

private:
    using Ray = RayInBounds<Scalar, dimension>;
    template <class J>
    using Crossed = SignedCrossings<typename J::Primitives>;
    static constexpr std::size_t at_once = 128;
    /// Caps are made where less than one in so many edges is open: they cost as much as triangles do.
    static constexpr std::size_t few_open = 8;
    using Closing = std::conditional_t<dimension == 3, BoundingLoops, OpenEnds>;
    using Expanded = detail::ExpansionOf<I>;

    static Closing closing_of(const Boundary<Scalar, dimension>& boundary) {
        if constexpr (dimension == 3) {
            std::vector<std::array<Vec3d, 2>> edges;
            for (const auto& f : boundary.open)
                edges.insert(edges.end(), static_cast<std::size_t>(f.times),
                             {Vec3d(f.corners[0]), Vec3d(f.corners[1])});
            return BoundingLoops(std::move(edges));
        } else {
            std::vector<OpenEnds::End> ends;
            for (const auto& f : boundary.open) ends.push_back({Vec2d(f.corners[0]), f.times});
            return OpenEnds(std::move(ends));
        }
    }

    /// What a ray crosses of an index, of the surface or of caps. From beyond the bounds it leads away.
    template <class J, class Count>
    static CrossingCount crossings(const J& index, const Ray& asked, bool past_surface, Count& count) {
        if (asked.box.empty()) return {};
        if constexpr (AnswersOne<EngineFor<Crossed<J>, J>, const Ray, const bool> &&
                      std::same_as<Count, const NoVisits>)
            if (const EngineFor<Crossed<J>, J> engine(index); engine)
                return engine.answer(asked, past_surface);
        Crossed<J> query(index, asked, past_surface);
        walk_through(index.structure(), detail::CrossedLeaves<J>(index), query, count);
        return query.answer();
    }
    /// Whether a point is outside without a look at the index.
    bool plainly_outside(const Point& p) const { return closing_.empty() && !bounds_.contains(p); }
    /// Calls answer(i, ray, crossings) for each point i of a batch.
    template <class Answer>
    void for_each_crossed(const Points& points, bool past_surface, Answer answer) const {
        std::array<Ray, at_once> rays;
        std::array<std::size_t, at_once> places;
        std::array<CrossingCount, at_once> found;
        for (std::size_t begin = 0, i = 0; begin < points.size(); begin = i) {
            std::size_t count = 0;
            for (; i < points.size() && count < at_once; ++i) {
                const Point p = points[i];
                if (plainly_outside(p)) {
                    answer(i, Ray(), CrossingCount());
                } else {
                    places[count] = i;
                    rays[count++] = soonest_out(p, bounds_);
                }
            }
            in_ieee_mode([&] { find_crossings(std::span(rays).first(count), past_surface, found.data()); });
            for (std::size_t k = 0; k < count; ++k) answer(places[k], rays[k], found[k]);
        }
    }
    void find_crossings(std::span<const Ray> rays, bool past_surface, CrossingCount* found) const {
        if constexpr (requires(const EngineFor<Crossed<I>, I>& engine) {
                          engine.answer_some(rays, past_surface, found);
                      })
            if (const EngineFor<Crossed<I>, I> engine(*index_); engine)
                return engine.answer_some(rays, past_surface, found);
        for (std::size_t i = 0; i < rays.size(); ++i)
            found[i] = crossings(*index_, rays[i], past_surface, no_visits);
    }

    template <class Count>
    Side side_by_number(const Point& p, Count& count) const {
        if (by() == SideBy::expansion)
            return tell_winding_number(p, count) >= 0.5 ? Side::inside : Side::outside;
        if (plainly_outside(p)) return Side::outside;
        const Ray asked = soonest_out(p, bounds_);
        return side_of(asked, crossings(*index_, asked, false, count), count);
    }
    template <class Count>
    Side side_of(const Ray& asked, const CrossingCount& found, Count& count) const {
        if (found.on) return Side::on;
        return is_inside(asked, found, count) ? Side::inside : Side::outside;
    }
    template <class Count>
    bool is_inside(const Ray& asked, const CrossingCount& found, Count& count) const {
        if (by() == SideBy::parity) return found.crossings % 2 != 0;
        if (closing_.empty()) return found.winding != 0;
        if constexpr (dimension == 3)
            if (!caps_.empty()) {
                const auto of_caps = crossings(caps_.index(), asked, false, count);
                const auto share = caps_.share_at(asked.ray.origin);
                const double number = static_cast<double>(found.winding + of_caps.winding) - share.number;
                if (!of_caps.on && std::abs(number - 0.5) > share.error) return number > 0.5;
            }
        return number_of(asked, found) >= 0.5;
    }
    double number_of(const Ray& asked, const CrossingCount& found) const {
        return static_cast<double>(found.winding) + closing_.missing(asked.ray);
    }
    /// Whether the closest point tells the side.
    bool by_near() const { return by() == SideBy::pseudonormal && !closing_.empty(); }
    /// The side by the pseudonormal of the closest point, if all primitives that may be closest agree about
    /// it, since distances are rounded; else the side by number.
    template <class Count>
    Side side_beside(const Near<Scalar, dimension>& near, const Point& p, Count& count) const {
        if (!near) return Side::outside;
        // What distances err by: a share of themselves, and roundings of the longest edge in double.
        constexpr double share = std::is_same_v<Scalar, float> ? 0x1p-20 : 0x1p-40;
        const double distance = std::sqrt(static_cast<double>(near.distance2));
        const double error = 0x1p-44 * max_component(Vec<double, dimension>(bounds_.extent()));
        if (!(distance > 4 * error)) return side_by_number(p, count);
        const double reach = product(distance, 1 + share) + 2 * error;
        const Scratch<std::vector<Near<Scalar, dimension>>> closest;
        within(*index_, p, PointOptions::anywhere, *closest,
               {.radius2 = rounded_up<Scalar>(product(reach, reach))}, KeepAll(), count);
        int side = 0;
        for (const auto& other : *closest) {
            const int of_other = pseudonormals_.side(other.element, p);
            if (of_other == 0 || of_other == -side) return side_by_number(p, count);
            side = of_other;
        }
        return side < 0 ? Side::inside : Side::outside;
    }
    Distance with_side(const Near<Scalar, dimension>& near, Side side) const {
        Distance d{std::sqrt(near.distance2), side, by(), near};
        if (side == Side::on) d.distance = 0;
        if (side == Side::inside && d.distance > 0) d.distance = -d.distance;
        return d;
    }

    auto parts(double scale) const requires(dimension == 3) {
        return WindingTriangles<typename I::Primitives>(index_->primitives(), scale);
    }
    static void expect_possible(const SolidOptions& options) {
        detail::expect_possible_error(options.error);
        if (dimension == 2 && options.by == SideBy::expansion)
            throw UsageError("expansions are of triangles in space: choose crossings for segments");
    }

    const I* index_;
    SolidOptions options_;
    Box<Scalar, dimension> bounds_;
    Boundary<Scalar, dimension> boundary_;
    Closing closing_;
    detail::CapsOf<I> caps_;
    Pseudonormals<Scalar, dimension> pseudonormals_;
    std::optional<Expanded> expansion_;
};

/// By which threads a batch is answered.
struct SideOptions {
    Threads threads = {};
};

/// The side of a surface that a point is on. The surface is a Solid, OrientedPoints or an AnySolid. `count`
/// may be a Visits.
template <class S, class Count = const NoVisits>
Side side(const S& solid, const typename S::Point& point, const SideOptions& = {}, Count& count = no_visits) {
    return solid.tell_side(point, count);
}
/// How often the surface winds around a point. On the surface, that of a point next to it; NaN about a point
/// that is not finite.
template <class S, class Count = const NoVisits>
double winding_number(const S& solid, const typename S::Point& point, const SideOptions& = {},
                      Count& count = no_visits) {
    return solid.tell_winding_number(point, count);
}
/// The distance to the surface of a solid, negative inside, and all that tells it: the side and the closest
/// point. The magnitude is the root of the squared distance of `closest_point`, rounded once, except that it
/// is +0 wherever the side is `on`.
template <class S, class Count = const NoVisits>
SignedDistance<typename S::Scalar, S::dimension> closest_side(const S& solid, const typename S::Point& point,
                                                              const SideOptions& = {},
                                                              Count& count = no_visits) {
    return solid.tell_distance(point, count);
}
/// That distance alone.
template <class S, class Count = const NoVisits>
typename S::Scalar signed_distance(const S& solid, const typename S::Point& point,
                                   const SideOptions& options = {}, Count& count = no_visits) {
    return closest_side(solid, point, options, count).distance;
}

/// The questions of solids, as engines know them (walks/engine.h): EngineFor<Sides, Solid<I>>.
struct Sides;
struct WindingNumbers;
struct SignedDistances;

namespace detail {
/// Answers question Q of each point of a batch: by an engine of the solid, by many(part), or where visits are
/// counted by one(i, count).
template <class Q, class S, class Answer, class Many, class One>
void ask_solid(const S& solid, const Strided<typename S::Point>& points, std::span<Answer> found,
               const SideOptions& options, std::span<Visits> visits, Many many, One one) {
    expect_room("points", points.size(), found.size());
    expect_visits(visits, points.size());
    IeeeExecutor executor(options.threads.over(points.size()));
    const auto rest = [&](std::size_t i) { found[i] = one(points[i], no_visits); };
    if (answered_by_engine<Q>(solid, points, found.data(), AskedBatch{options, keep_all, executor, visits},
                              rest))
        return;
    for_each_part(points, solid.bounds(), solid.bytes_of_index(), executor, [&](const auto& part) {
        if (visits.empty()) return many(part);
        for (std::size_t k = 0; k < part.size(); ++k) {
            const std::size_t i = part.number(k);
            found[i] = one(points[i], visits[i]);
        }
    });
}
}  // namespace detail

/// Writes the side of point i to found[i], as `side` tells it; `winding_numbers` and `signed_distances` write
/// the other answers. Large batches are answered in an order in which neighbours follow each other, for which
/// they take 16 bytes a point.
template <class S>
void sides(const S& solid, const Strided<typename S::Point>& points, std::span<Side> found,
           const SideOptions& options = {}, std::span<Visits> visits = {}) {
    detail::ask_solid<Sides>(
        solid, points, found, options, visits, [&](const auto& part) { solid.write_sides(part, found); },
        [&](const auto& point, auto& count) { return solid.tell_side(point, count); });
}
template <class S>
void winding_numbers(const S& solid, const Strided<typename S::Point>& points, std::span<double> found,
                     const SideOptions& options = {}, std::span<Visits> visits = {}) {
    detail::ask_solid<WindingNumbers>(
        solid, points, found, options, visits,
        [&](const auto& part) { solid.write_winding_numbers(part, found); },
        [&](const auto& point, auto& count) { return solid.tell_winding_number(point, count); });
}
template <class S>
void signed_distances(const S& solid, const Strided<typename S::Point>& points,
                      std::span<typename S::Scalar> found, const SideOptions& options = {},
                      std::span<Visits> visits = {}) {
    detail::ask_solid<SignedDistances>(
        solid, points, found, options, visits, [&](const auto& part) { solid.write_distances(part, found); },
        [&](const auto& point, auto& count) { return solid.tell_distance(point, count).distance; });
}

}  // namespace hedgerow
