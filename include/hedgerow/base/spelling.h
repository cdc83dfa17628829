/// "Did you mean": the known word nearest to a misspelt one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hedgerow {

/// The number of single-letter insertions, deletions, replacements and swaps of neighbours that turn a into b
/// (optimal string alignment; Damerau 1964). Ignores the case of ASCII letters. O(|a|·|b|) time, O(|b|)
/// memory.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    const auto same = [&](std::size_t i, std::size_t k) { return lower(a[i]) == lower(b[k]); };
    std::vector<std::size_t> two_above(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::swap(two_above, above);
        std::swap(above, row);
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            row[k] = std::min({above[k] + 1, row[k - 1] + 1, above[k - 1] + (same(i - 1, k - 1) ? 0 : 1)});
            if (i > 1 && k > 1 && same(i - 1, k - 2) && same(i - 2, k - 1))
                row[k] = std::min(row[k], two_above[k - 2] + 1);
        }
    }
    return row[b.size()];
}

/// Returns " (did you mean 'terrain'?)", to be appended to an error message, or "" if no known word is near.
/// A known word is near if its edit distance is at most a third of the longer word (at least 1). If none is,
/// a known word that contains `wrong` counts, where `wrong` has at least three letters. The first of equally
/// near words wins.
inline std::string suggestion(std::string_view wrong, std::span<const std::string_view> known) {
    std::string_view best;
    std::size_t nearest = std::string_view::npos;
    for (const std::string_view word : known) {
        const std::size_t distance = edit_distance(wrong, word);
        if (distance <= std::max<std::size_t>(1, std::max(wrong.size(), word.size()) / 3) &&
            distance < nearest)
            best = word, nearest = distance;
    }
    if (best.empty() && wrong.size() >= 3)
        for (const std::string_view word : known)
            if (best.empty() && word.find(wrong) != std::string_view::npos) best = word;
    return best.empty() ? "" : " (did you mean '" + std::string(best) + "'?)";
}

}  // namespace hedgerow
