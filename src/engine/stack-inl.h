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

#include <hedgerow/engine/wide_tree.h>

#include "boxes-inl.h"

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

// Whether the instruction set compresses lanes in a few instructions: by one instruction, or by a permutation
// that a table holds.
inline constexpr bool compresses = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2;

// For each mask of eight lanes: the numbers of its lanes in order, four bits each.
struct LanesOfMasks {
    std::uint32_t lanes[256];

    constexpr LanesOfMasks() : lanes{} {
        for (unsigned mask = 0; mask < 256; ++mask) {
            int place = 0;
            for (unsigned lane = 0; lane < 8; ++lane)
                if (mask >> lane & 1) lanes[mask] |= lane << (4 * place++);
        }
    }
};
inline constexpr LanesOfMasks lanes_of_masks;

// Moves the lanes of a mask to the front, in their order. Highway's own Compress for AVX2 copies its table at
// each call where g++ compiles it.
template <class D, class V>
HWY_INLINE V compressed([[maybe_unused]] D d, V v, hn::Mask<D> mask) {
#if HWY_TARGET == HWY_AVX2
    const auto lanes = hn::Shr(hn::Set(d, static_cast<std::int32_t>(lanes_of_masks.lanes[bits_of(d, mask)])),
                               hn::ShiftLeft<2>(hn::Iota(d, 0)));
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, hn::And(lanes, hn::Set(d, 7))));
#else
    return hn::Compress(v, mask);
#endif
}

// A child that waits: its s above its word. The s is stored as the bits of the float, which compare as
// integers like the floats, since s is not negative.
HWY_INLINE std::uint64_t waiting(float s, std::uint32_t word) {
    std::uint64_t both = std::uint64_t(std::bit_cast<std::uint32_t>(s)) << 32 | word;
    asm("" : "+r"(both));  // in a general register: g++ would order pairs in vectors, which takes longer
    return both;
}

HWY_INLINE void order(std::uint64_t& nearer, std::uint64_t& farther) {
    const std::uint64_t a = nearer, b = farther;
    nearer = a < b ? a : b;
    farther = a < b ? b : a;
}

// A stack of waiting children, in memory of the caller, with the s (or the squared distance) at which each is
// entered. A walk that stops at the first hit needs no s: its places store words alone. The lowest place
// stores the word that ends the walk, at s = 0.
template <int W, Wanted wanted>
class WalkStack {
public:
    using Place = std::conditional_t<wanted == Wanted::any, std::uint32_t, std::uint64_t>;
    static constexpr std::uint32_t end = WideChild::none().word;
    // Places below the lowest that is used: pops for near answers read whole vectors.
    static constexpr int below = wanted == Wanted::near && compresses ? 8 : 0;
    // Places for the walk of a tree of `depth` levels, with room for pushes, which write whole vectors.
    static constexpr int room(int depth) { return (below + depth * (W - 1) + 2 * W + 15) / 16 * 16; }

