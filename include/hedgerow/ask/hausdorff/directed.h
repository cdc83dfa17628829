/// The directed Hausdorff distance of two indexes: blocks of elements first, then corners, then rounds over
/// parts of triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <hedgerow/ask/hausdorff/blocks.h>
#include <hedgerow/ask/hausdorff/farthest.h>
#include <hedgerow/ask/hausdorff/part_bounds.h>
#include <hedgerow/ask/hausdorff/shared_triangles.h>

namespace hedgerow::detail {

/// The directed distance from index A to index B, if it is above `at_least`.
template <class IA, class IB>
class DirectedHausdorff {
public:
    using A = typename IA::Primitives;
    using B = typename IB::Primitives;
    using T = typename A::Scalar;
    static constexpr int dimension = A::dimension;
    using Point = Vec<T, dimension>;
    using Result = Hausdorff<T, dimension>;

    DirectedHausdorff(const IA& a, const IB& b, const HausdorffOptions& options, Executor& executor,
                      double at_least)
        : a_(a),
          b_(b),
          options_(options),
          threads_(executor),
          corners_{a.primitives()},
          scale_(scale_to_one(std::max(reach(a.bounds()), reach(b.bounds())))),
          error_(std::max(reach(a.bounds()), reach(b.bounds()))),
          farthest_(b, error_, threads_, at_least),
          asked_(corners_, farthest_) {}

    Result run() {
        gather();
        prune_blocks();
        ask_corners();
        if constexpr (TriangleSet<A>) {
            settle();
            bound_triangles();
            const std::size_t waiting = waiting_.size();
            const std::size_t most = std::max(waiting + options_.most_parts, waiting);  // the sum may wrap
            while (settle(), !waiting_.empty() || (!parts_.empty() && parts_.size() <= most)) refine();
            for (const auto& part : parts_) upper_ = std::max(upper_, part.bound);
        }
        Result result = farthest_.best();
        result.lower = rounded_down<T>(farthest_.lower());
        result.upper = rounded_up<T>(std::max(farthest_.lower(), upper_));
        return result;
    }

private:
    using Parts = std::vector<TrianglePart>;
    /// A triangle that may be the farthest, and of which nothing but its corners is known.
    struct Waiting {
        double bound;
        PrimitiveId element;
    };
    static constexpr std::size_t parts_a_round = 4096;  // the more, the fuller batches; the fewer, the fewer

    static double reach(const Box<T, dimension>& box) {
        return static_cast<double>(std::max(T(0), max_component(max(abs(box.low), abs(box.high)))));
    }
    PartBounds<B> bounds() const { return {b_.primitives(), error_, scale_, farthest_.lower(), wanted_}; }

    /// Lists the elements of A that B has not.
    void gather() {
        elements_.reserve(a_.size());
        for (std::size_t i = 0; i < a_.size(); ++i)
            if (const auto id = static_cast<PrimitiveId>(i); detail::holds(a_.structure(), id))
                elements_.push_back(id);
        if constexpr (TriangleSet<A> && TriangleSet<B>)
            drop_shared_triangles(
                a_.primitives(), elements_, b_.primitives(),
                [&](PrimitiveId id) { return detail::holds(b_.structure(), id); }, threads_,
                [&](PrimitiveId i, PrimitiveId j) {
                    const Point p = corners_[corners_.number(i, 0)];
                    farthest_.see(p, 0, i, {T(0), j, j, p});
                });
        asked_.make_room();
    }

    /// Drops blocks of elements that are near B: no point of one is farther than its middle's distance and
    /// its radius together. Large blocks first, then those of an eighth, as long as that promises something.
    void prune_blocks() {
        if (elements_.size() < 4096 || !blocks_promise()) return;
        sort_along_curve(a_.primitives(), a_.bounds(), elements_, threads_);
        for (std::size_t size = 512; size > 0 && elements_.size() > size; size /= 8) {
            std::vector<Middle> blocks((elements_.size() + size - 1) / size);
            const auto count = [&](std::size_t b) { return std::min(size, elements_.size() - b * size); };
            threads_.for_each_piece(blocks.size(), 1 + 4096 / size, [&](std::size_t begin, std::size_t end) {
                for (std::size_t b = begin; b < end; ++b)
                    blocks[b] = middle_of(corners_, &elements_[b * size], count(b));
            });
            ask_middles(blocks);
            std::size_t kept = 0, promising = 0;
            for (std::size_t b = 0; b < blocks.size(); ++b) {
                if (const double bound = bound_of(blocks[b], 1); bound <= enough_) {
                    upper_ = std::max(upper_, bound);
                    continue;
                }
                const auto first = elements_.begin() + static_cast<std::ptrdiff_t>(b * size);
                std::copy_n(first, count(b), elements_.begin() + static_cast<std::ptrdiff_t>(kept));
                kept += count(b);
                if (bound_of(blocks[b], 0.35) <= enough_) promising += count(b);  // 1 / √8 of the radius
            }
            elements_.resize(kept);
            if (promising < kept / 4) break;
        }
    }
    /// Whether many single elements would be dropped, by a sample.
    bool blocks_promise() {
        std::vector<Middle> sample;
        for (std::size_t i = 0; i < elements_.size(); i += elements_.size() / 128)
            sample.push_back(middle_of(corners_, &elements_[i], 1));
        ask_middles(sample);
        std::size_t near = 0;
        for (const Middle& middle : sample) near += bound_of(middle, 1) <= enough_;
        return near >= sample.size() / 4;
    }
    void ask_middles(const std::vector<Middle>& middles) {
        for (const Middle& middle : middles) asked_.ask(middle.corner, middle.element);
        asked_.finish();
        settle();
    }
    double bound_of(const Middle& middle, double part_of_radius) const {
        return asked_[middle.corner].distance + product(middle.radius, part_of_radius) + error_.absolute;
    }

