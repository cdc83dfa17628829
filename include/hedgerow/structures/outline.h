/// What a structure looks like: its cells, one after the other, without a question.
#pragma once

#include <span>
#include <tuple>

#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/overlap.h>
#include <hedgerow/geometry/polytope.h>
#include <hedgerow/structures/bvh/volumes/region.h>
#include <hedgerow/structures/walk_orthants.h>
#include <hedgerow/structures/walk_planes.h>
#include <hedgerow/structures/walk_volumes.h>

namespace hedgerow {

/// A node of a structure and the region that it stands for, in double. Of a grid every cell is a node, and
/// those of its first level have no parent.
template <int D>
struct OutlineCell {
    NodeId id = 0, parent = 0;  // its own, if it has no parent
    Place place;
    int level = 1;
    bool leaf = false;
    /// Of a leaf, or of a node that holds something itself: they lie in the structure.
    std::span<const PrimitiveId> items;
    /// The region, or what bounds it.
    Box<double, D> box;
    /// The region where it is no box; else it has no faces.
    Polytope<D> shape;

    Polytope<D> region() const { return shape.empty() ? Polytope<D>(box) : shape; }
    OutlineCell child(NodeId child_id, const Place& child_place) const {
        OutlineCell c;
        c.id = child_id, c.parent = id, c.place = child_place, c.level = level + 1;
        return c;
    }
    void hold(const Leaf& l) {
        if (l.count > 0) items = {l.ids + l.first, l.count};
    }
    void end_in(const Leaf& l) {
        leaf = true;
        hold(l);
    }
};

/// Which cells are listed: those of the first levels that overlap a box.
template <int D>
struct OutlineLimits {
    int levels = std::numeric_limits<int>::max();
    Box<double, D> within{Vec<double, D>::all(-std::numeric_limits<double>::infinity()),
                          Vec<double, D>::all(std::numeric_limits<double>::infinity())};

    bool allow(const OutlineCell<D>& c) const { return c.level <= levels && overlap(c.box, within); }
};

template <class S>
inline constexpr int dimension_of =
    std::remove_cvref_t<decltype(std::declval<const S&>().bounds())>::dimension;

/// What is listed of a grid: what stands in a cell, or the lattice that divides it.
template <class S>
concept LatticeOfCells = requires(const S& s, const typename Lattice<dimension_of<S>>::Cell& cell) {
    { s.empty() } -> std::same_as<bool>;
    { s.lattice() } -> std::convertible_to<const Lattice<dimension_of<S>>&>;
    { s.leaf(cell) } -> std::same_as<Leaf>;
};

namespace detail {

template <class T, int D>
Box<double, D> box_in_double(const Box<T, D>& b) {
    return {Vec<double, D>(b.low), Vec<double, D>(b.high)};
}
/// The region of what is bounded by a volume, in a scene that it may reach out of.
template <class V, class T, int D>
void bound(OutlineCell<D>& cell, const V& volume, const Box<T, D>& scene) {
    const Box<double, D> whole = box_in_double(scene);
    if constexpr (std::same_as<V, Box<T, D>>) {
        cell.box = box_in_double(volume);
    } else {
        cell.shape = region_in(volume, {whole.low - whole.extent(), whole.high + whole.extent()});
        cell.box = cell.shape.empty() ? whole : cell.shape.bounds();
    }
}

/// Lists a cell, if it is wanted, and says whether its children are.
template <int D, class F>
struct Outliner {
    const OutlineLimits<D>& limits;
    F& f;

