/// The answers of questions that give a list for each of many queries.
#pragma once

#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include <hedgerow/base/buffer.h>
#include <hedgerow/parallel/executor.h>
#include <hedgerow/queries/hit.h>

namespace hedgerow {

/// The columns of lists of hits, which are read whole.
template <std::floating_point T>
struct HitColumns {
    Buffer<Hit<T>> hits;

    using Row = std::span<const Hit<T>>;
    Row row(std::size_t begin, std::size_t end) const { return {hits.begin() + begin, hits.begin() + end}; }
    template <class F>
    static void each(F f) {
        f(&HitColumns::hits);
    }
};
/// Those of lists of primitives: positions in the set, or PlacedIds among instances.
template <class Id>
struct IdColumns {
    Buffer<Id> ids;

    using Row = std::span<const Id>;
    Row row(std::size_t begin, std::size_t end) const { return {ids.begin() + begin, ids.begin() + end}; }
    template <class F>
    static void each(F f) {
        f(&IdColumns::ids);
    }
};
/// Those of lists of what is near: primitives, and their squared distances, which may be left out.
template <std::floating_point T, class Id>
struct NearColumns {
    Buffer<Id> ids;
    Buffer<T> distances2;

    struct Row {
        std::span<const Id> ids;
        std::span<const T> distances2;
        std::size_t size() const { return ids.size(); }
        bool empty() const { return ids.empty(); }
    };
    Row row(std::size_t begin, std::size_t end) const {
        return {{ids.begin() + begin, ids.begin() + end},
                distances2.empty()
                    ? std::span<const T>()
                    : std::span<const T>(distances2.begin() + begin, distances2.begin() + end)};
    }
    template <class F>
    static void each(F f) {
        f(&NearColumns::ids), f(&NearColumns::distances2);
    }
};

/// A list for each of many queries: the elements of list i stand from offsets[i] to offsets[i + 1] in each
/// column. What a question finds replaces what the lists hold, in the same memory: their own, or the
/// caller's (`lists_in`).
///
///   HitLists<float> lists;
///   all_hits(index, rays, lists);
///   for (const Hit<float>& hit : lists[7]) ...
template <class C>
struct Lists : C {
    Buffer<std::size_t> offsets;

    /// The number of lists.
    std::size_t size() const { return offsets.empty() ? 0 : offsets.size() - 1; }
    bool empty() const { return size() == 0; }
    /// List i: a span, or a struct with a span for each column.
    typename C::Row operator[](std::size_t i) const { return this->row(offsets[i], offsets[i + 1]); }
    /// The number of elements of all lists.
    std::size_t count() const { return offsets.empty() ? 0 : offsets.back(); }

    /// Whether all memory is the lists' own.
    bool own() const {
        bool own = !offsets.borrows();
        C::each([&](auto column) { own = own && !(this->*column).borrows(); });
        return own;
    }
    /// No lists.
    void clear() {
        offsets.resize(1), offsets[0] = 0;
        C::each([&](auto column) { (this->*column).clear(); });
    }
    /// Makes these the lists of some parts, one after the other. Throws InputError where the caller's arrays
    /// lack room; all offsets are written before.
    void join(std::span<const Lists> parts) {
        std::size_t lists = 0, elements = 0;
        for (const Lists& part : parts) lists += part.size();
        clear();
        offsets.resize(lists + 1);
        std::size_t list = 0;
        for (const Lists& part : parts) {
            for (std::size_t i = 1; i <= part.size(); ++i) offsets[++list] = elements + part.offsets[i];
            elements += part.count();
        }
        C::each([&](auto column) {
            std::size_t size = 0;  // 0 for a column that is left out
            for (const Lists& part : parts) size += (part.*column).size();
            auto& to = this->*column;
            to.resize(size);
            auto* end = to.data();
            for (const Lists& part : parts)
                end = std::copy((part.*column).begin(), (part.*column).end(), end);
        });
    }
    /// Makes these the lists of others, which end empty: by a copy if the memory is the caller's.
    void take(Lists&& others) {
        if (own())
            *this = std::exchange(others, {});
        else
            join({&others, 1});
    }
    friend bool operator==(const Lists& a, const Lists& b) {
        bool equal = a.offsets == b.offsets;
        C::each([&](auto column) { equal = equal && a.*column == b.*column; });
        return equal;
    }
};
template <std::floating_point T>
using HitLists = Lists<HitColumns<T>>;
template <class Id = PrimitiveId>
using IdLists = Lists<IdColumns<Id>>;
template <std::floating_point T, class Id = PrimitiveId>
using NearLists = Lists<NearColumns<T, Id>>;

/// Lists in the caller's arrays: of offsets, which must be one more than there are queries, and of each
/// column. A question throws InputError, which says how much room is wanted, where an array is too short;
/// the offsets say so too if there are enough of them.
///
///   auto lists = lists_in(std::span(offsets), std::span(ids), std::span(distances2));
///   within(index, points, 0.5f, lists);
template <std::floating_point T>
HitLists<T> lists_in(std::span<std::size_t> offsets, std::span<Hit<T>> hits) {
    return {{hits}, offsets};
}
template <class Id>
IdLists<Id> lists_in(std::span<std::size_t> offsets, std::span<Id> ids) {
    return {{ids}, offsets};
}
template <class Id, std::floating_point T>
NearLists<T, Id> lists_in(std::span<std::size_t> offsets, std::span<Id> ids, std::span<T> distances2) {
    return {{ids, distances2}, offsets};
}

namespace detail {
/// Fills lists in memory of their own by f, and hands them over.
template <class L, class F>
void list_in_own_memory(L& lists, F f) {
    if (lists.own()) return f(lists);
    L own;
    f(own);
    lists.take(std::move(own));
}
/// Fills `lists` with those of `count` queries, in pieces over the executor: answer(begin, end, to) appends
/// the lists of queries `begin` to `end` to some. The lists do not depend on how the work is cut. Over
/// several threads it takes the memory of the answers twice; in one, lists that have the memory allocate
/// nothing.
template <class C, class Answer>
void list_in_pieces(std::size_t count, Executor& executor, Lists<C>& lists, Answer answer) {
    constexpr std::size_t piece = 256;
    // The executor cuts the row of pieces; the lists of each cut are joined in the order of the queries.
    const std::size_t pieces = (count + piece - 1) / piece;
    std::vector<Lists<C>> cuts;
    std::once_flag cut_at_all;
    lists.clear();
    executor.for_each_piece(pieces, 1, [&](std::size_t begin, std::size_t end) {
        if (begin == end) return;  // an executor may cut empty pieces
        if (end - begin == pieces && lists.own()) return answer(std::size_t(0), count, lists);
        std::call_once(cut_at_all, [&] { cuts.resize(pieces); });
        Lists<C>& cut = cuts[begin];
        cut.clear();
        answer(begin * piece, std::min(end * piece, count), cut);
    });
    if (!cuts.empty()) lists.join(cuts);
}
}  // namespace detail

}  // namespace hedgerow
