/// A family of rays as a probe: all that the rays of a beam or of a cone may meet.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/volumes.h>
#include <hedgerow/probes/ray.h>

namespace hedgerow {

/// Rays origin + t·direction whose origins and directions come from two convex sets. Directions are scaled so
/// that t is the depth: the distance along the family's axis, which has length 1.
/// - `axis` is the family's axis, and `depths` the interval of t.
/// - `origins` and `directions` tell how far the two sets reach along a normal.
/// - `slack` is four times the largest e of its rays (see RayProbe), once for the hits; the rest covers rays
///   that are in the family only up to roundings, and the roundings of the probe itself.
/// - `faces` are half-spaces that hold all rays as far as the scene reaches, moved outward by `slack`.
template <class R>
concept RayFamily = requires(const R& rays, const Vec<double, R::dimension>& normal,
                             const Box<typename R::Scalar, R::dimension>& scene, double slack) {
    { rays.axis() } -> std::convertible_to<Vec<double, R::dimension>>;
    { rays.depths() } -> std::same_as<Interval<double>>;
    { rays.origins(normal) } -> std::same_as<Extent>;
    { rays.directions(normal) } -> std::same_as<Extent>;
    { rays.slack(scene) } -> std::same_as<double>;
    { rays.faces(scene, slack) } -> std::same_as<std::array<Slab<R::dimension>, R::face_count>>;
};

/// Enters what any ray of the family may hit, at the least depth at which one may: nothing that a ray hits is
/// passed over. A packet's intervals (Boulos, Wald, Benthin, RT 2008) for convex sets of rays: at depth t the
/// family reaches from origins.low + t·directions.low to origins.high + t·directions.high along a normal, so
/// each side of a slab keeps a half-line of depths. All is computed in double; depths are rounded down to T.
template <RayFamily Rays>
class FamilyProbe {
public:
    using Scalar = typename Rays::Scalar;
    static constexpr int dimension = Rays::dimension;
    using T = Scalar;
    static constexpr int D = dimension;
    /// The depths between which the family may be in a cell.
    using State = Interval<double>;

    /// `scene` contains all primitives.
    FamilyProbe(const Rays& rays, const Box<T, D>& scene) : rays_(rays) {
        if (scene.empty()) return;
        slack_ = rays.slack(scene);
        faces_ = rays.faces(scene, slack_);
        all_ = rays.depths();
        all_.exit = std::min(all_.exit, std::numeric_limits<double>::max());
        for (int k = 0; k < D; ++k) {
            Vec<double, D> axis;
            axis[k] = 1;
            axes_[k] = along(axis);
        }
    }

    const Rays& rays() const { return rays_; }
    /// What the family is wider by on every side.
    double slack() const { return slack_; }

    template <class U>
    bool enter(const Box<U, D>& box, T limit, T& at) const {
        const State in = inside(detail::in_double(box));
        at = depth_of(in);
        return in.entry <= in.exit && at <= limit;
    }
    /// Tests any other volume (geometry/volumes.h) by the box around it and by its own slabs.
    template <class Volume>
    requires requires(const Volume& v) { box_around(v); }
    bool enter(const Volume& volume, T limit, T& at) const {
        State in = inside(box_around(volume));
        if constexpr (SlabVolume<Volume>)
            for (int i = 0; i < volume.slab_count(); ++i) clip(in, volume.slab(i));
        else if constexpr (requires { volume.ends(); })
            clip(in, volume.ends());
        at = depth_of(in);
        return in.entry <= in.exit && at <= limit;
    }
    template <class Pack>
    requires(Pack::width > 0) unsigned enter(const Pack& pack, T limit, T* at) const {
        return enter_each(*this, pack, limit, at);
    }

    State root(const Box<T, D>& box) const { return inside(detail::in_double(box)); }
    bool within(const State& s, T limit) const { return s.entry <= s.exit && depth_of(s) <= limit; }
    Cut<State> cut(const State& s, const AxisPlane<T>& plane, T limit) const {
        const auto position = static_cast<double>(plane.position);
        return sides(s, axes_[plane.axis], position, position, limit);
    }
    /// Cuts by any plane, which is as thick as its margin.
    Cut<State> cut(const State& s, const CutPlane<D>& plane, T limit) const {
        const double thickness = plane.margin + product(8 * unit_roundoff<double>, std::abs(plane.offset));
        return sides(s, along(plane.normal), plane.offset + thickness, plane.offset - thickness, limit);
    }

