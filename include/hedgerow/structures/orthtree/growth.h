/// How an orthtree's cells are divided: which primitives are in which orthant, and which cells are leaves.
#pragma once

#include <memory>

#include <hedgerow/parallel/executor.h>
#include <hedgerow/structures/cells.h>
#include <hedgerow/structures/orthtree/store.h>

namespace hedgerow {

/// The orthants of a cell that a box reaches, a bit for each. The box must reach the cell.
template <std::floating_point T, int D>
unsigned orthants_reached(const Box<T, D>& box, const Vec<T, D>& middle) {
    unsigned orthants = (1u << (1 << D)) - 1;
    for (int k = 0; k < D; ++k) {
        if (!(box.low[k] <= middle[k])) orthants &= detail::high_side<D>[k];
        if (!(box.high[k] >= middle[k])) orthants &= ~detail::high_side<D>[k];
    }
    return orthants;
}

/// Finds the orthants of a cell that a primitive is in. They depend on the primitive and the cell alone, so a
/// primitive that is inserted later is in the same cells as if it had been in the build.
template <PrimitiveSet P>
class OrthantStanding {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;

    explicit OrthantStanding(const P& set) : set_(set) {}

    /// How far cells are enlarged for a primitive with this box, by the box's own coordinates. A set that is
    /// tested by boxes alone needs no margin: closest points and overlaps lie in the box.
    T margin(const Box<T, D>& box) const { return hits_lie_on(set_) ? cell_margin(box) : T(0); }
    /// The orthants of `cell` that a primitive of the cell is in: at least one.
    unsigned operator()(PrimitiveId id, const Cube<T, D>& cell) const {
        const Box<T, D> box = set_.bounds(id);
        const T around = margin(box);
        const unsigned near = orthants_reached(enlarged(box, around), cell.middle);
        if (std::has_single_bit(near) || !hits_lie_on(set_)) return near;
        const auto stands = stands_in(set_, id);
        unsigned in = 0;
        for (unsigned left = near; left != 0; left &= left - 1) {
            const auto i = static_cast<unsigned>(std::countr_zero(left));
            if (stands(enlarged(cell.orthant(i).box(), around))) in |= 1u << i;
        }
        return in != 0 ? in : near;
    }

private:
    const P& set_;
};

/// Limits that decide which cells are leaves.
template <std::floating_point T>
struct OrthtreeLimits {
    std::uint32_t leaf_size = 0;
    /// The least half width of a cell.
    T least_half = T(0);
};

/// Grows the subtree of a cell top down. A cell of more than leaf_size primitives is divided if all of this
/// is true:
/// - Its room suffices. Room counts words of four bytes. The group of children takes some of it, and the
///   children share the rest in proportion to their primitives. So the whole tree stays within the room of
///   the root.
/// - The orthants together have fewer than 2^(D−1) times as many primitives, copies included, as the cell. An
///   orthant has 1/2^(D−1) of its cell's surface, so a random line through the cell is then expected to be
///   tested against fewer primitives than before (the SAH of equal cells). Primitives that cross the cell
///   along one plane (in the plane, a line) fail this at every depth.
/// - The primitives do not all have the same box, and the cell's half width is above the limit.
/// - The orthants' middles are numbers of T.
template <PrimitiveSet P>
class OrthantGrowth {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Store = OrthantStore<D>;
    using Ids = std::vector<PrimitiveId>;

    OrthantGrowth(const P& set, const OrthtreeLimits<T>& limits, Executor& executor)
        : set_(set), standing_(set), limits_(limits), executor_(executor) {}

    /// Builds the subtree of a cell from ids, which are used up. The tree is the same for any number of
    /// threads. `work` is the cell's share of the progress that the executor receives, in primitives. The
    /// cell's size is no measure of it, since deeper cells have more copies.
    OrthantNode grow(Ids& ids, const Cube<T, D>& cell, std::uint64_t room, Store& store,
                     double work = 0) const {
        // Divide the ids among the orthants, or make a leaf of them.
        Parts parts;
        if (!divide(ids, cell, room, parts)) return store.make_leaf(ids);
        const bool alone = ids.size() < worth_a_task;
        Ids().swap(ids);
        // Make a group, and grow a child in each orthant.
        unsigned occupied = 0;
        for (unsigned i = 0; i < Store::width; ++i)
            if (!parts[i].ids.empty()) occupied |= 1u << i;
        const std::uint32_t group = store.allocate_group();
        if (alone) {
            for (unsigned i = 0; i < Store::width; ++i) {
                const OrthantNode child = grow(parts[i].ids, cell.orthant(i), parts[i].room, store);
                store.group(group).child[i] = child;
            }
        } else {
            grow_side_by_side(parts, cell, group, store, work);
        }
        return OrthantNode::inner_over(group, occupied);
    }

private:
    struct Part {
        Ids ids;
        std::uint64_t room = 0;
    };
    using Parts = std::array<Part, Store::width>;
    static constexpr std::uint64_t group_words = sizeof(typename Store::Group) / 4;

