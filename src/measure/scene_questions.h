/// The queries that suit a scene: rays, points and boxes by its shape and size.
#pragma once

#include <cmath>

#include <hedgerow/measure/compare.h>
#include <hedgerow/measure/query_set.h>
#include <hedgerow/measure/ray_sets.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/random.h>

#include "surface_samples.h"

namespace hedgerow::measure {

template <std::floating_point T, int D>
class SceneQuestions {
public:
    using Set = QuerySet<T, D>;
    using Rays = std::vector<Ray<T, D>>;
    /// How many neighbours a question for the nearest asks for.
    static constexpr std::size_t neighbours = 8;
    /// How many hits a question for the first hits asks for.
    static constexpr std::size_t hits_along = 8;

    SceneQuestions(const Scene<T, D>& scene, const AnyIndex<T, D>& index, const MeasureOptions& options)
        : scene_(scene), index_(index), box_(index.bounds()), o_(options) {}

    /// The queries, and the number of rays in each set that hit nothing.
    struct All {
        std::vector<std::shared_ptr<Set>> questions;
        std::vector<RaySetSize> ray_sets;
    };
    All all() const {
        All found;
        std::vector<std::pair<const char*, Rays>> sets;
        if (scene_.has_surfaces()) {
            sets = {
                {"coherent", coherent_rays()}, {"incoherent", incoherent_rays()}, {"random", random_rays()}};
            for (const auto& [kind, rays] : sets)
                if (!rays.empty()) found.ray_sets.push_back({kind, rays.size(), missed(rays)});
        }
        for_each_question<T, D>([&]<class Question>(Question) {
            // Where there are no surfaces, there are no sets of rays, and so no queries by rays.
            if (!answers<Question>(index_)) return;
            if (o_.asks.empty() || std::find(o_.asks.begin(), o_.asks.end(), Question::name) != o_.asks.end())
                add<Question>(sets, found.questions);
        });
        return found;
    }
    /// The share of the primitives that are visible from the eye of the coherent rays, estimated from a
    /// sample; 1 if the eye is in the scene's box.
    double seen_from_outside() const {
        if constexpr (D == 3) {
            const Vec<T, 3> eye(camera().eye);
            if (!scene_.has_surfaces() || box_.contains(eye)) return 1;
            constexpr std::size_t some = 2000;
            // Cast rays from the eye to random places on random primitives.
            Rays rays;
            for (std::size_t i = 0; i < some; ++i) {
                Random chance = random(of_sights, i);
                const std::size_t primitive = chance.bits() % scene_.size();
                const auto place = scene_.place_on(primitive, chance);
                rays.push_back({eye, place.point - eye});
            }
            std::vector<Hit<T>> hits(some);
            closest_hits(index_, rays, hits, {.threads = serial_executor()});
            // A hit more than 2^-10 of the way before the place hides the place.
            const auto hidden = std::count_if(hits.begin(), hits.end(),
                                              [](const auto& h) { return h && h.t < T(1) - T(0x1p-10); });
            return 1 - static_cast<double>(hidden) / static_cast<double>(some);
        }
        return 1;
    }

private:
    /// Adds the queries of a question, in kinds that differ by what is given: rays of each set, and points,
    /// balls or boxes in the scene.
    template <class Question>
    void add(const std::vector<std::pair<const char*, Rays>>& sets,
             std::vector<std::shared_ptr<Set>>& questions) const {
        using Given = typename Question::Given;
        const auto add_kind = [&](std::string kind, std::vector<Given> given) {
            if (!given.empty())
                questions.push_back(
                    std::make_shared<QuerySetOf<Question, T, D>>(std::move(kind), std::move(given)));
        };
        const std::string words(Question::words);
        if constexpr (std::same_as<Given, Ray<T, D>>)
            for (const auto& [kind, rays] : sets) add_kind(words + ", " + kind + " rays", rays);
        else if constexpr (std::same_as<Given, HitsAlong<T, D>>)
            for (const auto& [kind, rays] : sets) {
                std::vector<Given> given;
                for (const auto& ray : rays) given.push_back({ray, hits_along});
                add_kind(std::to_string(hits_along) + " " + words + ", " + kind + " rays", given);
            }
        else if constexpr (std::same_as<Given, Vec<T, D>>)
            add_kind(words, random_points());
        else if constexpr (std::same_as<Given, Neighbours<T, D>>)
            add_kind(std::to_string(neighbours) + " " + words, neighbourhoods());
        else if constexpr (std::same_as<Given, Ball<T, D>>)
            add_kind(words, balls());
        else if constexpr (std::same_as<Given, Sphere<T, D>>)
            add_kind(words, solid_balls());
        else
            add_kind(words, boxes());
    }
    std::size_t missed(const Rays& rays) const {
        std::vector<Hit<T>> hits(rays.size());
        closest_hits(index_, rays, hits, {.threads = serial_executor()});
        return static_cast<std::size_t>(
            std::count_if(hits.begin(), hits.end(), [](const auto& h) { return !h; }));
    }
    /// Each kind of query draws from its own stream of random numbers.
    enum Stream : std::uint64_t { of_rays = 1, of_bounces, of_points, of_places, of_sights };
    Random random(Stream stream, std::uint64_t i) const { return Random(scattered(o_.seed) + stream, i); }

