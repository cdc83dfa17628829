/// Comparisons of the lists of batches with the answers of single queries.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/ask/points.h>

/// Whether a list of a batch is what a single query found.
template <class T>
bool same_list(std::span<const T> list, const std::vector<T>& found) {
    return std::equal(list.begin(), list.end(), found.begin(), found.end());
}
template <class T, int D>
bool is_id(hedgerow::PrimitiveId id, const hedgerow::Near<T, D>& near) {
    return id == near.element;
}
template <class T, int D>
bool is_id(const hedgerow::PlacedId& id, const hedgerow::Near<T, D>& near) {
    return id == hedgerow::PlacedId{near.instance, near.element};
}
template <class Row, class T, int D>
bool same_list(const Row& list, const std::vector<hedgerow::Near<T, D>>& found) {
    if (list.ids.size() != found.size() || list.distances2.size() != found.size()) return false;
    for (std::size_t k = 0; k < found.size(); ++k)
        if (!is_id(list.ids[k], found[k]) || list.distances2[k] != found[k].distance2) return false;
    return true;
}
