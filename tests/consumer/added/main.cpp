#include <hedgerow/hedgerow.h>
#include <cstdio>
using namespace hedgerow;

int main() {
    const TriangleMesh<float> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}};
    const auto index = build(mesh);
    const auto hit = closest_hit(index, Ray3f{{0.25f, 0.25f, 1}, {0, 0, -1}});
    std::printf("%s\n", hit && hit.t == 1 ? "hit" : "missed");
}
