/// Many paths at once, in rounds: the closest hits of all, then what light they meet, then the shadow rays of
/// all, then where each goes on. So rays are answered in batches (Laine, Karras and Aila, Megakernels
/// considered harmful, HPG 2013). Where paths end, new ones take their places, so that batches stay full
/// (Novák, Havran and Dachsbacher, Eurographics 2010). The steps of a path are those of PathReference, and
/// its light has the same bits.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <hedgerow/render/integrators/path_camera.h>
#include <hedgerow/render/integrators/path_step.h>
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

    /// Follows paths 0 to count − 1. `start(i)` returns path i, and `finish(i, light)` takes the light that
    /// comes along its ray; paths are started in order and finish in any. Neighbours in order should have
    /// neighbouring rays.
    template <class OfNumber, class Finish>
    void follow(std::size_t count, const OfNumber& start, const Finish& finish) const {
        Flight flight(in_flight_);
        std::size_t next = 0;
        while (next < count || flight.size > 0) {
            const std::size_t old = flight.size;
            for (; flight.size < in_flight_ && next < count; ++next) {
                Path& path = flight.paths[flight.size++];
                const PathStart<T> s = start(next);
                path = {{}, s.samples, next};
                path.state.ray = s.ray;
            }
            find_hits(flight, 0, old);
            find_hits(flight, old, flight.size);
            arrive(flight, finish);
            look_for_light(flight);
            leave(flight, finish);
        }
    }

private:
    using Filter = typename Tracer<T>::Filter;

    struct Path {
        PathState<T> state;
        PathSamples samples;
        std::size_t number;
    };
    struct Meeting {
        PathVertex<T> vertex;
        Scattering scattering;
    };
    /// The paths of a round, and what they have met in it.
    struct Flight {
        explicit Flight(std::size_t most)
            : paths(most, Path{{}, PathSamples(PixelSequence(Sampler::sobol, 0, 0), 0), 0}),
              hits(most),
              meetings(most),
              shadows(most),
              shaded(most),
              blocked(std::make_unique<bool[]>(most)) {}

        std::vector<Path> paths;
        std::vector<Hit<T>> hits;
        std::vector<std::optional<Meeting>> meetings;
        std::vector<ShadowRay<T>> shadows;
        std::vector<std::size_t> shaded;  // whose shadow rays these are
        std::unique_ptr<bool[]> blocked;
        std::size_t size = 0;
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
    /// Adds the light that rays meet. Paths that end there leave the flight.
    template <class Finish>
    void arrive(Flight& flight, const Finish& finish) const {
        keep(flight, finish, [&](std::size_t i, std::size_t to) {
            const auto vertex = steps_.arrive(flight.paths[i].state, flight.hits[i]);
            if (vertex) flight.meetings[to].emplace(Meeting{*vertex, steps_.scattering_at(*vertex)});
            return vertex.has_value();
        });
    }
    /// Adds the light that shadow rays bring.
    void look_for_light(Flight& flight) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < flight.size; ++i) {
            const Path& path = flight.paths[i];
            const Meeting& met = *flight.meetings[i];
            const auto shadow = steps_.look_for_light(path.state, met.vertex, met.scattering, path.samples);
            if (shadow) flight.shadows[count] = *shadow, flight.shaded[count++] = i;
        }
        if (count == 0) return;
        const auto keep = [&](std::size_t k, const Hit<T>& hit) {
            const Path& path = flight.paths[flight.shaded[k]];
            return world_.surfaces.is_there(hit, path.samples.shadow_key(path.state.vertex));
        };
        const Strided<Ray<T, 3>> rays(&flight.shadows[0].ray, count, sizeof(ShadowRay<T>));
        tracer_.any_hits(RayArray<T, 3>(rays), std::span(flight.blocked.get(), count), {}, filter(keep));
        for (std::size_t k = 0; k < count; ++k)
            if (!flight.blocked[k]) steps_.add_light(flight.paths[flight.shaded[k]].state, flight.shadows[k]);
    }
    /// Sends paths on. Those that end leave the flight.
    template <class Finish>
    void leave(Flight& flight, const Finish& finish) const {
        keep(flight, finish, [&](std::size_t i, std::size_t) {
            Path& path = flight.paths[i];
            const Meeting& met = *flight.meetings[i];
            return steps_.leave(path.state, met.vertex, met.scattering, path.samples);
        });
    }
    /// Keeps the paths for which goes_on(i, to) is true: path i then takes place `to`. The others are
    /// finished.
    template <class Finish, class GoesOn>
    static void keep(Flight& flight, const Finish& finish, const GoesOn& goes_on) {
        std::size_t to = 0;
        for (std::size_t i = 0; i < flight.size; ++i) {
            Path& path = flight.paths[i];
            if (!goes_on(i, to))
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
