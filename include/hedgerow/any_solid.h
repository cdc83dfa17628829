/// A solid made of an index of any structure (any_index.h), behind one type.
#pragma once

#include <span>

#include <hedgerow/ask/insides.h>

namespace hedgerow {

/// A Solid whose structure is chosen at run time. Answers are those of `Solid` (ask/insides.h). Made by
/// AnyIndex, which must outlive it and must not change meanwhile. Const use is thread-safe.
template <std::floating_point T, int D>
class AnySolid {
public:
    virtual ~AnySolid() = default;

    virtual bool closed() const = 0;
    virtual bool oriented() const = 0;
    virtual SideBy by() const = 0;
    /// Bytes beyond the index.
    virtual std::size_t bytes() const = 0;

    /// Write the answer for each of `points`, in the calling thread. With `visits`, add to one count a point,
    /// and no kernel answers.
    void sides(std::span<const Vec<T, D>> points, std::span<Side> found,
               std::span<Visits> visits = {}) const {
        if (visits.empty()) return sides_uncounted(points, found);
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = side(points[i], visits[i]);
    }
    void winding_numbers(std::span<const Vec<T, D>> points, std::span<double> found,
                         std::span<Visits> visits = {}) const {
        if (visits.empty()) return winding_numbers_uncounted(points, found);
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = winding_number(points[i], visits[i]);
    }
    void signed_distances(std::span<const Vec<T, D>> points, std::span<T> found,
                          std::span<Visits> visits = {}) const {
        if (visits.empty()) return signed_distances_uncounted(points, found);
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = signed_distance(points[i], visits[i]);
    }

protected:
    virtual Side side(const Vec<T, D>& point, Visits& visits) const = 0;
    virtual double winding_number(const Vec<T, D>& point, Visits& visits) const = 0;
    virtual T signed_distance(const Vec<T, D>& point, Visits& visits) const = 0;
    virtual void sides_uncounted(std::span<const Vec<T, D>> points, std::span<Side> found) const {
        Visits nobodys;
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = side(points[i], nobodys);
    }
    virtual void winding_numbers_uncounted(std::span<const Vec<T, D>> points, std::span<double> found) const {
        Visits nobodys;
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = winding_number(points[i], nobodys);
    }
    virtual void signed_distances_uncounted(std::span<const Vec<T, D>> points, std::span<T> found) const {
        Visits nobodys;
        for (std::size_t i = 0; i < points.size(); ++i) found[i] = signed_distance(points[i], nobodys);
    }
};

}  // namespace hedgerow
