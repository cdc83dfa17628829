/// A region as a probe. It enters every volume that it may overlap, in no particular order.
#pragma once

#include <concepts>

#include <hedgerow/geometry/box_rows.h>
#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/region.h>
#include <hedgerow/geometry/slab.h>
#include <hedgerow/probes/point.h>

namespace hedgerow {

/// Which primitives a query of a region finds: those that have a point in it, or those that lie in it wholly.
enum class Finds : bool { overlapping, contained };

/// Walks see no shape: they enter what the region's `containment` does not call outside. In a tree of planes
/// the state is the cell that the cuts have left. A box needs no cell, since cuts across the axes compare its
/// own sides.
///
/// The test of a primitive may err relative to the primitive's size, which can be that of the whole scene,
/// however small the cell is where it meets the region. So cells are enlarged by a margin: 2^-34 of the
/// scene's largest coordinate, which is more than any of the tests err by. Boxes around primitives need none.
template <Region R>
class RegionProbe {
public:
    using Scalar = typename R::Scalar;
    static constexpr int dimension = R::dimension;
    using T = Scalar;
    static constexpr int D = dimension;
    static constexpr bool is_box = std::same_as<R, Box<T, D>>;
    struct Cell {
        Box<T, D> cell;
        bool here;
    };
    struct Here {
        bool here;
    };
    using State = std::conditional_t<is_box, Here, Cell>;

    /// `scene` contains all primitives.
    RegionProbe(const R& region, const Box<T, D>& scene, Finds finds = Finds::overlapping)
        : region_(region), finds_(finds) {
        const T largest = std::max(max_component(abs(scene.low)), max_component(abs(scene.high)));
        if (!is_box && !scene.empty())
            margin_ = product(T(scene_margin), largest) + 4 * std::numeric_limits<T>::denorm_min();
    }
    /// The tests of boxes are exact, and need no margin.
    explicit RegionProbe(const R& region, Finds finds = Finds::overlapping) requires is_box : region_(region),
                                                                                              finds_(finds) {}
    const R& region() const { return region_; }
    Finds finds() const { return finds_; }
    const R& box() const requires is_box { return region_; }

    template <class U>
    bool enter(const Box<U, D>& box, T, T& at) const {
        at = T(0);
        return meets(box);
    }
    /// Tests four boxes at a time, in T, if the region is a box, a ball or between planes.
    unsigned enter(const BoxRows<T, D>& boxes, T limit, T* at) const {
        using L = Lanes<T>;
        if constexpr (is_box) {
            return boxes.by_fours([&](int k) {
                unsigned overlapping = 15;
                for (int i = 0; i < D; ++i)
                    overlapping &= less_equal(L::load(boxes.low(i) + k), L::all(region_.high[i])) &
                                   less_equal(L::all(region_.low[i]), L::load(boxes.high(i) + k));
                L::all(T(0)).store(at + k);
                return overlapping;
            });
        } else if constexpr (std::same_as<R, Sphere<T, D>>) {
            const T radius2 = product(region_.radius, region_.radius);
            const unsigned entered = PointProbe<T, D>(region_.center).enter(boxes, enlarged(radius2), at);
            std::fill_n(at, BoxRows<T, D>::width, T(0));
            return entered;
        } else if constexpr (SlabVolume<R>) {
            std::fill_n(at, BoxRows<T, D>::width, T(0));
            unsigned among = (1u << boxes.size()) - 1;
            for (int i = 0; i < region_.slab_count() && among != 0; ++i) {
                const Slab<D> s = region_.slab(i);
                among &= ~beyond(boxes, s.normal, s.high) & ~beyond(boxes, -s.normal, -s.low);
            }
            return among;
        } else {
            return enter_each(*this, boxes, limit, at);
        }
    }
    /// Tests any other volume (geometry/volumes.h).
    template <class Volume>
    requires requires(const Volume& v) { box_around(v); }
    bool enter(const Volume& volume, T, T& at) const {
        at = T(0);
        if constexpr (is_box)
            return may_overlap(detail::in_double(region_), volume);
        else
            return may_meet(region_, volume);
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }

