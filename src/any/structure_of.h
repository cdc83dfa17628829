/// Implements a structure behind virtual calls, and builds the one that a spec names. Each scalar and
/// dimension is instantiated in a file of its own, since it takes the compiler a while.
#pragma once

#include <hedgerow/any_structure.h>
#include <hedgerow/ask/asking.h>

#include "option_reader.h"
#include "structures.h"

namespace hedgerow::detail {

/// Walks triangles by `walk_over` of the whole, in space.
template <class Whole, std::floating_point T, int D>
class WalksTriangles : public StructureBehind<T, D> {};
template <class Whole, std::floating_point T>
class WalksTriangles<Whole, T, 3> : public StructureBehind<T, 3> {
public:
    using Base = WalksOfTriangles<T, 3>;
    using typename Base::Leaves, typename Base::Triangles;

    void walk_triangles(const Leaves& leaves, ClosestHit<Triangles>& query) const override {
        static_cast<const Whole&>(*this).walk_over(leaves, query);
    }
    void walk_triangles(const Leaves& leaves, AnyHit<Triangles>& query) const override {
        static_cast<const Whole&>(*this).walk_over(leaves, query);
    }
};

template <template <class, int> class S, std::floating_point T, int D>
class StructureOf final : public WalksTriangles<StructureOf<S, T, D>, T, D> {
    friend WalksTriangles<StructureOf<S, T, D>, T, D>;

public:
    using Base = StructureBehind<T, D>;
    using Structure = S<T, D>;
    using typename Base::Set, typename Base::AnyRegionProbe;

    explicit StructureOf(Structure structure) : structure_(std::move(structure)) {}
    std::unique_ptr<Base> copy() const override { return std::make_unique<StructureOf>(*this); }

    const Box<T, D>& bounds() const override { return structure_.bounds(); }
    bool exclusive() const override { return structure_.exclusive(); }
    std::span<const PrimitiveId> items() const override { return structure_.items(); }
    std::size_t item_count() const override { return item_count_of(structure_); }
    std::size_t bytes() const override { return structure_.bytes(); }
    std::size_t node_count() const override { return node_count_of(structure_); }
    std::size_t leaf_count() const override { return structure_.leaf_count(); }
    int depth() const override { return structure_.depth(); }
    std::string validate(const Set& set) const override { return structure_.validate(set); }
    PackedOrder packed_order() const override { return order_of_packed(); }
    void visit_outline(const OutlineLimits<D>& limits, CellVisitor<D> visit) const override {
        hedgerow::visit_outline(structure_, limits, visit);
    }
    std::unique_ptr<const HierarchyBehind<T, D>> hierarchy(const Set& set) const override {
        auto own = hierarchy_of(structure_, set);
        return std::make_unique<const HierarchyOf<decltype(own), T, D>>(std::move(own));
    }

    bool answers_rays() const override { return AnswersProbe<Structure, RayProbe<T, D>>; }
    void walk(LeafQuery<RayProbe<T, D>>& query, const NoVisits& none) const override {
        walk_any(query, none);
    }
    void walk(LeafQuery<RayProbe<T, D>>& query, TraceLog<T, D>& log) const override { walk_any(query, log); }
    void walk(LeafQuery<PointProbe<T, D>>& query, Visits& count) const override { walk_any(query, count); }
    void walk(LeafQuery<FarProbe<T, D>>& query, Visits& count) const override { walk_any(query, count); }
    void walk(LeafQuery<BoxProbe<T, D>>& query, Visits& count) const override { walk_any(query, count); }
    void walk(LeafQuery<AnyRegionProbe>& query, Visits& count) const override { walk_any(query, count); }

