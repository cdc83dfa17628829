// A scene in two levels: an index that is placed many times, and an index over its instances. Here a BVH
// holds instances of a grid; any structure can be either.
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

/// Makes rings of teapots, each turned, leant and stretched in its own way; a few are mirrored.
template <class I>
std::vector<Instance<I>> rings_of(const I& teapot) {
    std::vector<Instance<I>> all;
    for (int ring = 1; ring <= 4; ++ring) {
        for (int k = 0; k < 6 * ring; ++k) {
            Random random(1, static_cast<std::uint64_t>(100 * ring + k));
            const double angle = 6.283185307179586 * k / (6 * ring), size = random.uniform(0.6, 1.3);
            const auto placed =
                Transform<3>::rotation({0, 0, 1}, angle) * Transform<3>::translation({8.0 * ring, 0, 0}) *
                Transform<3>::rotation(random.direction<3>(), random.uniform(0, 0.5)) *
                Transform<3>::scaling({size, k % 5 == 0 ? -size : size, size * random.uniform(0.7, 1.4)});
            all.emplace_back(teapot, placed);
        }
    }
    return all;
}

int main() {
    const auto mesh = teapot<float>(1000);

    // Build both levels: three lines.
    const auto grid = build<Grid>(mesh);
    const InstanceSet scene(rings_of(grid));
    const auto index = build<Bvh>(scene);

    // Build the oracle, which tests every triangle of every teapot.
    const auto triangles = build<BruteForce>(mesh);
    const auto oracle = build<BruteForce>(InstanceSet(rings_of(triangles)));

    // Print a picture from above and aside, with a letter for each teapot. Compare some answers with those of
    // the oracle: all bits are equal.
    int wrong = 0, hits = 0;
    constexpr int rows = 30, columns = 72;
    const Vec3f center = index.bounds().center();
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const Vec3f at(center[0] + 70 * ((static_cast<float>(column) + 0.5f) / columns - 0.5f),
                           center[1] + 70 * (0.5f - (static_cast<float>(row) + 0.5f) / rows), 60);
            const Ray3f ray{at, {0.1f, 0.2f, -2}};
            const auto hit = closest_hit(index, ray);
            hits += bool(hit);
            std::putchar(hit ? static_cast<char>('a' + hit.instance % 26) : ' ');
            if ((row * columns + column) % 31 != 0) continue;  // the oracle is slow
            const Vec3f near = ray.at(28);
            wrong += hit != closest_hit(oracle, ray);
            wrong += closest_point(index, near) != closest_point(oracle, near);
        }
        std::putchar('\n');
    }
    const double megabytes = static_cast<double>(grid.bytes() + index.bytes()) * 1e-6;
    std::printf("%zu teapots of %zu triangles in %.1f MB, %d of %d rays hit, %d answers differ\n",
                scene.size(), mesh.size(), megabytes, hits, rows * columns, wrong);
    return wrong == 0 && hits > 0 ? 0 : 1;
}