    /// Visits the cells that the family may reach, in layers across the axis along which it moves fastest, in
    /// the order in which it meets them. Ends where a layer begins beyond the limit.
    template <std::derived_from<Lattice<D>> Cells, class Limit, class Visit>
    void sweep(const Cells& lattice, Limit limit, Visit visit) const {
        using Cell = typename Lattice<D>::Cell;
        std::size_t skipped = 0;
        const auto may_skip = [&] {
            if constexpr (requires { lattice.most_skipped; }) return skipped++ < lattice.most_skipped;
            return true;
        };
        Cell first{}, last{};
        for (std::size_t k = 0; k < D; ++k) last[k] = lattice.resolution[k] - 1;
        const Box<double, D> ends{padded(lattice, first).low, padded(lattice, last).high};
        const State whole = inside(ends);
        if (!(whole.entry <= whole.exit)) return;
        // The layers, each with a place and a direction in which they are passed.
        const Vec<double, D> forward = rays_.axis();
        const int main = max_axis(forward);
        const auto m = static_cast<std::size_t>(main);
        const bool down = forward[main] < 0;
        reached(lattice, whole, first, last);
        const Cell low = first, high = last;
        for (std::int32_t i = 0; i <= high[m] - low[m]; ++i) {
            const std::int32_t layer = down ? high[m] - i : low[m] + i;
            State in = whole;
            clip(in, axes_[main], lattice.plane(layer, main) - lattice.pad[main],
                 lattice.plane(layer + 1, main) + lattice.pad[main]);
            if (!within(in, limit()) && may_skip()) {
                if (in.entry <= in.exit && monotone(main)) return;  // so are all later layers
                continue;
            }
            first = low, last = high;
            if (in.entry <= in.exit) reached(lattice, in, first, last);
            first[m] = last[m] = layer;
            const bool go_on = for_each_cell(first, last, [&](const Cell& cell) {
                if (!within(inside(padded(lattice, cell)), limit()) && may_skip()) return true;
                return visit(cell).flow == Flow::go_on;
            });
            if (!go_on) return;
        }
    }

    /// How far origins and directions reach along a normal. Origins are moved outward by the slack.
    struct Along {
        Extent origin, direction;
    };
    const Along& along_axis(int k) const { return axes_[k]; }

private:
    Along along(const Vec<double, D>& normal) const {
        Along a{rays_.origins(normal), rays_.directions(normal)};
        const double wider = product(slack_, dot(abs(normal), Vec<double, D>::all(1)));
        a.origin.low -= wider, a.origin.high += wider;
        return a;
    }
    /// Keeps the depths t with speed·t >= height.
    static void keep_above(State& in, double speed, double height) {
        if (speed > 0)
            in.entry = std::max(in.entry, height / speed);
        else if (speed < 0)
            in.exit = std::min(in.exit, height / speed);
        else if (height > 0)
            in.exit = -1;
    }
    /// Keeps the depths at which the family reaches above `low`, or below `high`.
    static void keep_above_low(State& in, const Along& a, double low) {
        keep_above(in, a.direction.high, low - a.origin.high);
    }
    static void keep_below_high(State& in, const Along& a, double high) {
        keep_above(in, -a.direction.low, a.origin.low - high);
    }
    static void clip(State& in, const Along& a, double low, double high) {
        keep_above_low(in, a, low), keep_below_high(in, a, high);
    }
    void clip(State& in, const Slab<D>& slab) const { clip(in, along(slab.normal), slab.low, slab.high); }
    /// The depths at which the family may be in a box. Empty, too, if a face excludes the box.
    State inside(const Box<double, D>& box) const {
        State in = all_;
        for (int k = 0; k < D; ++k) clip(in, axes_[k], box.low[k], box.high[k]);
        if (!(in.entry <= in.exit)) return in;
        for (const Slab<D>& face : faces_)
            if (detail::beside(box, face)) in.exit = -1;
        return in;
    }
    /// The entry, lowered by more than it errs by.
    static T depth_of(const State& s) {
        const double most = static_cast<double>(std::numeric_limits<T>::max());
        const double least = std::min(s.entry, most) * (1 - 64 * unit_roundoff<T>);
        return std::max(T(0), rounded_down<T>(least) - 4 * std::numeric_limits<T>::denorm_min());
    }

    Cut<State> sides(const State& s, const Along& a, double low_ends, double high_begins, T limit) const {
        State low = s, high = s;
        keep_below_high(low, a, low_ends), keep_above_low(high, a, high_begins);
        // The near side is where the family comes from, or where it begins if it goes both ways.
        const bool goes_down = a.direction.high <= 0, goes_both = !goes_down && a.direction.low < 0;
        const bool near_is_high = goes_down || (goes_both && a.origin.low + a.origin.high > 2 * low_ends);
        if (near_is_high) std::swap(low, high);
        return {near_is_high, low, high, within(low, limit), within(high, limit)};
    }

    /// Whether all rays go the same way along an axis.
    bool monotone(int axis) const { return axes_[axis].direction.low > 0 || axes_[axis].direction.high < 0; }
    static Box<double, D> padded(const Lattice<D>& lattice, const typename Lattice<D>::Cell& cell) {
        const Box<double, D> box = lattice.bounds(cell);
        return {box.low - lattice.pad, box.high + lattice.pad};
    }
    /// The block of cells that the family may reach between two depths.
    void reached(const Lattice<D>& lattice, const State& in, typename Lattice<D>::Cell& first,
                 typename Lattice<D>::Cell& last) const {
        for (int k = 0; k < D; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const auto [origin, direction] = axes_[k];
            const double low =
                origin.low + std::min(product(in.entry, direction.low), product(in.exit, direction.low));
            const double high =
                origin.high + std::max(product(in.entry, direction.high), product(in.exit, direction.high));
            first[i] = lattice.coordinate(low - 2 * lattice.pad[k], k);
            last[i] = lattice.coordinate(high + 2 * lattice.pad[k], k);
        }
    }

    Rays rays_;
    double slack_ = 0;
    State all_{1, -1};  // empty without a scene
    Along axes_[D];
    std::array<Slab<D>, Rays::face_count> faces_{};
};

}  // namespace hedgerow
