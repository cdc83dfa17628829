/// Winding numbers within a promised error, by multipole expansions of the clusters of a wide BVH.
#pragma once

#include <hedgerow/engine/kernels.h>
#include <hedgerow/engine/winding_clusters.h>

namespace hedgerow {

namespace detail {

/// Adds the exact terms of a leaf, and returns a bound of their roundings.
template <class Sum, std::floating_point T>
double add_exactly(Sum& sum, const WideTree<T, 3>& tree, std::uint32_t block, std::uint32_t count) {
    double roundings = 0;
    for (std::uint32_t i = 0; i < count; ++i)
        roundings += sum.add(static_cast<int>(i), tree.items[wide_leaf_size * block + i]);
    return roundings;
}

/// Computes terms without vector instructions: for all parts, and with the bits of the kernels.
template <std::floating_point T, class Parts>
class PlainWindings {
public:
    PlainWindings(const WideTree<T, 3>& tree, const double* rows, const WindingQuery& query,
                  typename Parts::Sum& exact)
        : tree_(&tree),
          rows_(rows),
          terms_(query.terms),
          x_(query.scaled),
          exact_(exact),
          width_(tree.nodes.width()) {}

    unsigned expand(std::uint32_t node, std::size_t row, double threshold, double& sum) {
        double *const values = terms_.values + place(row), *const errors = terms_.errors + place(row);
        const double* const rows = rows_ + place(node) * WindingRow::count;
        const int children = tree_->nodes.children(node);
        unsigned opened = 0;
        for (int i = 0; i < width_; ++i) {
            values[i] = errors[i] = 0;
            if (i >= children) continue;
            const WindingTerm term = WindingRow::expanded(rows + i, width_, x_);
            if (term.error <= threshold)
                values[i] = term.value, errors[i] = term.error;
            else
                opened |= 1u << i;
        }
        sum += sum_of(errors);
        return opened;
    }
    unsigned open(std::size_t row, double threshold, double& sum) {
        double *const values = terms_.values + place(row), *const errors = terms_.errors + place(row);
        double removed[most_wide] = {};
        unsigned opened = 0;
        for (int i = 0; i < width_; ++i)
            if (errors[i] > threshold) {
                opened |= 1u << i;
                removed[i] = errors[i];
                values[i] = errors[i] = 0;
            }
        if (opened != 0) sum -= sum_of(removed);
        return opened;
    }
    double add_leaf(std::uint32_t block, std::uint32_t count) {
        return add_exactly(exact_, *tree_, block, count);
    }
    double total(std::size_t rows) const {
        double sums[most_wide] = {};
        for (std::size_t row = 0; row < rows; ++row)
            for (int i = 0; i < width_; ++i)
                sums[i] += terms_.values[place(row) + static_cast<std::size_t>(i)];
        return sum_of(sums) + exact_.turns();
    }

private:
    std::size_t place(std::size_t row) const { return row * static_cast<std::size_t>(width_); }
    /// The sum of a row by halves, as vectors are summed.
    double sum_of(const double* row) const {
        double sums[most_wide] = {};
        std::copy_n(row, width_, sums);
        for (int half = width_ / 2; half > 0; half /= 2)
            for (int i = 0; i < half; ++i) sums[i] += sums[i + half];
        return sums[0];
    }

    const WideTree<T, 3>* tree_;
    const double* rows_;
    WindingTerms terms_;
    Vec3d x_;
    typename Parts::Sum& exact_;
    int width_;
};

/// The power of two that brings the greatest coordinate to about 1.
template <std::floating_point T>
double winding_scale(const Box<T, 3>& bounds) {
    if (bounds.empty()) return 1;
    const auto most = static_cast<double>(max_component(max(abs(bounds.low), abs(bounds.high))));
    return most > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(most), -1000, 1000)) : 1;
}

}  // namespace detail

/// Sums winding numbers over a tree of triangles or dipoles.
template <std::floating_point T>
class WindingExpansion {
public:
    using Tree = WideTree<T, 3>;

    WindingExpansion() = default;
    /// `parts_of(scale)` makes the parts (see WindingTriangles). About 2 µs for each part, and 352 bytes for
    /// each child of a node.
    template <class PartsOf>
    WindingExpansion(const Tree& tree, PartsOf parts_of, Executor& executor)
        : scale_(detail::winding_scale(tree.bounds)),
          box_{Vec3d(tree.bounds.low) * scale_, Vec3d(tree.bounds.high) * scale_},
          rows_(detail::winding_rows(tree, parts_of(scale_), executor)) {}

    /// The power of two that brings the greatest coordinate to about 1.
    double scale() const { return scale_; }
    std::size_t bytes() const { return rows_.bytes(); }

    /// The winding number of the parts about a finite point, which errs by at most `error`. `blocks` are
    /// those of the tree if the parts are triangles of float, else null.
    template <class Parts, class Count>
    double winding_number(const Tree& tree, const Parts& parts, const TriangleBlock<float>* blocks,
                          const Vec3d& point, double error, Count& count) const {
        if (tree.empty()) return 0;
        const Scratch<WindingMemory> memory;
        const WindingQuery query = this->query(tree, point, error, *memory);
        typename Parts::Sum exact(parts, point, query.to_unit);
        if constexpr (std::same_as<T, float> && std::same_as<std::remove_const_t<Count>, NoVisits>)
            if (const WindingKernels* const kernels = in_use<WindingKernels>(); kernels != nullptr) {
                const auto answer = kernels->winding_number;
                if (blocks != nullptr) return answer({tree, rows(), blocks}, query);
                auto add = [&](std::uint32_t block, std::uint32_t primitives) {
                    return detail::add_exactly(exact, tree, block, primitives);
                };
                const WindingLeaves leaves{&add, [](void* f, std::uint32_t block, std::uint32_t primitives) {
                                               return (*static_cast<decltype(add)*>(f))(block, primitives);
                                           }};
                return answer({tree, rows(), nullptr, leaves}, query) + exact.turns();
            }
        detail::PlainWindings<T, Parts> machine(tree, rows(), query, exact);
        return machine.total(sum_windings(tree, machine, error, query.terms, count));
    }

private:
    WindingQuery query(const Tree& tree, const Vec3d& point, double error, WindingMemory& memory) const {
        // Farther than 2⁵⁰⁰ of the clusters' units every point sees next to nothing, and squares overflow.
        const auto bounded = [](double x) { return std::clamp(x, -0x1p500, 0x1p500); };
        const Vec3d scaled = map(point * scale_, bounded);
        const double to_unit = std::min(product(scale_, detail::scale_of_offsets(scaled, box_)), 0x1p1000);
        return {point, scaled, to_unit, error, memory.terms(tree.nodes.size(), tree.nodes.width())};
    }
    const double* rows() const { return rows_.data()->numbers; }

    double scale_ = 1;
    Box3d box_;
    Stored<detail::WindingLine> rows_;
};

}  // namespace hedgerow
