// What is yet to be visited, in lanes: children are sorted and put on the stack, and taken off again, without
// a branch that depends on what was entered. (Read once for each instruction set.)

// Lane i ^ `with`: what the compare-exchange steps of a bitonic sort (Batcher 1968) are made of. Of a pair
// the lane in which the highest bit of `with` is 0 keeps the greater.
template <int with, class D, class V>
HWY_INLINE V lanes_crossed(D d, V v) {
    if constexpr (with == 1) return hn::Shuffle2301(v);
    if constexpr (with == 2) return hn::Shuffle1032(v);
    if constexpr (with == 3) return hn::Shuffle0123(v);
    if constexpr (with == 4) return hn::SwapAdjacentBlocks(v);
    if constexpr (with == 7) return hn::Reverse8(d, v);
    if constexpr (with == 15) return hn::Reverse(d, v);
}
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

// The entries (s, their bits as integers, whose order is the same since they are not negative) and words of a
// ray's stack. Its places are the caller's; the lowest holds what ends the walk.
template <int W>
class WalkStack {
public:
    static constexpr std::uint32_t end = WideChild::none().word;
    // Places that a tree's walk takes: what is pushed is written as whole vectors.
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
    // The children that were entered, the nearest on top.
    HWY_INLINE void push(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (Boxes<W>::parts == 1)
            push_sorted(boxes, children);
        else
            push_each(boxes, children);
    }
    // The same in any order, and without their entries: for who stops at the first hit.
    HWY_INLINE void push_unsorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        if constexpr (Boxes<W>::parts == 1 && !compresses) {
            push_sorted(boxes, children);  // which takes less than a compress by table
        } else if constexpr (Boxes<W>::parts == 1) {
            constexpr hn::RebindToSigned<Floats<W>> i32;
            const auto mask = hn::RebindMask(i32, boxes.entered[0]);
            hn::StoreU(hn::Compress(hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children)), mask),
                       i32, reinterpret_cast<std::int32_t*>(words_) + top_);
            top_ += static_cast<int>(hn::CountTrue(i32, mask));
        } else {
            for (unsigned entered = boxes.bits(); entered != 0; entered &= entered - 1)
                words_[top_++] = children[std::countr_zero(entered)];
        }
    }
    // Takes off what a hit has put out of reach, so that nothing has to be asked when it is popped.
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
    // Whether compress is an instruction.
    static constexpr bool compresses = HWY_TARGET == HWY_AVX3;

    HWY_INLINE void push_sorted(const Boxes<W>& boxes, const std::uint32_t* children) {
        constexpr hn::RebindToSigned<Floats<W>> i32;
        // The lowest bits of a key tell the child.
        const auto lane = hn::Iota(i32, 0), low = hn::Set(i32, W - 1), none = hn::Set(i32, -1);
        const auto mask = hn::RebindMask(i32, boxes.entered[0]);
        auto key =
            hn::IfThenElse(mask, hn::Or(hn::AndNot(low, hn::BitCast(i32, boxes.entry[0])), lane), none);
        const int count = static_cast<int>(hn::CountTrue(i32, mask));
        const auto child = hn::LoadU(i32, reinterpret_cast<const std::int32_t*>(children));
        if constexpr (W == 16) {
            if (count <= 8) [[likely]] {
                constexpr hn::Half<hn::RebindToSigned<Floats<W>>> half;
                const auto few =
                    hn::IfThenElse(hn::FirstN(half, static_cast<std::size_t>(count)),
                                   hn::LowerHalf(half, hn::Compress(key, mask)), hn::Set(half, -1));
                key = hn::ZeroExtendVector(i32, sorted_descending(half, few));
                return put(half, count, hn::LowerHalf(half, key),
                           hn::LowerHalf(half, ordered(i32, child, key)));
            }
        }
        key = sorted_descending(i32, key);
        put(i32, count, key, ordered(i32, child, key));
    }
    // The children in the order of their keys.
    template <class D, class V>
    static HWY_INLINE V ordered(D d, V children, V keys) {
        return hn::TableLookupLanes(children, hn::IndicesFromVec(d, hn::And(keys, hn::Set(d, W - 1))));
    }
    template <class D, class V>
    HWY_INLINE void put(D d, int count, V keys, V children) {
        hn::StoreU(hn::AndNot(hn::Set(d, W - 1), keys), d, entries_ + top_);
        hn::StoreU(children, d, reinterpret_cast<std::int32_t*>(words_) + top_);
        top_ += count;
    }
    // The same where a row takes several vectors.
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
