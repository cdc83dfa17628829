/// The cells of a structure, listed one after the other without a query.
#pragma once

#include <span>
#include <tuple>

#include <hedgerow/geometry/lattice.h>
#include <hedgerow/geometry/overlap.h>
#include <hedgerow/geometry/polytope.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/walks/orthants.h>
#include <hedgerow/walks/planes.h>
#include <hedgerow/walks/volumes.h>

namespace hedgerow {

/// A node of a structure and its region, in double. Every cell of a grid is a node, and cells of the first
/// level have no parent.
template <int D>
struct OutlineCell {
    NodeId id = 0, parent = 0;  // a node without a parent has its own id there
    Place place;
    int level = 1;
    bool leaf = false;
    /// The primitives of a leaf, or of an inner node that holds some itself. They point into the structure.
    std::span<const PrimitiveId> items;
    /// The region if it is a box, else a box around it.
    Box<double, D> box;
    /// The region if it is no box, else without faces.
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

/// The cells to list: those of the first `levels` levels that overlap the box `within`.
template <int D>
struct OutlineLimits {
    int levels = std::numeric_limits<int>::max();
    Box<double, D> within{Vec<double, D>::all(-std::numeric_limits<double>::infinity()),
                          Vec<double, D>::all(std::numeric_limits<double>::infinity())};

    bool allow(const OutlineCell<D>& c) const { return c.level <= levels && overlap(c.box, within); }
};

/// A function that is called for each cell. It returns whether the cell's children are wanted too.
template <int D>
using CellVisitor = FunctionRef<bool(const OutlineCell<D>&)>;

template <class S>
inline constexpr int dimension_of =
    std::remove_cvref_t<decltype(std::declval<const S&>().bounds())>::dimension;

/// A grid as outlines see it: the primitives of each cell, or the lattices that divide the cell.
template <class S>
concept LatticeOfCells = requires(const S& s, const typename Lattice<dimension_of<S>>::Cell& cell) {
    { s.empty() } -> std::same_as<bool>;
    { s.lattice() } -> std::convertible_to<const Lattice<dimension_of<S>>&>;
    { s.leaf(cell) } -> std::same_as<Leaf>;
};

/// A structure whose cells are not nested, as outlines see it: each occupied cell with its number, box and
/// items.
template <class S>
concept ListsCells = requires(const S& s) {
    s.for_each_cell([](std::uint32_t, const Box<double, dimension_of<S>>&, const Leaf&) {});
};

namespace detail {

template <class T, int D>
Box<double, D> box_in_double(const Box<T, D>& b) {
    return {Vec<double, D>(b.low), Vec<double, D>(b.high)};
}
/// Sets the region of a cell that a volume bounds. The volume may reach out of the scene, and is cut off at a
/// box three times as wide as the scene.
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

/// Calls f for a cell that the limits allow. Returns whether the cell's children are to be listed.
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

/// The two sides of a cell, cut by a plane. A side thinner than rounding has no shape, only a box around the
/// cell's section.
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

/// Calls f(cell) for the cells of a lattice that overlap a box.
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
        // List the cell of the first level. It is a leaf if no lattice divides it.
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
            // List the cells of the lattices in it.
            grid.for_each_lattice_in(c, [&](const auto& inner, const auto& leaf_of, const auto& place_of) {
                for_each_cell_within(inner, within, [&](const auto& i) {
                    // The top bit separates these ids from those of the first level, which are below 2^30.
                    auto child = cell.child(0x80000000u | place_of(i).first, place_of(i));
                    child.box = inner.bounds(i);
                    child.end_in(leaf_of(i));
                    list(child);
                });
            });
    });
}

}  // namespace detail

/// Calls f(cell) for the cells of a structure that the limits allow, parents before their children. f returns
/// whether the children are wanted too. Ids are those of `fold` (walks/fold.h). O(cells listed). Cells
/// between planes are cut out of their parents, so their corners err by some roundings a level.
template <class S, class F>
void visit_outline(const S& structure, const OutlineLimits<dimension_of<S>>& limits, F f) {
    constexpr int D = dimension_of<S>;
    if constexpr (requires { structure.visit_outline(limits, f); }) return structure.visit_outline(limits, f);
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
    } else if constexpr (ListsCells<S>) {
        structure.for_each_cell([&](std::uint32_t number, const Box<double, D>& box, const Leaf& leaf) {
            OutlineCell<D> cell;
            cell.id = cell.parent = number;
            cell.place = {number};
            cell.box = box;
            cell.end_in(leaf);
            list(cell);
        });
    } else {
        root.leaf = true;
        root.items = structure.items();
        list(root);
    }
}

/// The cells that `visit_outline` visits, in a list.
template <class S>
auto outline(const S& structure, const OutlineLimits<dimension_of<S>>& limits = {}) {
    std::vector<OutlineCell<dimension_of<S>>> cells;
    visit_outline(structure, limits, [&](const auto& cell) { return cells.push_back(cell), true; });
    return cells;
}

}  // namespace hedgerow
