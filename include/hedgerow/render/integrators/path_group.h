/// Paths at surfaces, four side by side; and what their steps there compute with, of one path (F = float) or
/// of four (F = FloatLanes).
#pragma once

#include <concepts>

#include <hedgerow/render/integrators/path_state.h>
#include <hedgerow/render/integrators/path_vertex.h>

namespace hedgerow {

/// What a path carries to a vertex, as far as scattering needs or changes it.
template <class F>
struct CarriedLight {
    Vec<F, 3> throughput;
    F spread;
    MaskOf<F> direct;   ///< whether light from a source is direct here
    MaskOf<F> may_end;  ///< whether roulette is played
};
/// What of the light from a source gets to the eye, if nothing is in the way.
template <class F>
struct LightToEye {
    MaskOf<F> exists;
    Vec<F, 3> light;
};
/// The numbers that choose where a path goes on, and whether.
template <class F>
struct WayNumbers {
    F lobe, u, v, end;
};

/// Four paths at vertices, each with the vertex and the numbers that it takes there. Borrows the paths.
template <std::floating_point T>
struct PathGroup {
    static constexpr int most = FloatLanes::count;

    int count = 0;
    PathState<T>* paths[most];
    PathVertex<T> vertices[most];
    VertexSamples samples[most];

    /// Puts the first path in the places that are free, so that all lanes have numbers to compute with.
    void fill() {
        for (int k = count; k < most; ++k)
            paths[k] = paths[0], vertices[k] = vertices[0], samples[k] = samples[0];
    }
    /// Computes where rays from the vertices begin.
    void set_origins() {
        using L = Landing<T>;
        const auto ray = [&](int k) -> const Ray<T, 3>& { return paths[k]->ray; };
        const auto of = [&](int k) -> const L& { return vertices[k].landing; };
        const Landing<NumberLanes<T>> landing{in_lanes(of, &L::normal), in_lanes(of, &L::low),
                                              in_lanes(of, &L::high), in_lanes(of, &L::distance),
                                              in_lanes(of, &L::smooth)};
        const auto origin = in_lanes(ray, &Ray<T, 3>::origin),
                   direction = in_lanes(ray, &Ray<T, 3>::direction);
        const auto begin = in_lanes(ray, &Ray<T, 3>::t_min);
        const auto before = landing.before(origin, direction, begin);
        bool go_through = false;
        for (int k = 0; k < most; ++k) {
            vertices[k].before = lane(before, k);
            go_through |= vertices[k].material.transmission > 0;
        }
        if (!go_through) return;
        const auto beyond = landing.beyond(origin, direction, begin);
        for (int k = 0; k < most; ++k) vertices[k].beyond = lane(beyond, k);
    }
};

/// Up to four paths whose rays meet nothing. Borrows the paths.
template <std::floating_point T>
struct LeavingPaths {
    static constexpr int most = FloatLanes::count;

    int count = 0;
    PathState<T>* paths[most];

    /// Returns whether there are four now.
    bool add(PathState<T>& path) {
        paths[count++] = &path;
        return count == most;
    }
};

}  // namespace hedgerow
