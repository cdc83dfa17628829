/// The answers of a batch whose queries have any number of answers each.
#pragma once

#include <algorithm>
#include <mutex>
#include <span>
#include <vector>

#include <hedgerow/parallel/executor.h>

namespace hedgerow {

/// A list of T for each query, all in one array.
template <class T>
class AnswerLists {
public:
    /// The number of queries.
    std::size_t size() const { return ends_.size(); }
    /// The answers to query i.
    std::span<const T> operator[](std::size_t i) const {
        const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
        return std::span<const T>(all_).subspan(begin, ends_[i] - begin);
    }
    /// The answers to all queries, in the order of the queries.
    const std::vector<T>& all() const { return all_; }

    void reserve(std::size_t questions, std::size_t answers) {
        ends_.reserve(questions), all_.reserve(answers);
    }
    void push_back(std::span<const T> list) {
        all_.insert(all_.end(), list.begin(), list.end());
        ends_.push_back(all_.size());
    }

private:
    std::vector<T> all_;
    std::vector<std::size_t> ends_;  // where each list ends among all answers
};

/// Calls `one(i, list)` for each query i below `count`, in pieces over the executor. `one` replaces what the
/// list holds. The result does not depend on how the work is cut.
template <class T, class One>
AnswerLists<T> answer_lists(std::size_t count, Executor& executor, One one) {
    struct Piece {
        std::size_t begin;
        AnswerLists<T> lists;
    };
    // Answer the pieces, which end in any order.
    std::vector<Piece> pieces;
    std::mutex adding;
    executor.for_each_piece(count, 256, [&](std::size_t begin, std::size_t end) {
        Piece piece{begin, {}};
        std::vector<T> list;
        for (std::size_t i = begin; i < end; ++i) {
            one(i, list);
            piece.lists.push_back(list);
        }
        const std::lock_guard lock(adding);
        pieces.push_back(std::move(piece));
    });
    // Join the pieces in the order of the queries.
    if (pieces.size() == 1) return std::move(pieces[0].lists);
    std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.begin < b.begin; });
    std::size_t answers = 0;
    for (const Piece& piece : pieces) answers += piece.lists.all().size();
    AnswerLists<T> joined;
    joined.reserve(count, answers);
    for (const Piece& piece : pieces)
        for (std::size_t i = 0; i < piece.lists.size(); ++i) joined.push_back(piece.lists[i]);
    return joined;
}

}  // namespace hedgerow