    State root(const Box<T, D>& box) const {
        if constexpr (is_box)
            return {meets(box)};
        else
            return {box, meets(box)};
    }
    bool within(const State& s, T) const { return s.here; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T) const {
        if constexpr (is_box) {
            return {false, s, s, region_.low[plane.axis] <= plane.position,
                    region_.high[plane.axis] >= plane.position};
        } else {
            Cut<State> sides{false, s, s, false, false};
            sides.near.cell.high[plane.axis] = sum_rounded_up(plane.position, margin_);
            sides.far.cell.low[plane.axis] = -sum_rounded_up(-plane.position, margin_);
            sides.to_near = meets(sides.near.cell), sides.to_far = meets(sides.far.cell);
            return sides;
        }
    }
    /// Cuts by any plane: compares the heights of the region and of the cell, if there is one. An unbounded
    /// region is on both sides.
    Cut<State> cut(const State& s, const CutPlane<D>& plane, T) const {
        const double tolerance = plane.margin + product(plane.reach(), static_cast<double>(margin_)) +
                                 product(8 * unit_roundoff<double>, std::abs(plane.offset));
        const double low = plane.offset + tolerance, high = plane.offset - tolerance;
        const Extent region = extent(region_, plane.normal);
        Cut<State> sides{false, s, s, !(region.low > low), !(region.high < high)};
        if constexpr (!is_box) {
            const Extent cell = extent(s.cell, plane.normal);
            sides.to_near = sides.to_near && !(cell.low > low);
            sides.to_far = sides.to_far && !(cell.high < high);
        }
        return sides;
    }

    /// Visits the cells of the lattice that the region may overlap, each enlarged by its pad.
    template <std::derived_from<Lattice<D>> Cells, class Limit, class Visit>
    void sweep(const Cells& lattice, Limit, Visit visit) const {
        const auto margin = static_cast<double>(margin_);
        const Vec<double, D> pad = lattice.pad + Vec<double, D>::all(margin);
        typename Lattice<D>::Cell first{}, last{};
        for (std::size_t a = 0; a < D; ++a) last[a] = lattice.resolution[a] - 1;
        Box<double, D> whole{lattice.bounds(first).low - pad, lattice.bounds(last).high + pad};
        whole = bounds_in(region_, whole, margin);
        if (whole.empty()) return;
        for (int a = 0; a < D; ++a) {
            const auto i = static_cast<std::size_t>(a);
            first[i] = lattice.coordinate(whole.low[a], a), last[i] = lattice.coordinate(whole.high[a], a);
        }
        const auto reaches = [&](const auto& cell) {
            if constexpr (is_box) return true;
            Box<double, D> box = lattice.bounds(cell);
            box.low = box.low - pad, box.high = box.high + pad;
            return meets(box);
        };
        for_each_reached_cell(lattice, first, last, reaches,
                              [&](const auto& cell) { return visit(cell).flow == Flow::go_on; });
    }

    /// Whether primitive i of a set is found. Sets that cannot tell what lies in a region find nothing there.
    template <class P>
    bool takes(const P& set, std::size_t i) const {
        if (finds_ == Finds::overlapping) return set.overlaps(i, region_);
        if constexpr (requires { set.lies_within(i, region_); })
            return set.lies_within(i, region_);
        else
            return false;
    }

private:
    /// A little more than x >= 0: more than sums of squares and products of T err by.
    static T enlarged(T x) { return x + product(x, error) + 16 * std::numeric_limits<T>::denorm_min(); }
    static constexpr T error = std::is_same_v<T, float> ? T(0x1p-18) : T(0x1p-44);

    /// The boxes, as bits, that are surely beyond the plane normal·x = offset. No box is if numbers overflow.
    static unsigned beyond(const BoxRows<T, D>& boxes, const Vec<double, D>& normal, double offset) {
        using L = Lanes<T>;
        const T limit = static_cast<T>(offset), most = limit + enlarged(std::abs(limit)) - std::abs(limit);
        if (!(most < std::numeric_limits<T>::infinity())) return 0;
        return boxes.by_fours([&](int k) {
            L low = L::all(T(0)), size = L::all(T(0));
            for (int i = 0; i < D; ++i) {
                const L n = L::all(static_cast<T>(normal[i]));
                const L a = n * L::load(boxes.low(i) + k), b = n * L::load(boxes.high(i) + k);
                low = low + min(a, b), size = size + max(abs(a), abs(b));
            }
            return less_equal(L::all(most), low - size * L::all(error));
        });
    }
    template <class U>
    bool meets(const Box<U, D>& box) const {
        return containment(region_, box) != Containment::outside;
    }

    R region_;
    T margin_ = T(0);
    Finds finds_;
};

template <std::floating_point T, int D>
using BoxProbe = RegionProbe<Box<T, D>>;

/// Whether a volume lies in the region, so that all primitives in it do. Of volumes that are no boxes, the
/// box around them decides.
template <Region R, class V>
bool takes_whole(const R& region, const V& volume) {
    if constexpr (requires { region.contains(volume); })
        return region.contains(volume);
    else if constexpr (requires { containment(region, volume); })
        return containment(region, volume) == Containment::inside;
    else
        return containment(region, box_around(volume)) == Containment::inside;
}

}  // namespace hedgerow
