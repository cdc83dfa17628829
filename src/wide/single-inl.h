// One ray: to the nearest entered child first, the others on a stack by their distance, and what a nearer hit
// has put out of reach is passed over. (Read once for each instruction set.)

enum class Wanted { closest, any };

// `test(leaf)` holds a leaf against the ray and says whether the ray was hit. What a leaf holds, it knows.
template <int W, Wanted wanted, class Test>
HWY_INLINE bool walk_one(const WideTree<float, 3>& tree, WideRay& ray, Test test) {
    using Stack = WalkStack<W>;
    constexpr int room = Stack::room(bvh_max_depth + 1);
    std::int32_t entries[room];
    std::uint32_t words[room];
    Stack stack(entries, words, 0, 0);
    stack.clear();
    const std::byte* const nodes = tree.nodes.data();
    const Slabs<W> slabs(ray);
    std::uint32_t word = 0;
    while (true) {
        if ((word & WideChild::leaf_bit) == 0) {
            const std::byte* const node = nodes + word * WideNodes<float, 3>::stride_of(W);
            const std::uint32_t* const children = children_of<W>(node);
            __builtin_prefetch(children);
            const Boxes<W> boxes(node, slabs, ray.s_limit);
            const unsigned entered = boxes.bits(), others = entered & (entered - 1);
            if (entered != 0) {
                // One or two are entered more often than not, and a guess that holds is faster than the sort.
                const int first = std::countr_zero(entered);
                if (others == 0) {
                    word = children[first];
                    continue;
                }
                if constexpr (wanted == Wanted::any) {
                    word = stack.push_others_unsorted(boxes, children);
                    continue;
                }
                if ((others & (others - 1)) == 0) {
                    alignas(64) float at[W];
                    boxes.store(at);
                    const int second = std::countr_zero(others);
                    const bool swap = at[second] < at[first];
                    stack.push(at[swap ? first : second], children[swap ? first : second]);
                    word = children[swap ? second : first];
                    continue;
                }
                word = stack.push_others(boxes, children);
                continue;
            }
        } else {
            if (word == Stack::end) return ray.element != Hit<float>::none;
            if (test(word & ~WideChild::leaf_bit)) {
                if (wanted == Wanted::any) return true;
                stack.sweep(ray.s_limit);
            }
        }
        word = stack.pop();
    }
}

template <int W, Wanted wanted>
bool trace_one(const WideScene& scene, WideRay& ray) {
    return walk_one<W, wanted>(
        scene.tree, ray, [&](std::uint32_t leaf) __attribute__((always_inline)) {
            return test_triangles(scene, leaf, ray, 0);
        });
}

template <int W, Wanted wanted>
HWY_INLINE auto answer_one(const WideScene& scene, const Ray<float, 3>& asked) {
    WideRay ray;
    prepare<W>(reinterpret_cast<const std::byte*>(&asked), scene.tree.bounds, 0.0f, ray);
    const bool hit = ray.usable && !scene.tree.empty() && trace_one<W, wanted>(scene, ray);
    if constexpr (wanted == Wanted::closest)
        return hit_of(scene, ray);
    else
        return hit;
}
