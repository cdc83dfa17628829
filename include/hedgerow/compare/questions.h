/// The queries of a comparison: many of one kind, the same for all structures.
#pragma once

#include <algorithm>
#include <bit>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/compare/costs.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow::compare {

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
    template <class E>
    void add(const std::vector<E>& all) {
        add(std::uint64_t(all.size()));
        for (const E& e : all) add(e);
    }

private:
    std::uint64_t value_ = 0xCBF29CE484222325u;
};

/// Queries of one kind, with memory for their answers, so that repeating the queries allocates nothing.
template <std::floating_point T, int D>
class Questions {
public:
    using Rays = std::vector<Ray<T, D>>;
    using Points = std::vector<Vec<T, D>>;
    using Boxes = std::vector<Box<T, D>>;
    using List = std::variant<Rays, Points, Boxes>;
    /// Number of neighbours that Ask::nearest finds.
    static constexpr std::size_t k = 8;

    /// `list` holds the probes of the queries: rays, points or boxes, as `ask` needs.
    Questions(Ask ask, std::string kind, List list)
        : ask_(ask), kind_(std::move(kind)), list_(std::move(list)), any_(new bool[size()]) {
        hits_.resize(ask == Ask::closest_hit ? size() : 0);
        near_.resize(ask == Ask::closest_point ? size() : 0);
    }

    Ask ask() const { return ask_; }
    const std::string& kind() const { return kind_; }
    std::size_t size() const {
        return std::visit([](const auto& all) { return all.size(); }, list_);
    }
    /// Every step-th query, from the first on.
    Questions thinned(std::size_t step) const {
        return std::visit(
            [&](const auto& all) {
                std::remove_cvref_t<decltype(all)> some;
                for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
                return Questions(ask_, kind_, std::move(some));
            },
            list_);
    }

    /// Makes all queries and discards the answers. This is the timed work.
    void put_to(const AnyIndex<T, D>& index) {
        each_answer(index, 0, size(), {}, [](const auto&) {});
    }
    /// Makes all queries, adds their visits to `visits`, and returns a fingerprint of each answer. Checks the
    /// progress every 16 queries, and throws Cancelled if it is cancelled.
    std::vector<std::uint64_t> answers(const AnyIndex<T, D>& index, Visits& visits,
                                       const Progress& progress = {}) {
        std::vector<std::uint64_t> prints;
        std::vector<Visits> each(size());
        constexpr std::size_t some = 16;
        for (std::size_t first = 0; first < size(); first += some) {
            progress.look();
            const std::size_t count = std::min(some, size() - first);
            each_answer(index, first, count, std::span(each).subspan(first, count), [&](const auto& answer) {
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
        // Queries with an answer of fixed size run as one batch; those with a list of answers run one by one
        // and reuse the list.
        const auto part = [&]<class E>(std::vector<E>& all) { return std::span(all).subspan(first, count); };
        const auto batch = [&](const auto& found, auto ask) {
            ask();
            for (const auto& answer : found) f(answer);
        };
        const auto one_by_one = [&](const auto& all, const auto& found, auto ask) {
            for (std::size_t i = 0; i < count; ++i) {
                ask(all[i], visits.empty() ? nullptr : &visits[i]);
                f(found);
            }
        };
        switch (ask_) {
            case Ask::closest_hit:
                batch(part(hits_),
                      [&] { index.closest_hits(part(std::get<Rays>(list_)), part(hits_), visits); });
                break;
            case Ask::any_hit: {
                const std::span<bool> found(any_.get() + first, count);
                batch(found, [&] { index.any_hits(part(std::get<Rays>(list_)), found, visits); });
                break;
            }
            case Ask::all_hits:
                one_by_one(part(std::get<Rays>(list_)), hits_,
                           [&](const auto& ray, Visits* v) { index.all_hits(ray, hits_, v); });
                break;
            case Ask::closest_point:
                batch(part(near_),
                      [&] { index.closest_points(part(std::get<Points>(list_)), part(near_), visits); });
                break;
            case Ask::nearest:
                one_by_one(part(std::get<Points>(list_)), near_,
                           [&](const auto& point, Visits* v) { index.nearest(point, k, near_, v); });
                break;
            case Ask::overlap:
                one_by_one(part(std::get<Boxes>(list_)), ids_,
                           [&](const auto& box, Visits* v) { index.overlapping(box, ids_, v); });
                break;
        }
    }

    Ask ask_;
    std::string kind_;
    List list_;
    std::unique_ptr<bool[]> any_;
    std::vector<Hit<T>> hits_;
    std::vector<Near<T, D>> near_;
    std::vector<PrimitiveId> ids_;
};

}  // namespace hedgerow::compare
