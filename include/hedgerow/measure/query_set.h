/// The queries of a comparison: many of one kind, the same for all structures.
#pragma once

#include <algorithm>
#include <bit>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/measure/costs.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/questions.h>

namespace hedgerow::measure {

/// A hash of 64 bits to compare answers by: FNV-1a over words (Fowler, Noll and Vo 1991). Numbers are hashed
/// by value, so that 0 and −0 are the same.
class Fingerprint {
public:
    std::uint64_t value() const { return value_; }

    void add(std::uint64_t word) {
        for (int i = 0; i < 8; ++i, word >>= 8) value_ = (value_ ^ (word & 0xFF)) * 0x100000001B3u;
    }
    void add(std::uint32_t id) { add(std::uint64_t(id)); }
    void add(bool yes) { add(std::uint64_t(yes)); }
    void add(double x) { add(std::bit_cast<std::uint64_t>(x + 0.0)); }
    void add(float x) { add(double(x)); }
    template <class T>
    void add(const Hit<T>& h) {
        add(h.t), add(h.u), add(h.v), add(h.primitive), add(h.element);
    }
    template <class T, int D>
    void add(const Near<T, D>& n) {
        add(n.distance2), add(n.primitive), add(n.element);
        for (int k = 0; k < D; ++k) add(n.point[k]);
    }
    template <class T, int D>
    void add(const NearAndFeature<T, D>& n) {
        add(n.near), add(std::uint64_t(n.where.feature)), add(std::uint64_t(n.where.number));
        for (const T weight : n.where.weights) add(weight);
        for (int k = 0; k < D; ++k) add(n.where.normal[k]);
    }
    void add(std::int8_t sign) { add(std::uint64_t(sign + 1)); }
    template <class E>
    void add(const std::vector<E>& all) {
        add(std::uint64_t(all.size()));
        for (const E& e : all) add(e);
    }

private:
    std::uint64_t value_ = 0xCBF29CE484222325u;
};

/// Many queries of one kind, with memory for their answers, so that repeating the queries allocates nothing.
template <std::floating_point T, int D>
class QuerySet {
public:
    virtual ~QuerySet() = default;
    /// The name of the question in the table of questions, and the kind of queries: "closest hit, random
    /// rays".
    virtual Ask ask() const = 0;
    virtual const std::string& kind() const = 0;
    virtual std::size_t size() const = 0;
    /// Every step-th query, from the first on.
    virtual std::unique_ptr<QuerySet> thinned(std::size_t step) const = 0;
    /// Makes all queries and discards the answers. This is the timed work.
    virtual void put_to(const AnyIndex<T, D>& index) = 0;
    /// Makes all queries, adds their visits to `visits`, and returns a fingerprint of each answer. Checks the
    /// progress every 16 queries, and throws Cancelled if it is cancelled.
    virtual std::vector<std::uint64_t> answers(const AnyIndex<T, D>& index, Visits& visits,
                                               const Progress& progress = {}) = 0;
};

/// Many queries of one question of the table.
template <class Question, std::floating_point T, int D>
class QuerySetOf final : public QuerySet<T, D> {
public:
    using Given = typename Question::Given;
    using Answer = typename Question::Answer;

    QuerySetOf(std::string kind, std::vector<Given> given)
        : kind_(std::move(kind)),
          given_(std::move(given)),
          answers_(new Answer[AsksMany<Question> ? size() : 1]) {}

    Ask ask() const override { return Question::name; }
    const std::string& kind() const override { return kind_; }
    std::size_t size() const override { return given_.size(); }
    std::unique_ptr<QuerySet<T, D>> thinned(std::size_t step) const override {
        std::vector<Given> some;
        for (std::size_t i = 0; i < size(); i += step) some.push_back(given_[i]);
        return std::make_unique<QuerySetOf>(kind_, std::move(some));
    }
    void put_to(const AnyIndex<T, D>& index) override {
        each_answer(index, 0, size(), {}, [](const Answer&) {});
    }
    std::vector<std::uint64_t> answers(const AnyIndex<T, D>& index, Visits& visits,
                                       const Progress& progress = {}) override {
        std::vector<std::uint64_t> prints;
        std::vector<Visits> each(size());
        constexpr std::size_t some = 16;
        for (std::size_t first = 0; first < size(); first += some) {
            progress.look();
            const std::size_t count = std::min(some, size() - first);
            each_answer(index, first, count, std::span(each).subspan(first, count),
                        [&](const Answer& answer) {
                            Fingerprint print;
                            print.add(answer);
                            prints.push_back(print.value());
                        });
        }
        for (const Visits& v : each) visits += v;
        return prints;
    }

private:
    /// Calls f(answer) for each of `count` queries, in order from number `first` on. `visits` has one element
    /// for each of these queries, or none.
    template <class F>
    void each_answer(const AnyIndex<T, D>& index, std::size_t first, std::size_t count,
                     std::span<Visits> visits, F f) {
        if constexpr (AsksMany<Question>) {
            const std::span<Answer> found(answers_.get() + first, count);
            Question::ask_all(index, std::span<const Given>(given_).subspan(first, count), found, visits);
            for (const Answer& answer : found) f(answer);
        } else {
            Visits nobodys;
            for (std::size_t i = 0; i < count; ++i) {
                Question::ask(index, given_[first + i], answers_[0], visits.empty() ? nobodys : visits[i]);
                f(answers_[0]);
            }
        }
    }

    std::string kind_;
    std::vector<Given> given_;
    std::unique_ptr<Answer[]> answers_;  // one, which is reused, where a question is asked one by one
};

}  // namespace hedgerow::measure
