// From the width of a tree's nodes to a template. (Read once for each instruction set.)

// F<W>::answer, W being the width of the scene's nodes.
template <template <int> class F, class Scene, class... Arguments>
HWY_INLINE auto by_width(const Scene& scene, Arguments... arguments) {
    switch (scene.tree.nodes.width()) {
        case 4:
            return F<4>::answer(scene, arguments...);
        case 8:
            return F<8>::answer(scene, arguments...);
        default:
            return F<16>::answer(scene, arguments...);
    }
}
