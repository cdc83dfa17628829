// One teapot, indexed once, in two places.
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>

int main() {
    const auto teapot = hedgerow::build(hedgerow::teapot<float>(10'000));
    const auto aside = hedgerow::Transform<3>::translation({20, 0, 0});
    const hedgerow::InstanceSet both{hedgerow::Instance(teapot), hedgerow::Instance(teapot, aside)};
    const auto world = hedgerow::build(both);
    const auto hit = hedgerow::closest_hit(world, {.origin = {20, -9, 1}, .direction = {0, 1, 0}});
    if (hit) std::printf("triangle %u of teapot %u at t = %g\n", hit.element, hit.instance, hit.t);
    return !hit;
}