    std::vector<Vec<T, D>> random_points() const {
        std::vector<Vec<T, D>> all;
        for (std::size_t i = 0; i < o_.queries; ++i) {
            Random chance = random(of_points, i);
            all.push_back(random_point(box_, chance));
        }
        return all;
    }
    std::vector<Neighbours<T, D>> neighbourhoods() const {
        std::vector<Neighbours<T, D>> all;
        for (const auto& p : random_points()) all.push_back({p, neighbours});
        return all;
    }
    /// The middle of a random primitive's box.
    Vec<T, D> middle(std::size_t i) const {
        return scene_.middle(random(of_places, i).bits() % scene_.size());
    }
    T small() const { return length(box_.extent()) / 200; }
    std::vector<Ball<T, D>> balls() const {
        std::vector<Ball<T, D>> all;
        for (std::size_t i = 0; i < o_.queries; ++i) all.push_back({middle(i), small() * small()});
        return all;
    }
    std::vector<Sphere<T, D>> solid_balls() const {
        std::vector<Sphere<T, D>> all;
        for (std::size_t i = 0; i < o_.queries; ++i) all.push_back({middle(i), small()});
        return all;
    }
    std::vector<Box<T, D>> boxes() const {
        std::vector<Box<T, D>> all;
        const Vec<T, D> half = Vec<T, D>::all(small());
        for (std::size_t i = 0; i < o_.queries; ++i) all.push_back({middle(i) - half, middle(i) + half});
        return all;
    }
    Rays random_rays() const {
        Rays all;
        for (std::size_t i = 0; i < o_.queries; ++i) {
            Random chance = random(of_rays, i);
            all.push_back(random_ray(box_, chance));
        }
        return all;
    }
    /// The rays of a square picture, row by row; in the plane a fan from one eye.
    Rays coherent_rays() const {
        Rays all;
        if constexpr (D == 3) {
            const auto side = static_cast<int>(std::sqrt(static_cast<double>(o_.queries)));
            const RayMaker make(camera(), side, side);
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
    Camera camera() const requires(D == 3) {
        return o_.camera.value_or(automatic_camera(Box3f{Vec3f(box_.low), Vec3f(box_.high)}));
    }
    /// Rays that leave random places on all surfaces, cosine-distributed about the normal.
    Rays incoherent_rays() const {
        Rays all;
        const auto size_of_box = static_cast<double>(max_component(box_.extent()));
        if (!(size_of_box > 0)) return all;
        const SurfaceSamples samples(scene_, size_of_box);
        if (samples.empty()) return all;
        // Start off the surface by more than its rounding error, so that the ray does not hit it at once.
        const T off =
            std::max(max_component(abs(box_.low)), max_component(abs(box_.high))) * (64 * unit_roundoff<T>);
        for (std::size_t i = 0; i < o_.queries; ++i) {
            Random chance = random(of_bounces, i);
            const auto place = samples.place(chance);
            all.push_back({place.point + Vec<T, D>(place.normal) * off,
                           Vec<T, D>(normalized(place.normal + chance.direction<D>() * 0.999))});
        }
        return all;
    }

    const Scene<T, D>& scene_;
    const AnyIndex<T, D>& index_;
    Box<T, D> box_;
    const MeasureOptions& o_;
};

}  // namespace hedgerow::measure