    bool operator()(const OutlineCell<D>& cell) { return limits.allow(cell) && f(cell) && !cell.leaf; }
};

template <VolumeTree S, int D, class F>
void outline_from(const S& tree, NodeRef node, OutlineCell<D> cell, Outliner<D, F>& list) {
    if (node.leaf()) cell.end_in(tree.leaf(node));
    if (!list(cell)) return;
    for (int i = 0; i < S::width; ++i) {
        const NodeRef below = tree.child(node, i);
        if (below.empty()) continue;
        auto child = cell.child(S::child_id(node, i), below.place());
        bound(child, tree.volumes(node)[i], tree.bounds());
        outline_from(tree, below, std::move(child), list);
    }
}

template <OrthantTree S, class T, int D, class F>
void outline_from(const S& tree, OrthantNode node, const Cube<T, D>& cube, OutlineCell<D> cell,
                  Outliner<D, F>& list) {
    cell.box = box_in_double(cube.box());
    if (!node.inner()) cell.end_in(tree.leaf(node));
    if (!list(cell)) return;
    for (unsigned i = 0; i < 1u << D; ++i) {
        const OrthantNode below = tree.children(node)[i];
        outline_from(tree, below, cube.orthant(i), cell.child(S::child_id(node, i), below.place()), list);
    }
}

/// The two sides of a cell. What is thinner than rounding is flat.
template <class T, int D>
void cut(const OutlineCell<D>& cell, const AxisPlane<T>& plane, OutlineCell<D>& low, OutlineCell<D>& high) {
    low.box = high.box = cell.box;
    low.box.high[plane.axis] = high.box.low[plane.axis] = static_cast<double>(plane.position);
}
template <int D>
void cut(const OutlineCell<D>& cell, const CutPlane<D>& plane, OutlineCell<D>& low, OutlineCell<D>& high) {
    std::tie(low.shape, high.shape) = cell.region().cut(plane);
    for (OutlineCell<D>* side : {&low, &high}) {
        side->box = side->shape.bounds();
        if (!side->shape.empty()) continue;
        for (const auto& p : cell.region().section(plane)) side->box.expand(p);
        if (side->box.empty()) side->box.expand(cell.box.center());
    }
}
template <PlaneTree S, int D, class F>
void outline_from(const S& tree, NodeId node, OutlineCell<D> cell, Outliner<D, F>& list) {
    if (tree.is_leaf(node))
        cell.end_in(tree.leaf(node));
    else if constexpr (HoldsInNodes<S>)
        cell.hold(tree.own(node));
    if (!list(cell)) return;
    auto low = cell.child(tree.low_child(node), Place{tree.low_child(node)});
    auto high = cell.child(tree.high_child(node), Place{tree.high_child(node)});
    cut(cell, tree.plane(node), low, high);
    outline_from(tree, low.id, std::move(low), list);
    outline_from(tree, high.id, std::move(high), list);
}

/// Calls f(cell, its box) for the cells of a lattice that overlap a box.
template <int D, class F>
void for_each_cell_within(const Lattice<D>& lattice, const Box<double, D>& within, F f) {
    typename Lattice<D>::Cell first{}, last{};
    for (int a = 0; a < D; ++a) {
        first[static_cast<std::size_t>(a)] = lattice.coordinate(within.low[a], a);
        last[static_cast<std::size_t>(a)] = lattice.coordinate(within.high[a], a);
    }
    for_each_cell(first, last, [&](const auto& c) { return f(c), true; });
}
template <LatticeOfCells S, int D, class F>
void outline_lattice(const S& grid, const Box<double, D>& within, Outliner<D, F>& list) {
    for_each_cell_within(grid.lattice(), within, [&](const auto& c) {
        OutlineCell<D> cell;
        cell.box = grid.lattice().bounds(c);
        cell.id = cell.parent = grid.lattice().number(c);
        cell.place = {cell.id};
        cell.leaf = true;
        if constexpr (requires { grid.for_each_lattice_in(c, [](auto&&...) {}); })
            grid.for_each_lattice_in(c, [&](auto&&...) { cell.leaf = false; });
        cell.hold(grid.leaf(c));
        if (!list(cell)) return;
        if constexpr (requires { grid.for_each_lattice_in(c, [](auto&&...) {}); })
            grid.for_each_lattice_in(c, [&](const auto& inner, const auto& leaf_of, const auto& place_of) {
                for_each_cell_within(inner, within, [&](const auto& i) {
                    // Cells of the first level have numbers below 2^30.
                    auto child = cell.child(0x80000000u | place_of(i).first, place_of(i));
                    child.box = inner.bounds(i);
                    child.end_in(leaf_of(i));
                    list(child);
                });
            });
    });
}

}  // namespace detail

/// Calls f(cell) for the cells of a structure, parents before their children; f says whether it wants the
/// children too. Ids are those of `fold` (structures/fold.h). O(cells listed); cells between planes are cut
/// out of their parents, so that their corners err by some roundings a level.
template <class S, class F>
void visit_outline(const S& structure, const OutlineLimits<dimension_of<S>>& limits, F f) {
    constexpr int D = dimension_of<S>;
    detail::Outliner<D, F> list{limits, f};
    OutlineCell<D> root;
    root.box = detail::box_in_double(structure.bounds());
    if (root.box.empty()) return;
    if constexpr (VolumeTree<S>) {
        if (structure.root().empty()) return;
        root.place = structure.root().place();
        detail::outline_from(structure, structure.root(), std::move(root), list);
    } else if constexpr (OrthantTree<S>) {
        root.place = structure.root().place();
        detail::outline_from(structure, structure.root(), structure.cell(), std::move(root), list);
    } else if constexpr (PlaneTree<S>) {
        if (!structure.empty()) detail::outline_from(structure, NodeId(0), std::move(root), list);
    } else if constexpr (LatticeOfCells<S>) {
        if (!structure.empty()) detail::outline_lattice(structure, limits.within, list);
    } else {
        root.leaf = true;
        root.items = structure.items();
        list(root);
    }
}

/// The cells in a list.
template <class S>
auto outline(const S& structure, const OutlineLimits<dimension_of<S>>& limits = {}) {
    std::vector<OutlineCell<dimension_of<S>>> cells;
    visit_outline(structure, limits, [&](const auto& cell) { return cells.push_back(cell), true; });
    return cells;
}

}  // namespace hedgerow
