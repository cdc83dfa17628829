/// Many paths at once, in rounds: the closest hits of all, then the steps of each path, then the shadow rays
/// of all. So rays are answered in batches (Laine, Karras and Aila, Megakernels considered harmful, HPG
/// 2013). Where paths end, new ones take their places, so that batches stay full (Novák, Havran and
/// Dachsbacher, Eurographics 2010). The steps of a path are those of PathReference, and its light has the
/// same bits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <hedgerow/render/integrators/normal_cache.h>
#include <hedgerow/render/integrators/path_camera.h>
#include <hedgerow/render/integrators/path_step.h>
#include <hedgerow/render/sampling/sample_batch.h>
#include <hedgerow/render/tracer.h>

namespace hedgerow {

template <std::floating_point T>
class PathWavefront {
public:
    /// Paths that are followed at once: enough for batches, few enough for the second-level cache.
    static constexpr std::size_t default_in_flight = 1024;

    /// Borrows all.
    PathWavefront(const PathWorld<T>& world, const Tracer<T>& tracer,
                  std::size_t in_flight = default_in_flight)
        : world_(world), tracer_(tracer), steps_(world), in_flight_(in_flight) {}

    /// Follows paths 0 to count − 1. `start(i)` returns path i, and `finish(i, light)` takes the PathLight
    /// that comes along its ray; paths are started in order and finish in any. Neighbours in order should
    /// have neighbouring rays. `prepare(first, last)` is called before paths from `first` to before `last`
    /// are started.
    template <class Prepare, class OfNumber, class Finish>
    void follow(std::size_t count, const Prepare& prepare, const OfNumber& start,
                const Finish& finish) const {
        Flight flight(in_flight_);
        std::size_t next = 0;
        while (next < count || flight.size > 0) {
            const std::size_t old = flight.size;
            prepare(next, std::min(count, next + (in_flight_ - old)));
            for (; flight.size < in_flight_ && next < count; ++next) {
                Path& path = flight.paths[flight.size++];
                const PathStart<T> s = start(next);
                path = {{}, s.samples, next};
                path.state.ray = s.ray;
            }
            find_hits(flight, 0, old);
            find_hits(flight, old, flight.size);
            meet_surfaces(flight);
            add_light(flight);
            drop_ended(flight, finish);
        }
    }

private:
    using Filter = typename Tracer<T>::Filter;

    struct Path {
        PathState<T> state;
        PathSamples samples;
        std::size_t number;
    };
    /// The paths of a round, and what they have found in it.
    struct Flight {
        explicit Flight(std::size_t most)
            : paths(most, Path{{}, PathSamples(PixelSequence(Sampler::sobol, 0, 0), 0), 0}),
              hits(most),
              numbers(most, VertexSamples::count),
              goes_on(std::make_unique<bool[]>(most)),
              shadows(most),
              shaded(most),
              blocked(std::make_unique<bool[]>(most)) {}

        std::vector<Path> paths;
        std::vector<Hit<T>> hits;
        NormalCache<T> normals;
        SampleBatch numbers;
        PathGroup<T> group;
        std::size_t members[PathGroup<T>::most];  // of the group: which paths they are
        LeavingPaths<T> leaving;
        std::unique_ptr<bool[]> goes_on;
        std::vector<ShadowRay<T>> shadows;
        std::vector<std::size_t> shaded;  // whose shadow rays these are
        std::unique_ptr<bool[]> blocked;
        std::size_t size = 0, shadow_count = 0;
    };

