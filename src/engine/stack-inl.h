/// The stack of a walk: children that are still to be visited. Where a row of children fits in a vector they
/// are sorted and pushed in lanes, almost without branches that depend on which children were entered.
#if defined(HEDGEROW_ENGINE_STACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEDGEROW_ENGINE_STACK_INL_H
#undef HEDGEROW_ENGINE_STACK_INL_H
#else
#define HEDGEROW_ENGINE_STACK_INL_H
#endif

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <hwy/highway.h>

#include "tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hedgerow::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Moves lane i ^ `with` to lane i.
template <int with, class D, class V>
HWY_INLINE V lanes_crossed(D d, V v) {
    if constexpr (with == 1) return hn::Shuffle2301(v);
    if constexpr (with == 2) return hn::Shuffle1032(v);
    if constexpr (with == 3) return hn::Shuffle0123(v);
    if constexpr (with == 4) return hn::SwapAdjacentBlocks(v);
    if constexpr (with == 7) return hn::Reverse8(d, v);
    if constexpr (with == 15) return hn::Reverse(d, v);
}
// A compare-exchange step of a bitonic sort (Batcher 1968), of the lanes i and i ^ `with`. The lane in which
// the highest bit of `with` is 0 keeps the greater value.
template <int with, class D, class V>
HWY_INLINE V exchanged(D d, V v) {
    const V other = lanes_crossed<with>(d, v);
    constexpr int highest = with >= 8 ? 8 : with >= 4 ? 4 : with >= 2 ? 2 : 1;
    const auto keeps_greater = hn::Eq(hn::And(hn::Iota(d, 0), hn::Set(d, highest)), hn::Zero(d));
    return hn::IfThenElse(keeps_greater, hn::Max(v, other), hn::Min(v, other));
}
template <class D, class V>
HWY_INLINE V sorted_descending(D d, V v) {
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    v = exchanged<1>(d, v);
    v = exchanged<1>(d, exchanged<3>(d, v));
    if constexpr (lanes >= 8) v = exchanged<1>(d, exchanged<2>(d, exchanged<7>(d, v)));
    if constexpr (lanes >= 16) v = exchanged<1>(d, exchanged<2>(d, exchanged<4>(d, exchanged<15>(d, v))));
    return v;
}

// Whether the instruction set has a compress instruction.
inline constexpr bool compresses = HWY_TARGET == HWY_AVX3;

// A ray's stack: entries and words, in memory of the caller. An entry is an s, stored as the bits of the
// float: these compare as integers like the floats, since s is not negative. The lowest place stores the
// word that ends the walk.
template <int W>
class WalkStack {
public:
    static constexpr std::uint32_t end = WideChild::none().word;
    // Places for the walk of a tree of `depth` levels, with room for pushes, which write whole vectors.
    static constexpr int room(int depth) { return (depth * (W - 1) + 2 * W + 15) / 16 * 16; }

    HWY_INLINE WalkStack(std::int32_t* entries, std::uint32_t* words, int bottom, int top)
        : entries_(entries), words_(words), bottom_(bottom), top_(top) {}
    HWY_INLINE void clear() {
        words_[bottom_] = end;
        top_ = bottom_ + 1;
    }
    HWY_INLINE int top() const { return top_; }
    HWY_INLINE std::uint32_t pop() { return words_[--top_]; }

    HWY_INLINE void push(float entry, std::uint32_t word) {
        entries_[top_] = std::bit_cast<std::int32_t>(entry);
        words_[top_++] = word;
    }
    // Pushes the entered children, the nearest on top.
    HWY_INLINE void push(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (Boxes<W>::parts == 1)
            push_sorted(hn::RebindMask(i32, boxes.entered[0]), keys_of(boxes), children);
        else
            push_each(boxes, children);
    }
    // Pushes the entered children except the nearest, whose word is returned. The nearest is known before
    // the others are sorted, so the walk can continue meanwhile.
    HWY_INLINE std::uint32_t push_others(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (Boxes<W>::parts == 1) {
            const auto entered = hn::RebindMask(i32, boxes.entered[0]);
            const Lanes keys = keys_of(boxes);
            const Lanes nearest = hn::MinOfLanes(
                i32, hn::IfThenElse(entered, keys, hn::Set(i32, std::numeric_limits<std::int32_t>::max())));
            push_sorted(hn::And(entered, hn::Ne(keys, nearest)), keys, children);
            return children[hn::GetLane(nearest) & (W - 1)];
        } else {
            push_each(boxes, children);
            return pop();
        }
    }
    // `push` and `push_others` in any order, without entries: for walks that stop at the first hit.
    HWY_INLINE void push_unsorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (Boxes<W>::parts > 1)
            put_each_unsorted(boxes.bits(), children);
        else if constexpr (compresses)
            put_unsorted(hn::RebindMask(i32, boxes.entered[0]), children);
        else
            push(boxes, children);  // a sort takes less time than a compress by table
    }
    HWY_INLINE std::uint32_t push_others_unsorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        const unsigned entered = boxes.bits();
        const int last = static_cast<int>(std::bit_width(entered)) - 1;
        const std::uint64_t others = entered ^ (1u << last);
        if constexpr (Boxes<W>::parts > 1 || !compresses)
            put_each_unsorted(static_cast<unsigned>(others), children);
        else
            put_unsorted(hn::LoadMaskBits(i32, reinterpret_cast<const std::uint8_t*>(&others)), children);
        return children[last];
    }
    // Removes children that a hit has put out of reach, so that a pop need not check them.
    HWY_INLINE void sweep(float s_limit) {
        const std::int32_t limit = std::bit_cast<std::int32_t>(s_limit);
        const int top = top_;
        top_ = bottom_ + 1;
        for (int i = top_; i < top; ++i) {
            const std::int32_t entry = entries_[i];
            entries_[top_] = entry, words_[top_] = words_[i];
            top_ += entry <= limit;
        }
    }

