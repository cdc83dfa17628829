/// Lists of what is near many points: in rows as wide as the longest may be, and without what is left out.
#pragma once

#include <utility>

#include <hedgerow/queries/lists.h>
#include <hedgerow/queries/point_query.h>

namespace hedgerow {

/// The places for the list of one point, in both columns. Those behind its end have no primitive
/// (`no_primitive`).
template <std::floating_point T, class Id = PrimitiveId>
struct NearRow {
    std::span<Id> ids;
    std::span<T> distances2;
};

namespace detail {
inline PrimitiveId element_of_id(PrimitiveId id) {
    return id;
}
inline PrimitiveId element_of_id(const PlacedId& id) {
    return id.element;
}

/// Moves rows together to lists, of at most `most` elements each and without those that the options leave out
/// or do not see. begin_end(i) says where row i stands; it is called in the order of the rows, before list i
/// is written.
template <std::floating_point T, class Id, class Row>
void pack_rows(NearLists<T, Id>& rows, std::size_t count, std::size_t most, const PointOptions& options,
               Row begin_end) {
    const Mask& mask = options.mask;
    rows.offsets.resize(count + 1);
    std::size_t* const offsets = rows.offsets.data();
    Id* const ids = rows.ids.data();
    T* const distances2 = rows.distances2.data();
    std::size_t end = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const PrimitiveId without = options.leave_out.of(i);
        const std::size_t first = end;
        auto [k, last] = begin_end(i);
        // A row that loses nothing, and has moved nowhere, stays as it is.
        if (without == no_primitive && mask.none() && k == end && last - k <= most) k = end = last;
        for (; k < last && end - first < most; ++k) {
            const PrimitiveId element = element_of_id(ids[k]);
            if (element == without || !mask.sees(element)) continue;
            if (end != k) ids[end] = ids[k], distances2[end] = distances2[k];
            ++end;
        }
        offsets[i + 1] = end;
    }
    offsets[0] = 0;
    rows.ids.resize(end), rows.distances2.resize(end);
}
/// Packs rows of `width` places, which end at the first without a primitive.
template <std::floating_point T, class Id>
void pack_rows_of_places(NearLists<T, Id>& rows, std::size_t count, std::size_t width, std::size_t most,
                         const PointOptions& options) {
    pack_rows(rows, count, most, options, [&](std::size_t i) {
        const std::size_t first = i * width;
        std::size_t last = first + width;  // rows are full, but for a few
        while (last > first && element_of_id(rows.ids[last - 1]) == no_primitive) --last;
        return std::pair(first, last);
    });
}
/// Takes the elements that the options leave out, or do not see, from lists.
template <std::floating_point T, class Id>
void leave_out_of(NearLists<T, Id>& lists, const PointOptions& options) {
    if (options.leave_out.none() && options.mask.none()) return;
    std::size_t begin = 0;
    pack_rows(lists, lists.size(), lists.count(), options, [&](std::size_t i) {
        const std::size_t end = lists.offsets[i + 1];
        return std::pair(std::exchange(begin, end), end);
    });
}
/// Rows of the k nearest of each of many points.
template <std::floating_point T, class Id>
struct NearRows {
    Id* ids;
    T* distances2;
    std::size_t width;

    NearRow<T, Id> operator[](std::size_t i) const {
        return {{ids + i * width, width}, {distances2 + i * width, width}};
    }
};
/// Lists the k nearest of each of `count` points, whose rows write(rows) fills in any order. They have a
/// place more for what is left out, which a search may find.
template <std::floating_point T, class Id, class Write>
void list_by_rows(NearLists<T, Id>& lists, std::size_t count, std::size_t k, const PointOptions& options,
                  Write write) {
    const std::size_t width = options.leave_out.none() ? k : k + 1;
    lists.ids.resize(width * count), lists.distances2.resize(width * count);
    write(NearRows<T, Id>{lists.ids.data(), lists.distances2.data(), width});
    pack_rows_of_places(lists, count, width, k, options);
}
}  // namespace detail

}  // namespace hedgerow
