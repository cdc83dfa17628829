/// What all structures of a comparison are asked: one kind of query, many times.
#pragma once

#include <bit>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/compare/costs.h>

namespace hedgerow::compare {

/// 64 bits that tell answers apart: FNV-1a over words (Fowler, Noll and Vo 1991). Numbers count by value, so
/// that 0 and −0 are the same.
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

/// Queries of one kind, and room for their answers, so that asking again allocates nothing.
template <std::floating_point T, int D>
class Questions {
public:
    using Rays = std::vector<Ray<T, D>>;
    using Points = std::vector<Vec<T, D>>;
    using Boxes = std::vector<Box<T, D>>;
    using List = std::variant<Rays, Points, Boxes>;
    /// How many are nearest.
    static constexpr std::size_t k = 8;

    /// `list` holds what `ask` is about.
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
    /// Each step-th of them, from the first on.
    Questions thinned(std::size_t step) const {
        return std::visit(
            [&](const auto& all) {
                std::remove_cvref_t<decltype(all)> some;
                for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
                return Questions(ask_, kind_, std::move(some));
            },
            list_);
    }

    /// Asks them all and lets the answers go: what is timed.
    void put_to(const AnyIndex<T, D>& index) {
        each_answer(index, {}, [](const auto&) {});
    }
    /// A fingerprint of each answer, and what was visited in all.
    std::vector<std::uint64_t> answers(const AnyIndex<T, D>& index, Visits& visits) {
        std::vector<std::uint64_t> prints;
        std::vector<Visits> each(size());
        each_answer(index, each, [&](const auto& answer) {
            Fingerprint print;
            print.add(answer);
            prints.push_back(print.value());
        });
        for (const Visits& v : each) visits += v;
        return prints;
    }

private:
    /// f(answer) for each question in turn.
    template <class F>
    void each_answer(const AnyIndex<T, D>& index, std::span<Visits> visits, F f) {
        const auto count = [&](std::size_t i) { return visits.empty() ? nullptr : &visits[i]; };
        const auto one_by_one = [&](const auto& all, const auto& found, auto ask) {
            for (std::size_t i = 0; i < all.size(); ++i) {
                ask(all[i], count(i));
                f(found);
            }
        };
        switch (ask_) {
            case Ask::closest_hit:
                index.closest_hits(std::get<Rays>(list_), hits_, visits);
                for (const auto& h : hits_) f(h);
                break;
            case Ask::any_hit:
                index.any_hits(std::get<Rays>(list_), {any_.get(), size()}, visits);
                for (std::size_t i = 0; i < size(); ++i) f(any_[i]);
                break;
            case Ask::all_hits:
                one_by_one(std::get<Rays>(list_), hits_,
                           [&](const auto& ray, Visits* v) { index.all_hits(ray, hits_, v); });
                break;
            case Ask::closest_point:
                index.closest_points(std::get<Points>(list_), near_, visits);
                for (const auto& n : near_) f(n);
                break;
            case Ask::nearest:
                one_by_one(std::get<Points>(list_), near_,
                           [&](const auto& point, Visits* v) { index.nearest(point, k, near_, v); });
                break;
            case Ask::overlap:
                one_by_one(std::get<Boxes>(list_), ids_,
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
