/// Reads a structure's options from text: "builder=sweep,max_leaf_size=4".
#pragma once

#include <charconv>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hedgerow/all.h>
#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>
#include <hedgerow/structures/bvh/builders/binned.h>
#include <hedgerow/structures/bvh/builders/ploc.h>
#include <hedgerow/structures/kdtree/builders/binned.h>

namespace hedgerow::detail {

inline std::string choices(const std::vector<std::string_view>& all) {
    std::string text;
    for (const auto s : all) text += (text.empty() ? "" : ", ") + std::string(s);
    return text;
}

/// The fewest digits that read back as the number.
template <class T>
std::string shortest(T number) {
    char text[64];
    return {text, std::to_chars(std::begin(text), std::end(text), number).ptr};
}

/// The options of one structure, as pairs of name and value. Each pair is read once. `finish` refuses pairs
/// that are left over, since their names are unknown. Throws UsageError for text that is no option or no
/// valid value.
class OptionReader {
public:
    OptionReader(std::string_view structure, std::string_view text) : structure_(structure) {
        while (!text.empty()) {
            const auto comma = text.find(',');
            const std::string_view pair = text.substr(0, comma);
            text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
            const auto equals = pair.find('=');
            if (equals == std::string_view::npos)
                throw UsageError("structure '" + structure_ + "': option '" + std::string(pair) +
                                 "' lacks its '=value'");
            given_[std::string(pair.substr(0, equals))] = std::string(pair.substr(equals + 1));
        }
    }

