/// The answers of a batch whose queries have any number of answers each.
#pragma once

#include <memory>
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
    // Answer the pieces: pieces[i] has the lists of the piece that begins with query i, if one does.
    std::vector<std::unique_ptr<AnswerLists<T>>> pieces(count);
    executor.for_each_piece(count, 256, [&](std::size_t begin, std::size_t end) {
        if (begin == end) return;  // an executor may cut empty pieces
        auto piece = std::make_unique<AnswerLists<T>>();
        std::vector<T> list;
        for (std::size_t i = begin; i < end; ++i) {
            one(i, list);
            piece->push_back(list);
        }
        pieces[begin] = std::move(piece);
    });
    // Join the pieces in the order of the queries.
    if (count > 0 && pieces[0]->size() == count) return std::move(*pieces[0]);
    std::erase(pieces, nullptr);
    std::size_t answers = 0;
    for (const auto& piece : pieces) answers += piece->all().size();
    AnswerLists<T> joined;
    joined.reserve(count, answers);
    for (const auto& piece : pieces)
        for (std::size_t i = 0; i < piece->size(); ++i) joined.push_back((*piece)[i]);
    return joined;
}

}  // namespace hedgerow
