/// The list of bounding volumes, and one type for any of them.
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <variant>

#include <hedgerow/base/error.h>
#include <hedgerow/structures/bvh/volumes/fit.h>

namespace hedgerow {

/// The kinds of bounding volumes of a BVH's nodes. `box` is the default BVH. kdop6 (in the plane kdop4) is
/// the same box in the study structure, to compare the other kinds with. Hulls and cylinders are for space;
/// kdop4 and kdop8 are for the plane, the other k-DOPs for space.
enum class Volume { box, sphere, obb, kdop4, kdop6, kdop8, kdop14, kdop18, kdop26, cylinder, hull };
inline constexpr std::string_view volume_names[] = {
    "box", "sphere", "obb", "kdop4", "kdop6", "kdop8", "kdop14", "kdop18", "kdop26", "cylinder", "hull"};
constexpr std::string_view name_of(Volume volume) {
    return volume_names[static_cast<std::size_t>(volume)];
}

/// The volumes of a tree, all of one kind, which is `kind`.
template <class V, int D, Volume of_kind>
class VolumeList {
public:
    static constexpr Volume kind = of_kind;

    std::size_t bytes() const { return volumes_.capacity() * sizeof(V); }
    V operator[](std::size_t i) const { return volumes_[i]; }
    void resize(std::size_t size) { volumes_.resize(size); }
    void fit(std::size_t i, PointSpan<D> points, double margin) {
        volumes_[i] = VolumeFit<V>::around(points, margin);
    }

private:
    std::vector<V> volumes_;
};

/// The hulls of a tree. The faces of a hull are a stretch of one common list.
template <class T>
class HullList {
public:
    static constexpr Volume kind = Volume::hull;

    std::size_t bytes() const {
        return faces_.capacity() * sizeof(HalfSpace<T>) + stretches_.capacity() * sizeof(Stretch);
    }
    Hull<T> operator[](std::size_t i) const {
        return {std::span(faces_).subspan(stretches_[i].first, stretches_[i].count)};
    }
    void resize(std::size_t size) { stretches_.resize(size); }
    void fit(std::size_t i, PointSpan<3> points, double margin) {
        const std::size_t first = faces_.size();
        HullFit<T>::add_faces(points, margin, faces_);
        stretches_[i] = {static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(faces_.size() - first)};
    }

private:
    struct Stretch {
        std::uint32_t first, count;
    };
    std::vector<HalfSpace<T>> faces_;
    std::vector<Stretch> stretches_;
};

namespace detail {
template <std::floating_point T, int D>
struct VolumeLists;
template <std::floating_point T>
struct VolumeLists<T, 2> {
    using Variant =
        std::variant<VolumeList<Sphere<T, 2>, 2, Volume::sphere>, VolumeList<Obb<T, 2>, 2, Volume::obb>,
                     VolumeList<Kdop<T, 2, 4>, 2, Volume::kdop4>,
                     VolumeList<Kdop<T, 2, 8>, 2, Volume::kdop8>>;
};
template <std::floating_point T>
struct VolumeLists<T, 3> {
    using Variant = std::variant<
        VolumeList<Sphere<T, 3>, 3, Volume::sphere>, VolumeList<Obb<T, 3>, 3, Volume::obb>,
        VolumeList<Kdop<T, 3, 6>, 3, Volume::kdop6>, VolumeList<Kdop<T, 3, 14>, 3, Volume::kdop14>,
        VolumeList<Kdop<T, 3, 18>, 3, Volume::kdop18>, VolumeList<Kdop<T, 3, 26>, 3, Volume::kdop26>,
        VolumeList<Cylinder<T>, 3, Volume::cylinder>, HullList<T>>;
};
}  // namespace detail

/// The volumes of a tree, all of the kind that was chosen at run time.
template <std::floating_point T, int D>
using AnyVolumeList = typename detail::VolumeLists<T, D>::Variant;

/// An empty list for volumes of that kind. Throws UsageError for a kind that has no list: for boxes, and for
/// kinds of another dimension.
template <std::floating_point T, int D>
AnyVolumeList<T, D> list_of(Volume kind) {
    AnyVolumeList<T, D> lists;
    std::string there_are;
    bool found = false;
    // Collect the names of all kinds of this dimension, and make the list of the kind asked for.
    const auto look = [&]<class List>(std::type_identity<List>) {
        there_are += (there_are.empty() ? "" : ", ") + std::string(name_of(List::kind));
        if (List::kind == kind) lists.template emplace<List>(), found = true;
    };
    [&]<class... List>(std::type_identity<std::variant<List...>>) {
        (look(std::type_identity<List>()), ...);
    }(std::type_identity<AnyVolumeList<T, D>>());
    // Name the wrong kind and the right ones.
    if (!found)
        throw UsageError("in " + std::string(D == 3 ? "space" : "the plane") + " no nodes are bounded by '" +
                         std::string(name_of(kind)) + "' volumes: use one of " + there_are);
    return lists;
}

/// Volume i of a list. Every test branches on the kind of volume. A processor predicts that jump, since the
/// kind is the same throughout a tree.
template <std::floating_point T, int D>
struct AnyVolume {
    const AnyVolumeList<T, D>& list;
    std::size_t i;

    // Not inlined: the functions depend on neither query nor primitives, so each is compiled only once.
    [[gnu::noinline]] friend Interval<double> part_in(const ThickLine<D>& line, const AnyVolume& v) {
        return v.visit([&](const auto& volume) { return part_in(line, volume); });
    }
    [[gnu::noinline]] friend double least_distance2(const Vec<double, D>& p, const AnyVolume& v) {
        return v.visit([&](const auto& volume) { return least_distance2(p, volume); });
    }
    [[gnu::noinline]] friend bool may_overlap(const Box<double, D>& box, const AnyVolume& v) {
        return v.visit([&](const auto& volume) { return may_overlap(box, volume); });
    }
    [[gnu::noinline]] friend Box<double, D> box_around(const AnyVolume& v) {
        return v.visit([](const auto& volume) { return box_around(volume); });
    }
    template <Region R>
    friend bool may_meet(const R& region, const AnyVolume& v) {
        return v.visit([&](const auto& volume) { return hedgerow::may_meet(region, volume); });
    }

    template <class F>
    auto visit(F f) const {
        return std::visit([&](const auto& volumes) { return f(volumes[i]); }, list);
    }
};

}  // namespace hedgerow
