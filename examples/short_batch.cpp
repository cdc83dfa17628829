// Many rays in one call, on all cores.
#include <algorithm>
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>

int main() {
    const auto index = hedgerow::build(hedgerow::teapot<float>(10'000));
    std::vector<hedgerow::Ray3f> rays;
    for (float x = -2; x < 2; x += 0.001f) rays.push_back({.origin = {x, -9, 1}, .direction = {0, 1, 0}});
    std::vector<hedgerow::Hit<float>> hits(rays.size());
    hedgerow::closest_hits(index, rays, std::span(hits));
    const auto hit = std::ranges::count_if(hits, [](const auto& h) { return bool(h); });
    std::printf("%td of %zu rays hit\n", hit, rays.size());
    return hit == 0;
}