    HWY_INLINE WalkStack(Place* places, int bottom, int top) : places_(places), bottom_(bottom), top_(top) {
        for (int i = 0; i < below; ++i) places_[i] = 0;
    }
    HWY_INLINE void clear() {
        places_[bottom_] = end;
        top_ = bottom_ + 1;
    }
    HWY_INLINE int top() const { return top_; }
    HWY_INLINE std::uint32_t pop() { return static_cast<std::uint32_t>(places_[--top_]); }
    // The next child that is within the limit.
    HWY_INLINE std::uint32_t pop_within(float limit) requires(wanted != Wanted::any) {
        const std::uint64_t last = waiting(limit, end);
        do --top_;
        while (places_[top_] > last);
        return static_cast<std::uint32_t>(places_[top_]);
    }
    // As pop_within, several places at once: no branch depends on how many children are out of reach. Slow
    // for children that were pushed just now, since a vector is not forwarded from several stores.
    HWY_INLINE std::uint32_t pop_lanes_within(float limit) requires(wanted == Wanted::near) {
        if constexpr (below == 0) {
            return pop_within(limit);
        } else {
            constexpr hn::CappedTag<std::int64_t, 8> d;
            constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
            const auto last = hn::Set(d, static_cast<std::int64_t>(waiting(limit, end)));
            unsigned within;
            do {
                top_ -= lanes;
                const auto* const from = reinterpret_cast<const std::int64_t*>(places_ + top_);
                within = bits_of(d, hn::Not(hn::Gt(hn::LoadU(d, from), last)));
            } while (within == 0);
            top_ += static_cast<int>(std::bit_width(within)) - 1;
            return static_cast<std::uint32_t>(places_[top_]);
        }
    }
    HWY_INLINE void push(Place child) { places_[top_++] = child; }
    // Pushes the entered children: the nearest on top, or for any hit the last, which is the likeliest to
    // stop a ray (WideCollapse).
    HWY_INLINE void push(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (wanted == Wanted::any) {
            push_unsorted(boxes, children);
        } else if constexpr (Boxes<W>::parts == 1) {
            push_sorted(hn::RebindMask(i32, boxes.entered[0]), keys_of(boxes, 0), children);
        } else if constexpr (compresses && Boxes<W>::parts == 2) {
            const int count = std::popcount(boxes.bits());
            if (count <= Boxes<W>::lanes) [[likely]]
                push_compressed<4>(keys_in_front(boxes), count, children);
            else
                push(push_others_each(boxes, children));
        } else if (boxes.bits() != 0) {
            push(push_others_each(boxes, children));
        }
    }
    // Pushes the entered children except the one that would be on top, whose word is returned. It is known
    // before the others are sorted, so the walk can continue meanwhile.
    HWY_INLINE std::uint32_t push_others(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (wanted == Wanted::any) {
            return push_others_unsorted(boxes, children);
        } else if constexpr (Boxes<W>::parts == 1) {
            const auto entered = hn::RebindMask(i32, boxes.entered[0]);
            const Lanes keys = keys_of(boxes, 0);
            const Lanes nearest = hn::MinOfLanes(
                i32, hn::IfThenElse(entered, keys, hn::Set(i32, std::numeric_limits<std::int32_t>::max())));
            const auto others = hn::And(entered, hn::Ne(keys, nearest));
            if constexpr (wanted == Wanted::near && compresses)
                put(i32, static_cast<int>(hn::CountTrue(i32, others)), compressed(i32, keys, others),
                    compressed(i32, hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children)), others));
            else
                push_sorted(others, keys, children);
            return children[hn::GetLane(nearest) & (W - 1)];
        } else {
            return static_cast<std::uint32_t>(push_others_each(boxes, children));
        }
    }
    // Pushes the entered children and pops one, of them if there are any: without a branch, and without a
    // wait for what was just stored.
    HWY_INLINE std::uint32_t push_and_pop(const Boxes<W>& boxes,
                                          const std::uint32_t* children) requires(wanted == Wanted::any) {
        const unsigned entered = boxes.bits();
        const std::uint32_t first = children[std::countr_zero(entered) & (W - 1)];
        const std::uint32_t before = places_[top_ - 1];
        top_ -= entered == 0;
        push_bits_unsorted(entered & (entered - 1), children);
        return entered != 0 ? first : before;
    }
    // Removes children that a hit has put out of reach, so that a pop need not check them.
    HWY_INLINE void sweep(float s_limit) requires(wanted == Wanted::closest) {
        const std::uint64_t limit = waiting(s_limit, end);
        const int top = top_;
        top_ = bottom_ + 1;
        for (int i = top_; i < top; ++i) {
            const Place child = places_[i];
            places_[top_] = child;
            top_ += child <= limit;
        }
    }