private:
    static constexpr hn::RebindToSigned<Floats<W>> i32{};
    using Lanes = hn::Vec<hn::RebindToSigned<Floats<W>>>;

    // A key is the entry of a child, with the child's number in the lowest bits.
    static HWY_INLINE Lanes keys_of(const Boxes<W>& boxes) {
        const auto entry = hn::BitCast(i32, boxes.entry[0]);
        return hn::Or(hn::AndNot(hn::Set(i32, W - 1), entry), hn::Iota(i32, 0));
    }
    HWY_INLINE void push_sorted(hn::Mask<decltype(i32)> entered, Lanes keys, const std::uint32_t* children) {
        const Lanes child = hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children));
        const int count = static_cast<int>(hn::CountTrue(i32, entered));
        if constexpr (compresses && W == 16) {
            const Lanes few = hn::Compress(keys, entered);
            if (count <= 4) [[likely]]
                return put_sorted(hn::Half<hn::Half<decltype(i32)>>(), few, count, child);
            if (count <= 8) [[likely]]
                return put_sorted(hn::Half<decltype(i32)>(), few, count, child);
        }
        const Lanes sorted = sorted_descending(i32, hn::IfThenElse(entered, keys, hn::Set(i32, -1)));
        put(i32, count, sorted, ordered(child, sorted));
    }
    HWY_INLINE void put_unsorted(hn::Mask<decltype(i32)> entered, const std::uint32_t* children) {
        const Lanes child = hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children));
        hn::StoreU(hn::Compress(child, entered), i32, reinterpret_cast<std::int32_t*>(words_) + top_);
        top_ += static_cast<int>(hn::CountTrue(i32, entered));
    }
    HWY_INLINE void put_each_unsorted(unsigned entered, const std::uint32_t* children) {
        for (; entered != 0; entered &= entered - 1) words_[top_++] = children[std::countr_zero(entered)];
    }
    // Sorts and pushes the first `count` keys, in as many lanes as D has.
    template <class D>
    HWY_INLINE void put_sorted(D d, Lanes keys, int count, Lanes children) {
        const auto some = hn::FirstN(d, static_cast<std::size_t>(count));
        const auto sorted = sorted_descending(d, hn::IfThenElse(some, lowest(d, keys), hn::Set(d, -1)));
        put(d, count, sorted, lowest(d, ordered(children, widened(i32, sorted))));
    }
    template <class D, class V>
    static HWY_INLINE hn::Vec<D> lowest(D d, V v) {
        if constexpr (std::is_same_v<hn::Vec<D>, V>)
            return v;
        else
            return lowest(d, hn::LowerHalf(v));
    }
    template <class D, class V>
    static HWY_INLINE hn::Vec<D> widened(D d, V v) {
        if constexpr (std::is_same_v<hn::Vec<D>, V>)
            return v;
        else
            return hn::ZeroExtendVector(d, widened(hn::Half<D>(), v));
    }
    // The children in the order of their keys.
    static HWY_INLINE Lanes ordered(Lanes children, Lanes keys) {
        return hn::TableLookupLanes(children, hn::IndicesFromVec(i32, hn::And(keys, hn::Set(i32, W - 1))));
    }
    template <class D, class V>
    HWY_INLINE void put(D d, int count, V keys, V children) {
        hn::StoreU(hn::AndNot(hn::Set(d, W - 1), keys), d, entries_ + top_);
        hn::StoreU(children, d, reinterpret_cast<std::int32_t*>(words_) + top_);
        top_ += count;
    }
    // `push` where a row takes several vectors: children are inserted one by one.
    HWY_INLINE void push_each(const Boxes<W>& boxes, const std::uint32_t* children) {
        alignas(64) float at[W];
        boxes.store(at);
        const int base = top_;
        for (unsigned entered = boxes.bits(); entered != 0; entered &= entered - 1) {
            const int i = std::countr_zero(entered);
            const std::int32_t entry = std::bit_cast<std::int32_t>(at[i]);
            int place = top_++;
            for (; place > base && entries_[place - 1] < entry; --place) {
                entries_[place] = entries_[place - 1];
                words_[place] = words_[place - 1];
            }
            entries_[place] = entry, words_[place] = children[i];
        }
    }

    std::int32_t* entries_;
    std::uint32_t* words_;
    int bottom_, top_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
