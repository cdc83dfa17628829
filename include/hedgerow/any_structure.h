/// A structure that is chosen at run time, by name and options, over primitives of any type.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <hedgerow/geometry/any_region.h>
#include <hedgerow/primitives/triangle_mesh.h>
#include <hedgerow/queries/any_hit.h>
#include <hedgerow/queries/closest_hit.h>
#include <hedgerow/structures/any_set.h>
#include <hedgerow/structures/references.h>
#include <hedgerow/walks/any_hierarchy.h>
#include <hedgerow/walks/structure.h>
#include <hedgerow/walks/trace_log.h>
#include <hedgerow/walks/virtual_query.h>

namespace hedgerow {

namespace detail {

[[noreturn]] inline void refuse(const std::string& structure, const std::string& wanted,
                                const char* instead = "build it again") {
    throw InputError("structure '" + structure + "' cannot " + wanted + ": " + instead);
}

/// A packed copy of primitives in either order.
template <class P>
class PackedEitherWay {
    template <PackedOrder order>
    using Packed = decltype(std::declval<const P&>().template pack<order>(std::span<const PrimitiveId>(),
                                                                          std::declval<Executor&>()));

public:
    PackedEitherWay() = default;
    PackedEitherWay(const P& set, PackedOrder order, std::span<const PrimitiveId> items, Executor& executor)
        : by_leaves_(order == PackedOrder::of_leaves) {
        if (by_leaves_)
            of_leaves_ = set.template pack<PackedOrder::of_leaves>(items, executor);
        else
            of_ids_ = set.template pack<PackedOrder::of_ids>(items, executor);
    }
    std::size_t bytes() const { return of_leaves_.bytes() + of_ids_.bytes(); }
    template <class Probe, class Query>
    requires requires(const Packed<PackedOrder::of_ids>& packed, const Probe& probe, const Leaf& leaf,
                      Query& query) {
        packed.test_leaf(probe, leaf, query);
    }
    Flow test_leaf(const Probe& probe, const Leaf& leaf, Query& query) const {
        return by_leaves_ ? of_leaves_.test_leaf(probe, leaf, query) : of_ids_.test_leaf(probe, leaf, query);
    }
    void prefetch(const Leaf& leaf) const {
        if (by_leaves_)
            of_leaves_.prefetch(leaf);
        else
            of_ids_.prefetch(leaf);
    }
    template <PackedOrder order>
    const Packed<order>& in() const {
        if constexpr (order == PackedOrder::of_leaves)
            return of_leaves_;
        else
            return of_ids_;
    }
    /// Copies what an insertion or erasure of a primitive changed.
    template <class S>
    void change(const P& set, const S& structure, PrimitiveId id) {
        if (by_leaves_)
            pack_changed<PackedOrder::of_leaves>(set, structure, id, of_leaves_);
        else
            pack_changed<PackedOrder::of_ids>(set, structure, id, of_ids_);
    }

private:
    bool by_leaves_ = true;
    Packed<PackedOrder::of_leaves> of_leaves_;
    Packed<PackedOrder::of_ids> of_ids_;
};

/// A set that a structure can have packed for rays in the order of its leaves or by id.
template <class P>
concept PacksEitherWay = requires(const P& set, std::span<const PrimitiveId> items, Executor& executor) {
    set.template pack<PackedOrder::of_leaves>(items, executor);
    set.template pack<PackedOrder::of_ids>(items, executor);
};

/// The walks that are compiled for the leaves of triangles too, without a virtual call a leaf: comparisons of
/// structures are about them.
template <std::floating_point T, int D>
class WalksOfTriangles {};
template <std::floating_point T>
class WalksOfTriangles<T, 3> {
public:
    using Triangles = TriangleMeshView<T>;
    using Leaves = PackedEitherWay<Triangles>;

    virtual void walk_triangles(const Leaves& leaves, ClosestHit<Triangles>& query) const = 0;
    virtual void walk_triangles(const Leaves& leaves, AnyHit<Triangles>& query) const = 0;

protected:
    ~WalksOfTriangles() = default;
};

/// What an AnyStructure asks of the structure behind it. Walks are compiled once a probe and count, whatever
/// the set and the query.
template <std::floating_point T, int D>
class StructureBehind : public WalksOfTriangles<T, D> {
public:
    using Set = AnySet<T, D>;
    using AnyRegionProbe = RegionProbe<AnyRegion<T, D>>;

    virtual ~StructureBehind() = default;
    virtual std::unique_ptr<StructureBehind> copy() const = 0;

