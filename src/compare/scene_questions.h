/// The questions that suit a scene.
#pragma once

#include <cmath>

#include <hedgerow/compare/measure.h>
#include <hedgerow/compare/questions.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::compare {

template <class P>
class SceneQuestions {
public:
    using T = typename P::Scalar;
    static constexpr int D = P::dimension;
    using Set = Questions<T, D>;

    SceneQuestions(const P& primitives, const AnyIndex<T, D>& index, const MeasureOptions& options)
        : set_(view_of(primitives)), index_(index), box_(index.bounds()), o_(options) {}

    std::vector<Set> all() const {
        std::vector<Set> questions;
        const auto add = [&](Ask ask, std::string kind, typename Set::List list) {
            const bool wanted =
                o_.asks.empty() || std::find(o_.asks.begin(), o_.asks.end(), ask) != o_.asks.end();
            Set made(ask, std::move(kind), std::move(list));
            if (wanted && made.size() > 0) questions.push_back(std::move(made));
        };
        if constexpr (MeetsRays<ViewOf<P>> || requires { set_.triangle(0); }) {
            const auto random = random_rays(), coherent = coherent_rays(),
                       incoherent = incoherent_rays(coherent, random);
            constexpr std::pair<Ask, const char*> asks[] = {
                {Ask::closest_hit, "closest hit"}, {Ask::any_hit, "any hit"}, {Ask::all_hits, "all hits"}};
            for (const auto& [ask, name] : asks) {
                add(ask, std::string(name) + ", coherent rays", coherent);
                add(ask, std::string(name) + ", incoherent rays", incoherent);
                add(ask, std::string(name) + ", random rays", random);
            }
        }
        const auto points = random_points();
        add(Ask::closest_point, "closest point", points);
        add(Ask::nearest, std::to_string(Set::k) + " nearest", points);
        add(Ask::overlap, "box overlap", boxes());
        return questions;
    }

private:
    /// Each kind has random numbers of its own.
    enum Stream : std::uint64_t { of_rays = 1, of_bounces, of_points, of_places };
    Random random(Stream stream, std::uint64_t i) const { return Random(scattered(o_.seed) + stream, i); }

    Vec<T, D> anywhere(Random& random) const {
        const Vec<double, D> share = random.in_cube<D>();
        Vec<T, D> p;
        for (int k = 0; k < D; ++k)
            p[k] = box_.low[k] + static_cast<T>(share[k]) * (box_.high[k] - box_.low[k]);
        return p;
    }
    typename Set::Points random_points() const {
        typename Set::Points all;
        for (std::size_t i = 0; i < o_.queries; ++i) {
            Random chance = random(of_points, i);
            all.push_back(anywhere(chance));
        }
        return all;
    }
    typename Set::Boxes boxes() const {
        typename Set::Boxes all;
        const T half = length(box_.extent()) / 200;
        for (std::size_t i = 0; i < o_.queries; ++i) {
            const Vec<T, D> middle = set_.bounds(random(of_places, i).bits() % set_.size()).center();
            all.push_back({middle - Vec<T, D>::all(half), middle + Vec<T, D>::all(half)});
        }
        return all;
    }
    typename Set::Rays random_rays() const {
        typename Set::Rays all;
        for (std::size_t i = 0; i < o_.queries; ++i) {
            Random chance = random(of_rays, i);
            const Vec<T, D> from = anywhere(chance);
            all.push_back({from, anywhere(chance) - from});
        }
        return all;
    }
    /// A square picture in rows; in the plane a fan.
    typename Set::Rays coherent_rays() const {
        typename Set::Rays all;
        if constexpr (D == 3) {
            const auto side = static_cast<int>(std::sqrt(static_cast<double>(o_.queries)));
            const Box3f box{Vec3f(box_.low), Vec3f(box_.high)};
            const RayMaker make(o_.camera.value_or(automatic_camera(box)), side, side);
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    all.push_back(
                        make.template ray<T>(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
        } else {
            const T far = length(box_.extent());
            const Vec<T, 2> eye = box_.center() - Vec<T, 2>(T(0.6) * far, T(0.8) * far);
            for (std::size_t i = 0; i < o_.queries; ++i) {
                const T across = far * (static_cast<T>(i) / static_cast<T>(o_.queries) - T(0.5));
                all.push_back({eye, box_.center() + Vec<T, 2>(T(-0.8) * across, T(0.6) * across) - eye});
            }
        }
        return all;
    }
    /// From the hits of `first`, or where there are none of `second`: about the normal by the cosine.
    typename Set::Rays incoherent_rays(const typename Set::Rays& first,
                                       const typename Set::Rays& second) const {
        typename Set::Rays all;
        for (const auto* from : {&first, &second}) {
            std::vector<Hit<T>> hits(from->size());
            index_.closest_hits(*from, hits);
            std::vector<std::size_t> met;
            for (std::size_t i = 0; i < hits.size(); ++i)
                if (hits[i]) met.push_back(i);
            for (std::size_t i = 0; i < o_.queries && !met.empty(); ++i) {
                const std::size_t r = met[i * met.size() / o_.queries];
                Random chance = random(of_bounces, i);
                all.push_back(bounce((*from)[r], hits[r], chance));
            }
            if (!all.empty()) break;
        }
        return all;
    }
    Ray<T, D> bounce(const Ray<T, D>& ray, const Hit<T>& hit, Random& random) const {
        // A little before the surface: which ray it is matters to nobody, that all are asked the same does.
        const Vec<T, D> from = ray.at(hit.t * (1 - T(0x1p-12)));
        Vec<double, D> n = normalized(Vec<double, D>(normal(hit.element, from)));
        if (dot(n, Vec<double, D>(ray.direction)) > 0) n = -n;
        return {from, Vec<T, D>(normalized(n + random.direction<D>() * 0.999))};
    }
    Vec<T, D> normal(PrimitiveId id, const Vec<T, D>& at) const {
        if constexpr (requires { set_.normal(id); }) {
            return set_.normal(id);
        } else if constexpr (requires { set_.sphere(id); }) {
            return at - set_.sphere(id).center;
        } else {
            const Vec<T, D> along = set_.segment(id).b - set_.segment(id).a;
            return {-along[1], along[0]};
        }
    }

    ViewOf<P> set_;
    const AnyIndex<T, D>& index_;
    Box<T, D> box_;
    const MeasureOptions& o_;
};

}  // namespace hedgerow::compare