    /// Grows each child in a store of its own, and then copies these stores into one in their order.
    void grow_side_by_side(Parts& parts, const Cube<T, D>& cell, std::uint32_t group, Store& store,
                           double work) const {
        // Grow the children from `first` to `last`, by halves. Each does its share of the work.
        std::size_t copies = 0;
        for (const Part& part : parts) copies += part.ids.size();
        std::array<Store, Store::width> grown;
        std::array<OrthantNode, Store::width> roots;
        const auto some = [&](auto& self, unsigned first, unsigned last) -> void {
            if (last - first == 1) {
                Part& part = parts[first];
                const std::size_t size = part.ids.size();
                const double share = work * static_cast<double>(size) / static_cast<double>(copies);
                roots[first] = grow(part.ids, cell.orthant(first), part.room, grown[first], share);
                if (size < worth_a_task) executor_.advance(static_cast<std::size_t>(share));
                return;
            }
            const unsigned middle = (first + last) / 2;
            executor_.both([&] { self(self, first, middle); }, [&] { self(self, middle, last); });
        };
        some(some, 0, Store::width);
        // Reserve memory for all children, and copy them one by one.
        std::size_t groups = 0, words = 0;
        for (const Store& s : grown) groups += s.group_count(), words += s.list().size();
        store.reserve(groups, words);
        for (unsigned i = 0; i < Store::width; ++i) {
            const OrthantNode child = store.graft(grown[i], roots[i]);
            store.group(group).child[i] = child;
            grown[i] = {};
        }
    }

    /// Divides a cell's ids into those of its orthants. Returns false if the cell is to be a leaf.
    bool divide(const Ids& ids, const Cube<T, D>& cell, std::uint64_t room, Parts& parts) const {
        const std::size_t n = ids.size();
        if (n <= limits_.leaf_size || cell.half <= limits_.least_half || !cell.divisible() || all_alike(ids))
            return false;
        // Count the primitives of each orthant. Refuse too many copies, or more words than there is room for.
        const auto orthants = look_up(ids, cell);
        std::array<std::uint32_t, Store::width> counts{};
        for (const unsigned in : orthants)
            for (unsigned i = 0; i < Store::width; ++i) counts[i] += in >> i & 1u;
        std::uint64_t copies = 0, words = group_words;
        for (const std::uint32_t c : counts) copies += c, words += Store::capacity_for(c);
        if (copies >= (std::uint64_t(n) << (D - 1)) || words > room) return false;
        // Share the spare room among the children by their counts.
        const double spare = static_cast<double>(room - words) / static_cast<double>(copies);
        for (unsigned i = 0; i < Store::width; ++i) {
            parts[i].ids.reserve(counts[i]);
            parts[i].room = Store::capacity_for(counts[i]) + static_cast<std::uint64_t>(spare * counts[i]);
        }
        // Copy each id to its orthants.
        for (std::size_t k = 0; k < n; ++k)
            for (unsigned left = orthants[k]; left != 0; left &= left - 1)
                parts[static_cast<unsigned>(std::countr_zero(left))].ids.push_back(ids[k]);
        return true;
    }
    std::vector<std::uint8_t> look_up(const Ids& ids, const Cube<T, D>& cell) const {
        std::vector<std::uint8_t> orthants(ids.size());
        const auto look = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                orthants[i] = static_cast<std::uint8_t>(standing_(ids[i], cell));
        };
        if (ids.size() < worth_a_task)
            look(0, ids.size());
        else
            executor_.for_each_piece(ids.size(), worth_a_task / 4, look);
        return orthants;
    }
    bool all_alike(const Ids& ids) const {
        const Box<T, D> first = set_.bounds(ids[0]);
        return std::all_of(ids.begin() + 1, ids.end(),
                           [&](PrimitiveId id) { return set_.bounds(id) == first; });
    }

    const P& set_;
    OrthantStanding<P> standing_;
    OrthtreeLimits<T> limits_;
    Executor& executor_;
};

}  // namespace hedgerow