    bool changes_one_by_one() const override { return one_by_one; }
    bool insert(const Set& set, PrimitiveId id) override {
        if constexpr (one_by_one)
            return structure_.insert(set, id);
        else
            return static_cast<void>(set), static_cast<void>(id), false;
    }
    bool erase(const Set& set, PrimitiveId id) override {
        if constexpr (one_by_one)
            return structure_.erase(set, id);
        else
            return static_cast<void>(set), static_cast<void>(id), false;
    }
    bool holds(PrimitiveId id) const override {
        if constexpr (requires { structure_.holds(id); })
            return structure_.holds(id);
        else
            return static_cast<void>(id), true;  // what cannot change holds all
    }
    std::span<const std::uint32_t> places_changed() const override {
        if constexpr (requires { structure_.places_changed(); })
            return structure_.places_changed();
        else
            return {};
    }
    std::size_t held_count(std::size_t count) const override { return detail::held_count(structure_, count); }
    bool refittable() const override { return fits_again; }
    void refit(std::span<const Reference<T, D>> references, Executor& executor) override {
        if constexpr (fits_again)
            structure_.refit(references, executor);
        else
            static_cast<void>(references), static_cast<void>(executor);
    }
    double drift() const override {
        if constexpr (fits_again)
            return structure_.drift();
        else
            return 1;
    }

private:
    static constexpr PackedOrder order_of_packed() {
        if constexpr (requires { Structure::packed_order; })
            return Structure::packed_order;
        else
            return PackedOrder::of_ids;
    }
    static constexpr bool one_by_one = ChangesOneByOne<Structure, Set>;
    static constexpr bool fits_again = Refittable<Structure, Set>;

    template <class Probe, class Count>
    void walk_any(LeafQuery<Probe>& query, Count& count) const {
        if constexpr (AnswersProbe<Structure, Probe>)
            structure_.walk(LeavesOfQuery<Probe>{query}, query, count);
        else
            static_cast<void>(query), static_cast<void>(count);
    }

    template <class Leaves, class Q>
    void walk_over(const Leaves& leaves, Q& query) const {
        if constexpr (AnswersProbe<Structure, typename Q::Probe>)
            structure_.walk(leaves.template in<order_of_packed()>(), query, no_visits);
        else
            static_cast<void>(leaves), static_cast<void>(query);
    }

    Structure structure_;
};

/// Builds a structure over a set, with the options that are read.
template <template <class, int> class S, class T, int D>
std::unique_ptr<StructureBehind<T, D>> build_structure_of(OptionReader& in, const AnySet<T, D>& set,
                                                          Executor& executor) {
    using Structure = S<T, D>;
    typename Structure::Options options;
    list_options<Structure>(options, in);
    in.finish();
    const auto over = [&](const auto& primitives) {
        return std::make_unique<StructureOf<S, T, D>>(Structure::build(primitives, options, executor));
    };
    if constexpr (requires { Structure::instance_cost; })
        if (set.instanced()) options.intersection_cost *= Structure::instance_cost;
    constexpr bool holds_any = hedgerow::Structure<Structure, AnySet<T, D>>;
    constexpr bool knows_points = !holds_any || std::same_as<Structure, WideBvh<T, D>>;
    if constexpr (knows_points)
        if (set.of_points()) return over(static_cast<const AnyPoints<T, D>&>(set));
    if constexpr (holds_any)
        return over(set);
    else
        throw UsageError("structure '" + in.structure() + "' holds points alone");
}

template <std::floating_point T, int D>
std::unique_ptr<StructureBehind<T, D>> build_structure(std::string_view spec, const AnySet<T, D>& set,
                                                       Executor& executor) {
    OptionReader in(spec);
    const std::string_view wanted = in.structure();
    const auto type = wanted == "bvh" && in.differs("volume", "box") ? bvh_of_volumes : wanted;
    // Build the structure of that name.
    std::unique_ptr<StructureBehind<T, D>> built;
    std::vector<std::string_view> known;
    for_each_structure<D>([&]<template <class, int> class S>(std::string_view name, std::string_view) {
        if (name != bvh_of_volumes) known.push_back(name);
        if (name == type) built = build_structure_of<S, T, D>(in, set, executor);
    });
    // Refuse an octree in the plane, a quadtree in space, and names that are not in the list.
    if (const auto here = name_in<D>(wanted); !built && !here.empty())
        throw UsageError("structure '" + std::string(wanted) + "' holds what lies in " +
                         (D == 2 ? "space" : "the plane") + ": in " + (D == 2 ? "the plane" : "space") +
                         " use '" + std::string(here) + "'");
    if (!built)
        throw UsageError("no structure is called '" + std::string(wanted) + "'" + suggestion(wanted, known) +
                         "; there are " + choices(known));
    return built;
}

}  // namespace hedgerow::detail