    /// The closest hits of some paths. Those that have begun together go apart from the others, since their
    /// rays are alike.
    void find_hits(Flight& flight, std::size_t first, std::size_t last) const {
        if (first == last) return;
        const Strided<Ray<T, 3>> rays(&flight.paths[first].state.ray, last - first, sizeof(Path));
        const auto keep = [&, first](std::size_t i, const Hit<T>& hit) {
            const Path& path = flight.paths[first + i];
            return world_.surfaces.is_there(hit, path.samples.ray_key(path.state.vertex));
        };
        tracer_.closest_hits(RayArray<T, 3>(rays), std::span(flight.hits).subspan(first, last - first), {},
                             filter(keep));
    }
    /// Takes the three steps of each path before its shadow ray is answered, while its vertex is in the
    /// first-level cache. Each arrives alone, since surfaces are looked up here and there. Four at a time go
    /// on from there, and four at a time meet the sky.
    void meet_surfaces(Flight& flight) const {
        flight.numbers.clear();
        for (std::size_t i = 0; i < flight.size; ++i)
            if (flight.hits[i])
                flight.numbers.add(flight.paths[i].samples,
                                   PathSamples::dimension(flight.paths[i].state.vertex));
        flight.numbers.compute();
        flight.shadow_count = 0;
        std::size_t hit_count = 0;
        for (std::size_t i = 0; i < flight.size; ++i) {
            flight.goes_on[i] = false;
            if (flight.hits[i])
                arrive(flight, i, hit_count++);
            else if (flight.leaving.add(flight.paths[i].state))
                steps_.meet_sky(flight.leaving);
        }
        if (flight.group.count > 0) scatter(flight);
        if (flight.leaving.count > 0) steps_.meet_sky(flight.leaving);
    }
    /// A path arrives at its hit. `place`: that of its numbers.
    void arrive(Flight& flight, std::size_t i, std::size_t place) const {
        const Hit<T>& hit = flight.hits[i];
        const auto front = [&] { return flight.normals.at(hit, [&] { return world_.surfaces.front(hit); }); };
        PathGroup<T>& group = flight.group;
        PathState<T>& path = flight.paths[i].state;
        const int k = group.count;
        if (!steps_.arrive(path, hit, group.vertices[k], front)) return;
        group.paths[k] = &path, group.samples[k] = flight.numbers.at_vertex(place);
        flight.members[k] = i;
        if (++group.count == PathGroup<T>::most) scatter(flight);
    }
    /// The paths of the group look for light, and leave.
    void scatter(Flight& flight) const {
        const LaneMask go_on = steps_.scatter(flight.group, [&](int k, const ShadowRay<T>& ray) {
            flight.shadows[flight.shadow_count] = ray;
            flight.shaded[flight.shadow_count++] = flight.members[k];
        });
        for (int k = 0; k < flight.group.count; ++k) flight.goes_on[flight.members[k]] = go_on[k];
        flight.group.count = 0;
    }
    /// Adds the light that shadow rays bring.
    void add_light(Flight& flight) const {
        const std::size_t count = flight.shadow_count;
        if (count == 0) return;
        const auto keep = [&](std::size_t k, const Hit<T>& hit) {
            const Path& path = flight.paths[flight.shaded[k]];
            return world_.surfaces.is_there(hit, path.samples.shadow_key(flight.shadows[k].vertex));
        };
        const Strided<Ray<T, 3>> rays(&flight.shadows[0].ray, count, sizeof(ShadowRay<T>));
        tracer_.any_hits(RayArray<T, 3>(rays), std::span(flight.blocked.get(), count), {}, filter(keep));
        for (std::size_t k = 0; k < count; ++k)
            if (!flight.blocked[k]) steps_.add_light(flight.paths[flight.shaded[k]].state, flight.shadows[k]);
    }
    /// Finishes the paths that have ended. The others move together, in their order.
    template <class Finish>
    static void drop_ended(Flight& flight, const Finish& finish) {
        std::size_t to = 0;
        for (std::size_t i = 0; i < flight.size; ++i) {
            const Path& path = flight.paths[i];
            if (!flight.goes_on[i])
                finish(path.number, path.state.light);
            else if (const std::size_t place = to++; place != i)
                flight.paths[place] = path;
        }
        flight.size = to;
    }
    template <class Keep>
    Filter filter(const Keep& keep) const {
        return world_.surfaces.has_holes() ? Filter(keep) : Filter();
    }

    const PathWorld<T> world_;
    const Tracer<T>& tracer_;
    const PathSteps<T> steps_;
    const std::size_t in_flight_;
};

}  // namespace hedgerow