    virtual const Box<T, D>& bounds() const = 0;
    virtual bool exclusive() const = 0;
    virtual std::span<const PrimitiveId> items() const = 0;
    virtual std::size_t item_count() const = 0;
    virtual std::size_t bytes() const = 0;
    virtual std::size_t node_count() const = 0;
    virtual std::size_t leaf_count() const = 0;
    virtual int depth() const = 0;
    virtual std::string validate(const Set& set) const = 0;
    virtual PackedOrder packed_order() const = 0;
    virtual void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const = 0;
    virtual std::unique_ptr<const HierarchyBehind<T, D>> hierarchy(const Set& set) const = 0;

    virtual bool answers_rays() const = 0;
    virtual void walk(LeafQuery<RayProbe<T, D>>& query, const NoVisits& none) const = 0;
    virtual void walk(LeafQuery<RayProbe<T, D>>& query, TraceLog<T, D>& log) const = 0;
    virtual void walk(LeafQuery<PointProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(LeafQuery<FarProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(LeafQuery<BoxProbe<T, D>>& query, Visits& count) const = 0;
    virtual void walk(LeafQuery<AnyRegionProbe>& query, Visits& count) const = 0;

    virtual bool changes_one_by_one() const = 0;
    virtual bool insert(const Set& set, PrimitiveId id) = 0;
    virtual bool erase(const Set& set, PrimitiveId id) = 0;
    virtual bool holds(PrimitiveId id) const = 0;
    virtual std::span<const std::uint32_t> places_changed() const = 0;
    /// How many of `count` primitives the structure holds.
    virtual std::size_t held_count(std::size_t count) const = 0;
    virtual bool refittable() const = 0;
    virtual void refit(std::span<const Reference<T, D>> references, Executor& executor) = 0;
    virtual double drift() const = 0;
};

/// Builds the structure that `spec` names.
template <std::floating_point T, int D>
std::unique_ptr<StructureBehind<T, D>> build_structure(std::string_view spec, const AnySet<T, D>& set,
                                                       Executor& executor);

}  // namespace detail

struct AnyStructureOptions {
    /// The structure's name and its options: "kdtree", "bvh:builder=sweep,max_leaf_size=4".
    /// `structure_list` (any_index.h) lists all.
    std::string spec = "wide";
};

/// Any structure behind one type, whose name and options are given when it is built:
///
///   const auto index = build<AnyStructure>(spheres, {"kdtree:leaf_size=4"});
///
/// An Index of it takes primitives of any type, your own too, and answers every question by a walk. Walks are
/// compiled once for all sets and queries, at the price of a virtual call a leaf. `wide` is walked like all
/// others: an Index<WideBvh, ...> has the kernels too. `build` throws UsageError for names and options that
/// there are not, and for structures that hold points alone over other primitives.
///
/// Linked by hedgerow::any, for float and double, in two and three dimensions.
template <std::floating_point T, int D>
class AnyStructure {
public:
    using Options = AnyStructureOptions;

    /// Contains nothing.
    AnyStructure() = default;
    AnyStructure(const AnyStructure& o) : spec_(o.spec_), behind_(o.behind_ ? o.behind_->copy() : nullptr) {}
    AnyStructure(AnyStructure&&) noexcept = default;
    AnyStructure& operator=(AnyStructure o) noexcept {
        std::swap(spec_, o.spec_), std::swap(behind_, o.behind_);
        return *this;
    }
    ~AnyStructure() = default;

    template <PrimitiveSet P>
    static AnyStructure build(const P& set, const Options& options, Executor& executor) {
        AnyStructure built;
        built.spec_ = options.spec;
        built.behind_ = detail::build_structure<T, D>(options.spec, detail::SetBehind<P>(set), executor);
        return built;
    }

    /// What it was built by.
    const std::string& spec() const { return spec_; }
    const Box<T, D>& bounds() const {
        static const Box<T, D> nothing;
        return behind_ ? behind_->bounds() : nothing;
    }
    bool exclusive() const { return !behind_ || behind_->exclusive(); }
    std::span<const PrimitiveId> items() const {
        return behind_ ? behind_->items() : std::span<const PrimitiveId>();
    }
    std::size_t item_count() const { return behind_ ? behind_->item_count() : 0; }
    std::size_t bytes() const { return behind_ ? behind_->bytes() : 0; }
    std::size_t node_count() const { return behind_ ? behind_->node_count() : 0; }
    std::size_t leaf_count() const { return behind_ ? behind_->leaf_count() : 0; }
    int depth() const { return behind_ ? behind_->depth() : 0; }
    template <PrimitiveSet P>
    std::string validate(const P& set) const {
        return behind_ ? behind_->validate(detail::SetBehind<P>(set)) : std::string();
    }
    void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const {
        if (behind_) behind_->visit_outline(limits, visit);
    }

