/// A solid made of an index of any structure (any_index.h), behind one type.
#pragma once

#include <span>

#include <hedgerow/ask/insides.h>

namespace hedgerow {

/// A Solid whose structure is chosen at run time: the functions of ask/insides.h take it as they take a
/// Solid. Made by AnyIndex, which must outlive it and must not change meanwhile. Const use is thread-safe.
template <std::floating_point T, int D>
class AnySolid {
public:
    using Scalar = T;
    static constexpr int dimension = D;
    using Point = Vec<T, D>;
    using Points = PointBatch<T, D>;

    virtual ~AnySolid() = default;

    virtual bool closed() const = 0;
    virtual bool oriented() const = 0;
    virtual SideBy by() const = 0;
    /// Bytes beyond the index, and those of the index.
    virtual std::size_t bytes() const = 0;
    virtual std::size_t bytes_of_index() const = 0;
    /// The box around all primitives.
    virtual const Box<T, D>& bounds() const = 0;

    // What the functions of ask/insides.h ask.

    virtual Side tell_side(const Point& point, Visits& visits) const = 0;
    virtual double tell_winding_number(const Point& point, Visits& visits) const = 0;
    virtual SignedDistance<T, D> tell_distance(const Point& point, Visits& visits) const = 0;
    Side tell_side(const Point& point, const NoVisits&) const {
        Visits nobodys;
        return tell_side(point, nobodys);
    }
    double tell_winding_number(const Point& point, const NoVisits&) const {
        Visits nobodys;
        return tell_winding_number(point, nobodys);
    }
    SignedDistance<T, D> tell_distance(const Point& point, const NoVisits&) const {
        Visits nobodys;
        return tell_distance(point, nobodys);
    }
    virtual void write_sides(const Points& points, std::span<Side> found) const = 0;
    virtual void write_winding_numbers(const Points& points, std::span<double> found) const = 0;
    virtual void write_distances(const Points& points, std::span<T> found) const = 0;
};

}  // namespace hedgerow
