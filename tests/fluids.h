/// Flows that the tests of fluids share.
#pragma once

#include <cmath>

#include <hedgerow/fluid/fluid_flow.h>

namespace hedgerow {

/// A fluid that fills a box, at rest.
template <int D>
FluidState<D> filled(const Box<double, D>& box, double spacing) {
    FluidState<D> state;
    state.places = fill_box(box, spacing);
    state.resize(state.places.size());
    return state;
}
/// Compresses a fluid as its weight does, below a surface at a height.
template <int D>
void compress(FluidState<D>& state, double surface, const FluidOptions<D>& options) {
    for (std::size_t i = 0; i < state.size(); ++i)
        state.compressions[i] =
            -options.gravity[D - 1] * (surface - state.places[i][D - 1]) / (options.sound * options.sound);
}
/// Options of water that falls from a height, in metres.
template <int D>
FluidOptions<D> water(double spacing, double height) {
    FluidOptions<D> options;
    options.spacing = spacing;
    options.sound = 10 * std::sqrt(2 * 9.81 * height);
    return options;
}
/// A column of water, a spacing·a wide and a spacing·b high, in the corner of a tank.
template <int D>
FluidFlow<D> dam(double spacing, Threads threads = {}) {
    Box<double, D> tank, column;
    for (int k = 0; k < D; ++k) tank.low[k] = column.low[k] = 0;
    const auto side = [&](double spacings) { return spacings * spacing; };
    tank.high = column.high = Vec<double, D>::all(side(8));
    column.high[D - 1] = side(12), tank.high[0] = side(24), tank.high[D - 1] = side(20);
    return {filled(column, spacing), walls_of_box(tank, spacing), water<D>(spacing, side(12)), threads};
}

}  // namespace hedgerow