private:
    static constexpr hn::RebindToSigned<Floats<W>> i32{};
    using Lanes = hn::Vec<hn::RebindToSigned<Floats<W>>>;

    // `push` and `push_others` for any hit.
    HWY_INLINE void push_unsorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (compresses)
            for (int p = 0; p < Boxes<W>::parts; ++p)
                put_unsorted(hn::RebindMask(i32, boxes.entered[p]), children + p * Boxes<W>::lanes);
        else if constexpr (Boxes<W>::parts == 1)
            put_lanes_unsorted(boxes.bits(), children);
        else
            put_each_unsorted(boxes.bits(), children);
    }
    HWY_INLINE std::uint32_t push_others_unsorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        const unsigned entered = boxes.bits();
        const int last = static_cast<int>(std::bit_width(entered)) - 1;
        push_bits_unsorted(entered ^ (1u << last), children);
        return children[last];
    }
    HWY_INLINE void push_bits_unsorted(std::uint64_t entered, const std::uint32_t* children) {
        if constexpr (HWY_TARGET == HWY_AVX3)
            put_unsorted(hn::LoadMaskBits(i32, reinterpret_cast<const std::uint8_t*>(&entered)), children);
        else
            put_each_unsorted(static_cast<unsigned>(entered), children);
    }

    // A key is the entry of a child, with the child's number in the lowest bits.
    static HWY_INLINE Lanes keys_of(const Boxes<W>& boxes, int part) {
        const auto entry = hn::BitCast(i32, boxes.entry[part]);
        return hn::Or(hn::AndNot(hn::Set(i32, W - 1), entry), hn::Iota(i32, part * Boxes<W>::lanes));
    }
    // The keys of the entered children of a row that takes two vectors. One vector has room for them.
    static HWY_INLINE Lanes keys_in_front(const Boxes<W>& boxes) {
        const auto low = hn::RebindMask(i32, boxes.entered[0]), high = hn::RebindMask(i32, boxes.entered[1]);
        const int count = static_cast<int>(hn::CountTrue(i32, low));
        const Lanes from = hn::And(hn::Iota(i32, -count), hn::Set(i32, Boxes<W>::lanes - 1));
        return hn::IfThenElse(
            hn::FirstN(i32, static_cast<std::size_t>(count)), compressed(i32, keys_of(boxes, 0), low),
            hn::TableLookupLanes(compressed(i32, keys_of(boxes, 1), high), hn::IndicesFromVec(i32, from)));
    }
    HWY_INLINE void push_sorted(hn::Mask<decltype(i32)> entered, Lanes keys, const std::uint32_t* children) {
        const int count = static_cast<int>(hn::CountTrue(i32, entered));
        if constexpr (compresses && W > 4) {
            push_compressed<4>(compressed(i32, keys, entered), count, children);
        } else {
            const Lanes sorted = sorted_descending(i32, hn::IfThenElse(entered, keys, hn::Set(i32, -1)));
            put(i32, count, sorted, ordered(children, sorted));
        }
    }
    // Sorts and pushes compressed keys, in as few lanes as have room for them, but at least `lanes`.
    template <int lanes>
    HWY_INLINE void push_compressed(Lanes keys, int count, const std::uint32_t* children) {
        if constexpr (lanes < Boxes<W>::lanes)
            if (count > lanes) [[unlikely]]
                return push_compressed<2 * lanes>(keys, count, children);
        put_sorted(hn::CappedTag<std::int32_t, lanes>(), keys, count, children);
    }
    template <class D>
    HWY_INLINE void put_sorted(D d, Lanes keys, int count, const std::uint32_t* children) {
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
    static HWY_INLINE Lanes ordered(const std::uint32_t* children, Lanes keys) {
        constexpr int lanes = Boxes<W>::lanes;
        const auto place = hn::IndicesFromVec(i32, hn::And(keys, hn::Set(i32, lanes - 1)));
        const auto part = [&](int p) {
            const auto* const all = reinterpret_cast<const std::int32_t*>(children) + p * lanes;
            return hn::TableLookupLanes(hn::LoadU(i32, all), place);
        };
        if constexpr (Boxes<W>::parts == 1)
            return part(0);
        else
            return hn::IfThenElse(hn::Eq(hn::And(keys, hn::Set(i32, lanes)), hn::Zero(i32)), part(0),
                                  part(1));
    }
    template <class D, class V>
    HWY_INLINE void put(D d, int count, V keys, V children) {
        auto* const to = reinterpret_cast<std::int32_t*>(places_ + top_);
        hn::StoreInterleaved2(children, hn::AndNot(hn::Set(d, W - 1), keys), d, to);
        top_ += count;
    }
    HWY_INLINE void put_unsorted(hn::Mask<decltype(i32)> entered, const std::uint32_t* children) {
        const Lanes child = hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children));
        hn::StoreU(compressed(i32, child, entered), i32, reinterpret_cast<std::int32_t*>(places_ + top_));
        top_ += static_cast<int>(hn::CountTrue(i32, entered));
    }
    // Writes all children, and keeps those that are entered: no branch depends on which these are.
    HWY_INLINE void put_lanes_unsorted(unsigned entered, const std::uint32_t* children) {
        for (int i = 0; i < W; ++i) {
            places_[top_] = children[i];
            top_ += static_cast<int>(entered >> i & 1);
        }
    }
    HWY_INLINE void put_each_unsorted(unsigned entered, const std::uint32_t* children) {
        for (; entered != 0; entered &= entered - 1) places_[top_++] = children[std::countr_zero(entered)];
    }

    // ---- Without lanes, where a row takes several vectors ----

    // Pushes the entered children except the nearest, which is returned; at least one is entered. Up to four
    // are ordered by conditional moves, more are inserted one by one.
    HWY_INLINE Place push_others_each(const Boxes<W>& boxes, const std::uint32_t* children) {
        alignas(64) float at[W];
        boxes.store(at);
        unsigned entered = boxes.bits();
        const auto next = [&]() __attribute__((always_inline)) {
            const int i = std::countr_zero(entered);
            entered &= entered - 1;
            return waiting(at[i], children[i]);
        };
        Place a = next();
        if (entered == 0) return a;
        Place b = next();
        order(a, b);
        if (entered == 0) return push(b), a;
        Place c = next();
        order(b, c), order(a, b);
        if (entered == 0) return push(c), push(b), a;
        Place d = next();
        order(c, d), order(b, c), order(a, b);
        const Place* const base = places_ + top_;
        push(d), push(c), push(b);
        if (entered == 0) return a;
        push(a);
        while (entered != 0) insert(base, next());
        return places_[--top_];
    }
    // Inserts a child among those from `base` on.
    HWY_INLINE void insert(const Place* base, Place child) {
        Place* place = places_ + top_++;
        for (; place > base && place[-1] < child; --place) *place = place[-1];
        *place = child;
    }

    Place* places_;
    int bottom_, top_;
};

}  // namespace hedgerow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
