// A filter: what a ray hits if every other triangle is glass.
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>

int main() {
    const auto index = hedgerow::build(hedgerow::teapot<float>(10'000));
    const hedgerow::Ray3f ray{.origin = {0.1f, -9, 1}, .direction = {0, 1, 0}};
    const auto opaque = [](const hedgerow::Hit<float>& hit) { return hit.element % 2 == 1; };
    const auto first = hedgerow::closest_hit(index, ray), kept = hedgerow::closest_hit(index, ray, opaque);
    std::printf("the first hit is at t = %g, the first opaque one at t = %g\n", first.t, kept.t);
    return !kept || kept.t < first.t;
}