    /// Asks for the corners of what is left.
    void ask_corners() {
        for (const PrimitiveId element : elements_)
            for (std::size_t k = 0; k < corners_.per_element; ++k)
                asked_.ask(corners_.number(element, k), element);
        asked_.finish();
        if constexpr (PointSet<A>)
            for (const PrimitiveId element : elements_)
                upper_ = std::max(upper_, asked_[corners_.number(element, 0)].distance);
    }

    /// A triangle of A whose corners have been asked for.
    TrianglePart whole(PrimitiveId element) const {
        TrianglePart part(element);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t number = corners_.number(element, k);
            part.corner[k] = Vec3d(corners_[number]);
            part.distance[k] = asked_[number].distance, part.nearest[k] = asked_[number].nearest;
        }
        return part;
    }
    /// Lists the triangles whose bound is not low enough.
    void bound_triangles() {
        constexpr std::size_t block = 4096;
        std::vector<std::vector<Waiting>> lists((elements_.size() + block - 1) / block);
        std::vector<double> greatest(lists.size(), 0);  // of the bounds of triangles that are dropped
        threads_.for_each_piece(lists.size(), 1, [&](std::size_t begin, std::size_t end) {
            auto known = bounds();
            for (std::size_t i = begin * block; i < std::min(elements_.size(), end * block); ++i) {
                TrianglePart part = whole(elements_[i]);
                known.bound(part);
                if (part.bound > enough_)
                    lists[i / block].push_back({part.bound, part.element});
                else
                    greatest[i / block] = std::max(greatest[i / block], part.bound);
            }
        });
        for (const auto& list : lists) waiting_.insert(waiting_.end(), list.begin(), list.end());
        for (const double bound : greatest) upper_ = std::max(upper_, bound);
        elements_ = {};
    }

    /// Drops what is within the tolerance.
    void settle() {
        const double lower = farthest_.lower();
        wanted_ = lower + std::max({options_.absolute, product(options_.relative, lower), error_.of(lower)});
        enough_ = PointSet<A> ? lower : std::max(wanted_, lower + error_.of_rounded(lower));
        const auto settled = [&](const auto& part) {
            if (part.bound > enough_) return false;
            upper_ = std::max(upper_, part.bound);
            return true;
        };
        std::erase_if(waiting_, settled);
        std::erase_if(parts_, settled);
    }

    /// Moves what has the greatest bounds to the end of a list. Returns where that begins.
    template <class List>
    static typename List::iterator greatest(List& list) {
        const auto first = list.end() - static_cast<std::ptrdiff_t>(std::min(parts_a_round, list.size()));
        std::nth_element(list.begin(), first, list.end(),
                         [](const auto& s, const auto& t) { return s.bound < t.bound; });
        return first;
    }
    /// Takes the parts of the greatest bounds, triangles first. Asks for the closest point of the centroid,
    /// or, where that is known, divides the part in two.
    void refine() {
        Parts parts;
        if (!waiting_.empty()) {
            const auto first = greatest(waiting_);
            for (auto i = first; i != waiting_.end(); ++i) parts.push_back(whole(i->element));
            waiting_.erase(first, waiting_.end());
        } else {
            const auto first = greatest(parts_);
            parts.assign(first, parts_.end());
            parts_.erase(first, parts_.end());
        }
        divide(parts);
        threads_.for_each_piece(parts.size(), 256, [&](std::size_t begin, std::size_t end) {
            auto known = bounds();
            for (std::size_t i = begin; i < end; ++i) known.bound(parts[i]);
        });
        parts_.insert(parts_.end(), parts.begin(), parts.end());
    }
    /// Asks for a point of each part, and makes two of each that is divided there.
    void divide(Parts& parts) {
        std::vector<Vec3d> exact;
        std::vector<Point> points;
        parts.reserve(2 * parts.size());
        for (const auto& part : parts) {
            exact.push_back(part.asked_middle ? part.cut() : part.centroid());
            points.emplace_back(exact.back());
        }
        const auto& found = farthest_.ask(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            TrianglePart& part = parts[i];
            const auto& near = found[i];
            const double away = length(exact[i] - Vec3d(points[i])), above = farthest_.above(near) + away;
            farthest_.see(points[i], away, part.element, near);
            if (std::exchange(part.asked_middle, !part.asked_middle)) {
                part.age = part.age == 2 ? 0 : static_cast<std::uint8_t>(part.age + 1);
                TrianglePart other = part;
                part.move_corner(part.edge, exact[i], above, near.element);
                other.move_corner((part.edge + 1) % 3, exact[i], above, near.element);
                parts.push_back(other);
            } else {
                part.remember(near.element);
                double farthest = 0;
                for (const auto& c : part.corner) farthest = std::max(farthest, length(c - exact[i]));
                part.bound = std::min(part.bound, above + farthest);
            }
        }
    }

    const IA& a_;
    const IB& b_;
    const HausdorffOptions& options_;
    IeeeExecutor threads_;
    Corners<A> corners_;
    double scale_;
    DistanceError<T> error_;
    Farthest<A, IB> farthest_;
    AskedCorners<A, IB> asked_;
    double wanted_ = 0, enough_ = 0, upper_ = 0;
    std::vector<PrimitiveId> elements_;
    std::vector<Waiting> waiting_;
    Parts parts_;
};

}  // namespace hedgerow::detail
