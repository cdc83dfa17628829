/// Upper bounds of triangles by the elements that are near (hedgerow/ask/hausdorff/part_bounds.h).
#include <hedgerow/ask/hausdorff/part_bounds.h>

#include <cmath>
#include <limits>

namespace hedgerow::detail {
namespace {

/// A point of a part, and its distances to the elements.
struct Place {
    Vec3d point;
    ToElements to;
};
struct Corners {
    const Place* place[3];
    const Place*& operator[](int k) { return place[k]; }
    const Place* operator[](int k) const { return place[k]; }
};
/// A cut of a part at a point of an edge.
struct Cut {
    std::uint8_t edge = 3;
    double at = 0.5;
    Place place;
    explicit operator bool() const { return edge < 3; }
};

class Bounding {
public:
    Bounding(const NearElements& near, const BoundAim& aim, const ElementKernels& kernels)
        : near_(near), aim_(aim), kernels_(kernels) {}

    /// Of one element, which is convex, a corner of the part is the farthest. Where none is near all corners,
    /// the part is cut, up to `cuts` times. `first_cut` is that of the whole.
    double bound(const Corners& corners, int cuts, Cut& first_cut) const {
        const double least = by_one_element(corners);
        if (least <= aim_.wanted || cuts == 0) return least;
        Cut& cut = first_cut;
        find_cut(corners, cut);
        if (!cut || cut.place.to.least() > aim_.wanted) return least;
        const int from = cut.edge, to = (from + 1) % 3;
        Corners part = corners;
        Cut next;
        part[from] = &cut.place;
        const double of_first = bound(part, cuts - 1, next);
        if (of_first > aim_.wanted) return least;
        part = corners;
        part[to] = &cut.place;
        next.edge = 3;
        return std::min(least, std::max(of_first, bound(part, cuts - 1, next)));
    }

private:
    /// The distance of the farthest corner from the element that is best for that.
    static double by_one_element(const Corners& corners) {
        double farthest[NearElements::most];
        for (int i = 0; i < NearElements::most; ++i)
            farthest[i] = std::max(std::max(corners[0]->to.distance[i], corners[1]->to.distance[i]),
                                   corners[2]->to.distance[i]);
        for (int half = NearElements::most / 2; half > 0; half /= 2)
            for (int i = 0; i < half; ++i) farthest[i] = std::min(farthest[i], farthest[i + half]);
        return farthest[0];
    }
    /// Where to cut an edge whose ends are nearest to two elements: at a point that is about as near to both.
    /// After two cuts, such elements have the parts to themselves if they are in one plane. The edge whose
    /// ends are clearest.
    void find_cut(const Corners& corners, Cut& cut) const {
        double clearest = 0;
        for (int k = 0; k < 3; ++k) {
            const ToElements &here = corners[k]->to, &there = corners[(k + 1) % 3]->to;
            const int i = here.nearest, j = there.nearest;
            const double noise =
                product(here.distance[i] + there.distance[j], aim_.margin.relative) + aim_.margin.absolute;
            const double clear =
                std::min(here.distance[j] - here.distance[i], there.distance[i] - there.distance[j]);
            if (clear <= std::max(noise, clearest)) continue;
            clearest = clear;
            cut.edge = static_cast<std::uint8_t>(k);
        }
        if (cut) find_place(*corners[cut.edge], *corners[(cut.edge + 1) % 3], cut);
    }
    /// Finds the place on an edge by false position (the Illinois rule), as well as the tolerance asks for.
    void find_place(const Place& from, const Place& to, Cut& cut) const {
        const int i = from.to.nearest, j = to.to.nearest;
        const auto ahead_of = [&](const ToElements& x) {
            return straight(x.distance[j]) - straight(x.distance[i]);
        };
        double low = 0, high = 1, here = ahead_of(from.to), there = -ahead_of(to.to);
        for (int tries = 0, side = 0; tries < 5; ++tries) {
            cut.at = low + product(high - low, here / (here + there));
            cut.place.point = from.point + (to.point - from.point) * cut.at;
            kernels_.measure(near_, aim_.margin, &cut.place.point, 1, &cut.place.to);
            const double of_i = cut.place.to.distance[i], of_j = cut.place.to.distance[j];
            if (std::abs(of_j - of_i) <= aim_.slack || std::min(of_i, of_j) > aim_.wanted + aim_.slack) break;
            const double ahead = ahead_of(cut.place.to);
            if (ahead > 0) {
                low = cut.at, here = ahead;
                if (side == 1) there /= 2;
                side = 1;
            } else {
                high = cut.at, there = -ahead;
                if (side == -1) here /= 2;
                side = -1;
            }
        }
    }
    /// What is straight along an edge: the squared distances of points, and the distances of triangles where
    /// these are in one plane.
    double straight(double distance) const { return near_.points ? product(distance, distance) : distance; }

    const NearElements& near_;
    const BoundAim& aim_;
    const ElementKernels& kernels_;
};

constexpr int most_cuts = 6;

}  // namespace

BoundByElements bound_by_elements(const Vec3d (&corner)[3], NearElements& near, const BoundAim& aim) {
    const ElementKernels& kernels = element_kernels();
    kernels.prepare(near);
    Place places[3];
    ToElements to[3];
    kernels.measure(near, aim.margin, corner, 3, to);
    for (int k = 0; k < 3; ++k) places[k] = {corner[k], to[k]};
    Cut cut;
    const double bound =
        Bounding(near, aim, kernels).bound({{&places[0], &places[1], &places[2]}}, most_cuts, cut);
    return {bound, cut.at, cut.edge};
}

}  // namespace hedgerow::detail