    /// Its hierarchy, for walks over pairs (walks/hierarchy.h).
    template <PrimitiveSet P>
    AnyHierarchy<T, D> hierarchy(const P& set) const {
        if (!behind_) return {};
        return AnyHierarchy<T, D>(behind_->hierarchy(detail::SetBehind<P>(set)));
    }

    /// Whether the structure answers queries of rays. Else its walks of rays throw InputError.
    bool answers_rays() const { return !behind_ || behind_->answers_rays(); }

    /// Walks any query. `count` is a Visits, a NoVisits or, for rays, a TraceLog.
    template <class Leaves, Query Q, class Count>
    void walk(const Leaves& leaves, Q& query, Count& count) const {
        using Probe = typename Q::Probe;
        if (!behind_) return;
        const Probe& probe = std::as_const(query).probe();
        if constexpr (std::same_as<std::remove_const_t<Count>, NoVisits> &&
                      requires { behind_->walk_triangles(leaves.packed(), query); })
            behind_->walk_triangles(leaves.packed(), query);
        else if constexpr (detail::is_region_probe<Probe> && !std::same_as<Probe, BoxProbe<T, D>> &&
                           !std::same_as<Probe, AnyRegionProbe>) {
            const AnyRegion<T, D> region(probe.region());
            const AnyRegionProbe any(region, bounds(), probe.finds());
            LeafTests<Q, Leaves, AnyRegionProbe> asked(any, query, leaves);
            walk_and_count(asked, count);
        } else {
            LeafTests<Q, Leaves> asked(probe, query, leaves);
            walk_and_count(asked, count);
        }
    }

    template <detail::PacksEitherWay P>
    detail::PackedEitherWay<P> pack(const P& set, Executor& executor) const {
        const PackedOrder order = behind_ ? behind_->packed_order() : PackedOrder::of_leaves;
        return {set, order, items(), executor};
    }

    /// Whether single primitives can be inserted and erased, and whether the structure can be fitted to
    /// primitives that moved. Else `insert`, `erase` and `refit` throw InputError.
    bool changes_one_by_one() const { return behind_ && behind_->changes_one_by_one(); }
    bool refittable() const { return behind_ && behind_->refittable(); }
    template <PrimitiveSet P>
    bool insert(const P& set, PrimitiveId id) {
        if (!changes_one_by_one()) refuse("insert " + std::to_string(id));
        return behind_->insert(detail::SetBehind<P>(set), id);
    }
    template <PrimitiveSet P>
    bool erase(const P& set, PrimitiveId id) {
        if (!changes_one_by_one()) refuse("erase " + std::to_string(id));
        return behind_->erase(detail::SetBehind<P>(set), id);
    }
    bool holds(PrimitiveId id) const { return behind_ && behind_->holds(id); }
    std::span<const std::uint32_t> places_changed() const { return behind_->places_changed(); }
    std::size_t held_count(std::size_t count) const { return behind_ ? behind_->held_count(count) : 0; }
    void refit(std::span<const Reference<T, D>> references, Executor& executor) {
        if (!refittable()) refuse("refit");
        behind_->refit(references, executor);
    }
    double drift() const { return behind_ ? behind_->drift() : 1; }

private:
    using AnyRegionProbe = RegionProbe<AnyRegion<T, D>>;

    [[noreturn]] void refuse(const std::string& wanted, const char* instead = "build it again") const {
        detail::refuse(spec_, wanted, instead);
    }
    template <class Probe, class Count>
    void walk_and_count(LeafQuery<Probe>& query, Count& count) const {
        constexpr bool of_rays = std::same_as<Probe, RayProbe<T, D>>;
        if constexpr (of_rays)
            if (!behind_->answers_rays())
                refuse("answer rays", "ask it for neighbours, or take another structure");
        if constexpr (of_rays && std::same_as<std::remove_const_t<Count>, NoVisits>)
            behind_->walk(query, count);
        else
            detail::count_virtually<Probe>(count, [&](auto& counted) { behind_->walk(query, counted); });
    }

    std::string spec_;
    std::unique_ptr<detail::StructureBehind<T, D>> behind_;
};

}  // namespace hedgerow
