/// The order of primitives along a Morton curve (Morton 1966): primitives near each other on the curve are
/// mostly near each other in space.
#pragma once

#include <span>

#include <hedgerow/geometry/morton_code.h>
#include <hedgerow/parallel/radix_sort.h>
#include <hedgerow/structures/references.h>

namespace hedgerow {

/// Cells along the curve: 21 bits an axis in 3D, 31 in 2D, the first axis' highest. Cells are cubes over the
/// box of the centers. A short side of the box has fewer cells: its leading bits are 0 in every code, and no
/// split is spent on them. A box without extent, or too narrow to divide, is one cell.
template <std::floating_point T, int D>
class MortonCells {
public:
    static constexpr int bits_an_axis = 62 / D + (D == 3 ? 1 : 0);
    static constexpr int bits = bits_an_axis * D;

    explicit MortonCells(const LaneBox<T>& centers2) : low_(centers2.low) {
        constexpr T cells = static_cast<T>(std::uint32_t(1) << bits_an_axis);
        const T width = max_component(centers2.template box<D>().extent());
        T scale = width > 0 ? cells * T(0.999) / width : T(0);
        if (!(scale <= std::numeric_limits<T>::max())) scale = T(0);
        scale_ = Lanes<T>::of(Vec<T, D>::all(scale));
    }
    std::uint64_t code(Lanes<T> center2) const {
        T at[4];
        ((center2 - low_) * scale_).store(at);
        std::uint64_t code = 0;
        for (int k = 0; k < D; ++k)
            code |= spread_bits<D>(static_cast<std::uint64_t>(static_cast<std::int64_t>(at[k])))
                    << (D - 1 - k);
        return code;
    }

private:
    Lanes<T> low_, scale_;
};

/// The box of all centers, times 2.
template <std::floating_point T, int D>
LaneBox<T> box_of_centers2(std::span<const Reference<T, D>> references, Executor& executor) {
    const Blocks blocks{references.size(), 16384};
    std::vector<LaneBox<T>> boxes(blocks.number(), LaneBox<T>::none());
    blocks.each(executor, [&](std::size_t b, std::size_t begin, std::size_t end) {
        auto box = LaneBox<T>::none();
        for (std::size_t i = begin; i < end; ++i) box.expand(references[i].center2());
        boxes[b] = box;
    });
    auto all = LaneBox<T>::none();
    for (const auto& box : boxes) all.expand(box);
    return all;
}

/// References in the order of the curve; those of one cell keep their own order. A key has the reference's
/// place in its low bits and as much of its code as fits above. Keys are sorted by the first 33 bits of the
/// code by radix, in O(n), and those that are still alike by comparison. Where three or more have the same
/// code as far as keys hold it, their whole codes are compared. Two keep their own order: whichever comes
/// first, the tree divides between them. Both halves of a flat quadrilateral are often such a pair, since
/// they have one box.
template <std::floating_point T, int D>
class MortonOrder {
public:
    /// Keeps a view of the references, which must outlive it.
    MortonOrder(std::span<const Reference<T, D>> references, Executor& executor)
        : references_(references),
          cells_(box_of_centers2(references, executor)),
          keys_(size()),
          place_bits_(static_cast<int>(std::bit_width(std::max<std::size_t>(size(), 1) - 1))) {
        executor.for_each_piece(size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                keys_[i] = cells_.code(references[i].center2()) << (64 - cells_.bits) >> place_bits_
                                                                                             << place_bits_ |
                           i;
        });
        sort_by_first_bits(keys_, executor,
                           [&](std::size_t begin, std::size_t end) { sort_run(begin, end); });
    }

    std::size_t size() const { return references_.size(); }
    const Reference<T, D>& reference(std::size_t i) const { return references_[place(keys_[i])]; }
    void prefetch(std::size_t i) const { __builtin_prefetch(&reference(i)); }

    /// Where the part [first, last), of at least two elements, divides: at the first element whose code has
    /// the highest differing bit set; in the middle of two, or if all codes are equal.
    std::size_t split(std::size_t first, std::size_t last) const {
        if (last - first == 2) return first + 1;
        const std::uint64_t differing = keys_[first] ^ keys_[last - 1];
        if (differing >> place_bits_ != 0)
            return first_set(first, last, std::bit_floor(differing), [&](std::size_t i) { return keys_[i]; });
        const auto code = [&](std::size_t i) { return code_of(keys_[i]); };
        const std::uint64_t rest = code(first) ^ code(last - 1);
        return rest != 0 ? first_set(first, last, std::bit_floor(rest), code) : first + (last - first) / 2;
    }

private:
    std::size_t place(std::uint64_t key) const { return key & ((std::uint64_t(1) << place_bits_) - 1); }
    std::uint64_t code_of(std::uint64_t key) const { return cells_.code(references_[place(key)].center2()); }

    /// The first element of [first, last) with `bit` set, where the first has it clear and the last has it
    /// set. Bisection without branches, since a processor cannot predict its direction.
    template <class Bits>
    static std::size_t first_set(std::size_t first, std::size_t last, std::uint64_t bit, Bits bits) {
        std::size_t clear = first;
        for (std::size_t step = std::bit_floor(last - first - 1); step > 0; step /= 2) {
            const std::size_t next = clear + step < last ? clear + step : last - 1;  // the last has the bit
            clear = (bits(next) & bit) == 0 ? next : clear;
        }
        return clear + 1;
    }

    void sort_run(std::size_t begin, std::size_t end) {
        std::sort(keys_.data() + begin, keys_.data() + end);
        for (std::size_t first = begin, last; first < end; first = last) {
            last = end_of_alike(keys_.data(), first, end, place_bits_);
            if (last - first > 2) sort_by_codes(first, last);
        }
    }
    void sort_by_codes(std::size_t begin, std::size_t end) {
        std::sort(keys_.data() + begin, keys_.data() + end, [&](std::uint64_t a, std::uint64_t b) {
            const std::uint64_t x = code_of(a), y = code_of(b);
            return x != y ? x < y : a < b;
        });
    }

    std::span<const Reference<T, D>> references_;
    MortonCells<T, D> cells_;
    BareVector<std::uint64_t> keys_;
    int place_bits_;
};

}  // namespace hedgerow
