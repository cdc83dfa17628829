/// Sums over the neighbours of particles, sixteen at a time. Included for each instruction set in a namespace
/// of its own that has `Sixteen`, numbers side by side, and `SixteenIds`; sums are added up in one order in
/// all.

// Offsets from sixteen neighbours to a particle, their squared length, and what is left of a neighbour's
// influence: 1 - r/2, which is 0 where there is no neighbour.
template <int D>
struct Offsets {
    Sixteen along[D], r2, r, left;

    HWY_INLINE Offsets(const detail::FlowTask<D>& task, std::uint32_t i, const SixteenIds& ids) {
        for (int k = 0; k < D; ++k)
            along[k] = differences(task.own->at[k][i], task.others->at[k].data(), ids) *
                       Sixteen::all(task.scales->per_unit[k]);
        r2 = along[0] * along[0];
        for (int k = 1; k < D; ++k) r2 = r2 + along[k] * along[k];
        r = ids.or_else(root(r2), 2);
        left = larger(Sixteen::all(1) - Sixteen::all(0.5f) * r, Sixteen::all(0));
    }
    HWY_INLINE Sixteen dot(const Sixteen* of) const {
        Sixteen sum = of[0] * along[0];
        for (int k = 1; k < D; ++k) sum = sum + of[k] * along[k];
        return sum;
    }
    HWY_INLINE Sixteen dot(const float* of) const {
        Sixteen sum = Sixteen::all(of[0]) * along[0];
        for (int k = 1; k < D; ++k) sum = sum + Sixteen::all(of[k]) * along[k];
        return sum;
    }
    // The kernel, 1 at distance 0: left⁴·(1 + 2r).
    HWY_INLINE Sixteen weight() const {
        const Sixteen square = left * left;
        return square * square * (Sixteen::all(1) + (r + r));
    }
};

// Calls f(ids) for the neighbours of a particle, sixteen at a time.
template <int D, class F>
HWY_INLINE void for_each_sixteen(const detail::FlowTask<D>& task, std::uint32_t i, F f) {
    const std::size_t k = i - task.first, begin = k == 0 ? 0 : task.ends[k - 1], end = task.ends[k];
    for (std::size_t at = begin; at < end; at += 16) f(SixteenIds(task.ids + at, end - at));
}

enum class By { fluid, walls };

// What fluid or walls do to particles of the fluid. Walls hold a viscous fluid, and are slippery for others.
template <By by, bool viscous, int D>
void add_neighbours(const detail::FlowTask<D>& task) {
    const detail::FlowScales<D>& scales = *task.scales;
    const Sixteen slope = Sixteen::all(-scales.slope);
    for (std::uint32_t i = task.first; i < task.end; ++i) {
        Sixteen acceleration[D], rate, fill;
        const Sixteen compression = Sixteen::all(task.own->compression[i]),
                      density = Sixteen::all(1) + compression;
        for_each_sixteen(task, i, [&](const SixteenIds& ids) HWY_ATTR {
            const Offsets<D> away(task, i, ids);
            const Sixteen gradient = slope * (away.left * away.left * away.left),
                          per_square = Sixteen::all(1) / (away.r2 + Sixteen::all(0.01f));
            const auto faster_by = [&](int k, const BareVector<float>* velocity) HWY_ATTR {
                return Sixteen::all(task.own->velocity[k][i]) - gathered(velocity[k].data(), ids);
            };
            Sixteen faster[D];
            for (int k = 0; k < D; ++k) faster[k] = faster_by(k, task.others->velocity);
            const Sixteen theirs = gathered(task.others->compression.data(), ids), parting = away.dot(faster);
            // The equation of continuity, with diffusion of density.
            Sixteen growth = density * parting;
            if constexpr (by == By::fluid)
                growth = growth +
                         Sixteen::all(scales.diffusion) * (compression - theirs - away.dot(scales.gravity));
            rate = rate + gradient * growth;
            // Pressures; artificial viscosity within the fluid, and what keeps it from passing through walls.
            Sixteen push = Sixteen::all(0) - (compression + theirs);
            if constexpr (by == By::fluid)
                push = push + Sixteen::all(scales.artificial_viscosity) * parting * per_square;
            else
                push = push - larger(Sixteen::all(2) - Sixteen::all(scales.guard) * away.r, Sixteen::all(0));
            push = push * gradient;
            for (int k = 0; k < D; ++k) acceleration[k] = acceleration[k] + push * away.along[k];
            if constexpr (viscous) {
                const Sixteen drag = Sixteen::all(scales.viscosity) * gradient * away.r2 * per_square;
                for (int k = 0; k < D; ++k)
                    acceleration[k] =
                        acceleration[k] +
                        drag * (by == By::fluid ? faster[k] : faster_by(k, task.others->mirrored_velocity));
            }
            fill = fill + away.weight();
        });
        // The fluid's sums come first. A particle fills its own surroundings too.
        constexpr bool first = by == By::fluid;
        task.rate[i] = (first ? 0 : task.rate[i]) + rate.sum();
        task.fill[i] = scales.share * ((first ? 1 : 0) + fill.sum());
        for (int k = 0; k < D; ++k)
            task.acceleration[k][i] = (first ? 0 : task.acceleration[k][i]) + acceleration[k].sum();
    }
}

template <int D>
void at_walls(const detail::FlowTask<D>& task) {
    for (std::uint32_t i = task.first; i < task.end; ++i) {
        Sixteen velocity[D], compression, weights;
        for_each_sixteen(task, i, [&](const SixteenIds& ids) HWY_ATTR {
            const Offsets<D> away(task, i, ids);
            const Sixteen weight = away.weight();
            weights = weights + weight;
            compression = compression + weight * (gathered(task.others->compression.data(), ids) +
                                                  away.dot(task.scales->gravity));
            for (int k = 0; k < D; ++k)
                velocity[k] = velocity[k] + weight * gathered(task.others->velocity[k].data(), ids);
        });
        const float sum = weights.sum(), per_weight = sum > 0 ? 1 / sum : 0;
        task.fill[i] = sum;
        task.rate[i] = compression.sum() * per_weight;
        for (int k = 0; k < D; ++k) task.acceleration[k][i] = velocity[k].sum() * per_weight;
    }
}

template <int D>
inline constexpr detail::FlowKernelsOf<D> flow_kernels_of = {
    {add_neighbours<By::fluid, false, D>, add_neighbours<By::fluid, true, D>},
    {add_neighbours<By::walls, false, D>, add_neighbours<By::walls, true, D>},
    at_walls<D>};
