// Which kernel many rays want: packets of those that go the same way, as long as that pays, and the phased
// batch for all others. (Read once for each instruction set.)

template <int W, Wanted wanted, class Answer>
KernelUse answer_many(const WideScene& scene, const RayArray<float, 3>& rays, Answer* answers) {
    if (scene.tree.empty()) {
        std::fill_n(answers, rays.size(), Answer());
        return {0, rays.size(), 0};
    }
    constexpr std::size_t size = Packet<W, wanted>::size;
    // Packets pay where a leaf is entered by so many rays of one; it is known after so many leaves.
    constexpr std::size_t rays_a_leaf = 6, enough_leaves = 256;
    constexpr int most_ways = 4;  // of 64 rays: a picture's go four where two axes change sign
    KernelUse use;
    std::size_t waiting = 0, next = 0;  // rays from `waiting` to `next` go their own ways
    const auto answer_waiting = [&] {
        if (waiting < next) Batch<W, wanted>(scene, rays, waiting, next).answer(answers);
        use.phased += next - waiting;
    };
    Packet<W, wanted> packet(scene);
    const auto pays = [&] {
        return packet.leaves() <= enough_leaves || packet.rays_in_leaves() >= rays_a_leaf * packet.leaves();
    };
    for (; rays.size() - next >= size && pays(); next += size) {
        std::uint32_t ways = packet.look(rays, next);
        if (ways == 0 || std::popcount(ways) > most_ways) continue;
        answer_waiting();
        if (rays.size() - next >= 2 * size) {  // what comes next, while this packet computes
            prefetch_rays(rays, next + size, size);
            prefetch_all(answers + next + size, size);
        }
        for (; ways != 0; ways &= ways - 1)
            packet.answer(static_cast<std::uint32_t>(std::countr_zero(ways)), answers + next);
        use.packets += size;
        waiting = next + size;
    }
    next = rays.size();
    answer_waiting();
    return use;
}
