// The lecture's two loops: for each triangle the samples that it covers, and for each sample the triangles
// that cover it. Prints the depth buffer of the first as it fills, and checks that both find the same.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hedgerow/hedgerow.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/meshes.h>

using namespace hedgerow;

namespace {

constexpr int width = 60, height = 22;
constexpr float infinity = std::numeric_limits<float>::infinity();

struct Sample {
    float z_closest = infinity;
    PrimitiveId triangle = no_primitive;

    /// Keeps the closer of two hits; of two at one depth that of the lower triangle.
    void update(float t, PrimitiveId i) {
        if (std::pair(t, i) < std::pair(z_closest, triangle)) *this = {t, i};
    }
};

/// Prints samples by depth, from near (#) to far (.).
void show(const std::vector<Sample>& samples, float near, float far) {
    constexpr std::string_view shades = "#%*+=-:.";
    for (int y = 0; y < height; ++y) {
        std::string row;
        for (int x = 0; x < width; ++x) {
            const float z = samples[std::size_t(y * width + x)].z_closest;
            const float place = (z - near) / (far - near) * float(shades.size());
            row +=
                z == infinity ? ' ' : shades[std::min(std::size_t(std::max(place, 0.f)), shades.size() - 1)];
        }
        std::puts(row.c_str());
    }
}

}  // namespace

int main() {
    const auto mesh = teapot<float>(1000);
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(v);
    Camera camera = automatic_camera(box);
    camera.field_of_view = 27;
    // A letter is twice as high as wide: every second row of a picture of squares.
    const RayMaker make(camera, width, 2 * height);
    std::vector<Ray3f> rays;
    for (int i = 0; i < width * height; ++i)
        rays.push_back(make.ray<float>(float(i % width) + 0.5f, float(2 * (i / width)) + 1));
    const float eye_to_middle = length(camera.eye - box.center()), half = length(box.extent()) / 3;

    // Loop 1 over triangles, loop 2 over samples: a depth for each sample, in any order of triangles.
    std::vector<Sample> drawn(rays.size());
    std::size_t covered = 0, closer = 0;
    for (PrimitiveId t = 0; t < mesh.size(); ++t) {
        for (std::size_t s = 0; s < rays.size(); ++s)
            if (const auto hit = meet_watertight(rays[s], mesh.view().triangle(t))) {
                ++covered, closer += hit->t < drawn[s].z_closest;
                drawn[s].update(hit->t, t);
            }
        if (t + 1 == mesh.size() / 3 || t + 1 == mesh.size()) {
            std::printf("the depth buffer after %u of %zu triangles:\n", t + 1, mesh.size());
            show(drawn, eye_to_middle - half, eye_to_middle + half);
        }
    }
    // Loop 1 over samples, loop 2 over triangles: one depth at a time.
    std::size_t differ = 0, hits = 0;
    for (std::size_t s = 0; s < rays.size(); ++s) {
        Sample closest;
        for (PrimitiveId t = 0; t < mesh.size(); ++t)
            if (const auto hit = meet_watertight(rays[s], mesh.view().triangle(t))) closest.update(hit->t, t);
        hits += closest.triangle != no_primitive;
        differ += closest.triangle != drawn[s].triangle || closest.z_closest != drawn[s].z_closest;
    }
    std::printf(
        "%zu tests by either loop; %zu of them met, %zu were the closest so far, %zu samples show a "
        "triangle\n",
        mesh.size() * rays.size(), covered, closer, hits);
    std::printf("%zu samples differ\n", differ);
    return differ == 0 && hits > 100 ? 0 : 1;
}