    template <class T>
    void number(const char* name, T& value, T least, T most) {
        const auto text = take(name);
        if (text.empty()) return;
        T read{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
        if (error != std::errc() || end != text.data() + text.size() || !(read >= least && read <= most))
            fail(name, text, "a number from " + shortest(least) + " to " + shortest(most));
        value = read;
    }
    template <class E>
    void choice(const char* name, E& value, const std::vector<std::pair<std::string_view, E>>& all) {
        const auto text = take(name);
        if (text.empty()) return;
        std::vector<std::string_view> names;
        for (const auto& [known, meant] : all) {
            names.push_back(known);
            if (known == text) return void(value = meant);
        }
        fail(name, text, "one of " + choices(names) + suggestion(text, names));
    }
    void flag(const char* name, bool& value) { choice<bool>(name, value, {{"on", true}, {"off", false}}); }

    /// Whether an option is given with another value than `standard`. The option can still be read.
    bool differs(const std::string& name, std::string_view standard) const {
        const auto found = given_.find(name);
        return found != given_.end() && found->second != standard;
    }
    void finish() const {
        for (const auto& [name, value] : given_)
            throw UsageError("structure '" + structure_ + "' has no option '" + name + "'" +
                             suggestion(name, known_) +
                             (known_.empty() ? "" : "; it has " + choices(known_)));
    }

private:
    std::string take(const char* name) {
        known_.push_back(name);
        const auto found = given_.find(name);
        if (found == given_.end()) return {};
        std::string value = found->second;
        given_.erase(found);
        if (value.empty()) fail(name, value, "a value");
        return value;
    }
    [[noreturn]] void fail(const char* name, const std::string& text, const std::string& wanted) const {
        throw UsageError("structure '" + structure_ + "': " + name + "=" + text + " is not " + wanted);
    }

    std::string structure_;
    std::map<std::string, std::string> given_;
    std::vector<std::string_view> known_;
};

inline constexpr double most_items_per_primitive = 1e9;

template <class T, int D>
void read_options(OptionReader& in, typename BruteForce<T, D>::Options& o,
                  std::type_identity<BruteForce<T, D>>) {
    in.flag("box", o.box);
}
template <class T, int D>
void read_options(OptionReader& in, typename HashGrid<T, D>::Options& o, std::type_identity<HashGrid<T, D>>) {
    in.number("cell", o.cell, 0.0, std::numeric_limits<double>::max());
}
template <class T, int D>
void read_options(OptionReader& in, typename KdTree<T, D>::Options& o, std::type_identity<KdTree<T, D>>) {
    in.choice<KdBuilder>("builder", o.builder,
                         {{"sah", KdBuilder::sah},
                          {"binned", KdBuilder::binned},
                          {"median", KdBuilder::median},
                          {"midpoint", KdBuilder::midpoint}});
    in.number<std::uint32_t>("leaf_size", o.leaf_size, 0, 1u << 20);
    in.number("max_depth", o.max_depth, 0, KdTree<T, D>::max_depth);
    in.number("bins", o.bins, 2, KdBinnedPlanes<T, D>::most_bins);
    in.number("items_per_primitive", o.items_per_primitive, 0.0, most_items_per_primitive);
    in.number("traversal_cost", o.costs.traversal_cost, 0.0, 1e6);
    in.number("intersection_cost", o.costs.intersection_cost, 1e-6, 1e6);
    in.number("empty_bonus", o.costs.empty_bonus, 0.0, 0.99);
    in.flag("mailbox", o.mailbox);
}
template <class T, int D>
void read_options(OptionReader&, typename PointKdTree<T, D>::Options&,
                  std::type_identity<PointKdTree<T, D>>) {}
inline void read_resolution(OptionReader& in, GridResolution& o, int least, int most) {
    in.choice<GridHeuristic>("heuristic", o.heuristic,
                             {{"density", GridHeuristic::density}, {"roots", GridHeuristic::roots}});
    in.number("density", o.density, 1e-9, 1e6);
    in.number("resolution", o.resolution, least, most);
}
template <class Options>
void read_entering(OptionReader& in, Options& o) {
    in.choice<GridInsert>("insert", o.insert, {{"exact", GridInsert::exact}, {"box", GridInsert::box}});
    in.number("items_per_primitive", o.items_per_primitive, 1.0, most_items_per_primitive);
    in.number("budget", o.budget, 1e3, 1e15);
    in.flag("mailbox", o.mailbox);
}
template <class T, int D>
void read_options(OptionReader& in, typename Grid<T, D>::Options& o, std::type_identity<Grid<T, D>>) {
    read_resolution(in, o.cells, 0, Lattice<D>::most_cells);
    read_entering(in, o);
    in.flag("skip_empty", o.skip_empty);
}
template <class T, int D>
void read_options(OptionReader& in, typename TwoLevelGrid<T, D>::Options& o,
                  std::type_identity<TwoLevelGrid<T, D>>) {
    read_resolution(in, o.cells, 0, Lattice<D>::most_cells);
    in.number("inner_density", o.inner_density, 1e-9, 1e6);
    read_entering(in, o);
}
template <class T, int D>
void read_options(OptionReader& in, typename Orthtree<T, D>::Options& o, std::type_identity<Orthtree<T, D>>) {
    in.number<std::uint32_t>("leaf_size", o.leaf_size, 1, 1u << 20);
    in.number("max_depth", o.max_depth, 0, Orthtree<T, D>::deepest_option);
    in.number("items_per_primitive", o.items_per_primitive, 1.0, most_items_per_primitive);
    in.flag("mailbox", o.mailbox);
}
template <class T, int D>
void read_options(OptionReader& in, typename BspTree<T, D>::Options& o, std::type_identity<BspTree<T, D>>) {
    in.number<std::uint32_t>("leaf_size", o.leaf_size, 0, 1u << 20);
    in.number("max_depth", o.max_depth, 0, BspTree<T, D>::max_depth);
    in.number<std::uint32_t>("samples", o.samples, 1, 1u << 20);
    in.number("items_per_primitive", o.items_per_primitive, 1.0, most_items_per_primitive);
    in.number("traversal_cost", o.costs.traversal_cost, 0.0, 1e6);
    in.number("plane_cost", o.costs.plane_cost, 0.0, 1e6);
    in.number("intersection_cost", o.costs.intersection_cost, 1e-6, 1e6);
    in.number("empty_bonus", o.costs.empty_bonus, 0.0, 0.99);
    in.flag("mailbox", o.mailbox);
}
template <class T, int D>
void read_bvh_options(OptionReader& in, BvhOptions& o, Volume& volume) {
    in.choice<Volume>("volume", volume, {std::begin(volume_names), std::end(volume_names)});
    in.choice<BvhBuilder>("builder", o.builder,
                          {{"binned", BvhBuilder::binned},
                           {"sweep", BvhBuilder::sweep},
                           {"equal-counts", BvhBuilder::equal_counts},
                           {"midpoint", BvhBuilder::midpoint},
                           {"lbvh", BvhBuilder::lbvh},
                           {"ploc", BvhBuilder::ploc},
                           {"agglomerative", BvhBuilder::agglomerative},
                           {"spatial-splits", BvhBuilder::spatial_splits}});
    in.number("bins", o.bins, 2, BinnedSplitter<T, D>::max_bins);
    in.number("search_radius", o.search_radius, 1, Ploc<T, D>::max_radius);
    in.number("reinsertion", o.reinsertion, 0, 100);
    in.number("duplicates", o.duplicates, 0.0, 10.0);
    in.number("overlap", o.overlap, 0.0, 1.0);
    in.number("traversal_cost", o.traversal_cost, 0.0, 1e6);
    in.number("intersection_cost", o.intersection_cost, 1e-6, 1e6);
    in.number<std::uint32_t>("max_leaf_size", o.max_leaf_size, 1, 1u << 20);
}
template <class T, int D>
void read_options(OptionReader& in, typename Bvh<T, D>::Options& o, std::type_identity<Bvh<T, D>>) {
    Volume box = Volume::box;
    read_bvh_options<T, D>(in, o, box);
    in.flag("culling", o.culling);
    in.flag("ordered", o.ordered);
}
template <class T, int D>
void read_options(OptionReader& in, typename VolumeBvh<T, D>::Options& o,
                  std::type_identity<VolumeBvh<T, D>>) {
    read_bvh_options<T, D>(in, o, o.volume);
}
template <class T, int D>
void read_options(OptionReader& in, typename WideBvh<T, D>::Options& o, std::type_identity<WideBvh<T, D>>) {
    in.choice<WideBuilder>(
        "builder", o.builder,
        {{"fast", WideBuilder::fast}, {"medium", WideBuilder::medium}, {"high", WideBuilder::high}});
    in.choice<int>("width", o.width, {{"0", 0}, {"4", 4}, {"8", 8}, {"16", 16}});
    in.number("reinsertion", o.reinsertion, 0, 100);
    in.number("traversal_cost", o.traversal_cost, 0.0, 1e6);
    in.number("intersection_cost", o.intersection_cost, 1e-6, 1e6);
    in.number<std::uint32_t>("max_leaf_size", o.max_leaf_size, 1, wide_leaf_size);
    in.number("budget", o.budget, 0.0, 1e15);
}

}  // namespace hedgerow::detail
