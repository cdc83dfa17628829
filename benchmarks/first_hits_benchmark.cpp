/// What the first hits of a ray cost beside its closest hit and beside the list of all hits, by how many are
/// found in a call; what the kernel gains over the walk; what pictures of transparent layers cost; and the
/// rasteriser's lists of fragments beside the lists of rays.
///
///   first_hits_benchmark [SCENE ...]    a mesh file, gen:NAME[:SIZE], or stack:N, N layers one behind the
///                                       other; default: gen:hairball:200000 gen:soup:50000 stack:1000
#include <algorithm>
#include <array>

#include <hedgerow/ask.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/shading/transparency.h>
#include <hedgerow/render/visibility/fragments.h>

#include "scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int repeats = 5;
using MeshIndexOf = decltype(build(std::declval<const TriangleMesh<float>&>()));

/// Squares of two triangles across z.
TriangleMesh<float> stack(int layers) {
    TriangleMesh<float> mesh;
    for (int i = 0; i < layers; ++i) {
        const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
        const float z = float(i) / float(layers);
        mesh.vertices.insert(mesh.vertices.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}, {1, 1, z}});
        mesh.triangles.insert(mesh.triangles.end(), {{at, at + 1, at + 2}, {at + 3, at + 2, at + 1}});
    }
    return mesh;
}

/// The rays of a picture that hit something.
std::vector<Ray3f> hitting_rays(const MeshIndexOf& index) {
    constexpr int side = 96;
    const RayMaker make(automatic_camera(index.bounds()), side, side);
    std::vector<Ray3f> rays;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto ray = make.ray<float>(float(x) + 0.5f, float(y) + 0.5f);
            if (any_hit(index, ray)) rays.push_back(ray);
        }
    return rays;
}

/// The list of all hits, in pieces. Returns its length.
std::size_t in_pieces(const MeshIndexOf& index, const Ray3f& ray, std::span<Hit<float>> piece) {
    std::size_t all = 0, n = 0;
    AfterHit after;
    do {
        all += n = first_hits(index, ray, piece, {.after = after});
        if (n > 0) after = piece[n - 1];
    } while (n == piece.size());
    return all;
}

/// Times of queries, by the size of a piece.
void queries(const MeshIndexOf& index, const std::vector<Ray3f>& rays) {
    std::vector<Hit<float>> all, piece;
    const auto each = [&](auto one) {
        return [&, one] {
            std::size_t found = 0;
            for (const auto& ray : rays) found += one(ray);
            return found;
        };
    };
    const std::size_t hits = each([&](const Ray3f& ray) { return all_hits(index, ray, all); })();
    std::printf("  %zu rays, %.1f hits each\n", rays.size(), double(hits) / double(rays.size()));
    std::printf("  %5s %14s %16s %16s\n", "k", "/ closest hit", "walk / kernel", "list / all hits");
    for (const std::size_t k : {1u, 2u, 4u, 8u, 16u, 32u, 64u}) {
        piece.resize(k);
        const auto rate =
            rates(repeats, rays.size(),
                  {each([&](const Ray3f& ray) { return std::size_t(bool(closest_hit(index, ray))); }),
                   each([&](const Ray3f& ray) { return all_hits(index, ray, all); }),
                   each([&](const Ray3f& ray) { return first_hits(index, ray, piece); }),
                   each([&](const Ray3f& ray) {
                       Visits visits;  // which kernels do not count
                       return first_hits(index, ray, piece, {}, KeepAll{}, visits);
                   }),
                   each([&](const Ray3f& ray) { return in_pieces(index, ray, piece); })});
        std::printf("  %5zu %14.2f %16.2f %16.2f\n", k, rate[0] / rate[2], rate[2] / rate[3],
                    rate[1] / rate[4]);
    }
}

/// Times of pictures with layers of one opacity.
void pictures(const MeshIndexOf& index, const std::vector<Ray3f>& rays) {
    std::vector<Composite> composites(rays.size());
    std::printf("  %7s %9s %14s %12s %12s\n", "opacity", "layers", "saved by ends", "calls a ray",
                "back / front");
    for (const float opacity : {0.02f, 0.2f, 0.5f, 0.9f}) {
        const auto layer = [&](const Ray3f&, const Hit<float>& hit) {
            return Layer{{float(hit.element % 3), 0.5f, 0.25f}, opacity};
        };
        const auto counts = composite_front_to_back(index, rays, layer, composites,
                                                    {.counts_saved = true, .threads = serial_executor()});
        TransparencyCounts ending;
        const auto rate = rates(repeats, rays.size(),
                                {[&] {
                                     ending = composite_front_to_back(index, rays, layer, composites,
                                                                      {.threads = serial_executor()});
                                     return ending.layers;
                                 },
                                 [&] {
                                     return composite_back_to_front(index, rays, layer, composites,
                                                                    {.threads = serial_executor()});
                                 }});
        std::printf("  %7.2f %9zu %12.1f %% %12.2f %12.2f\n", double(opacity),
                    std::size_t(counts.layers + counts.saved),
                    100 * double(counts.saved) / double(counts.layers + counts.saved),
                    double(ending.calls) / double(rays.size()), rate[0] / rate[1]);
    }
}

/// Times of the lists of all samples of a picture, by triangles and by rays.
void lists(const TriangleMesh<float>& mesh, const MeshIndexOf& index) {
    const PictureSamples<float> samples(automatic_camera(index.bounds()), 512, 512);
    const auto rays = samples.rays();
    FragmentCounts counts;
    std::vector<Hit<float>> hits;
    std::array<Hit<float>, 8> piece;
    const auto rate =
        rates(repeats, rays.size(),
              {[&] {
                   counts = FragmentLists<float>(samples).list(mesh.view(), [](const FragmentBand<float>&) {},
                                                               {.threads = serial_executor()});
                   return std::size_t(counts.fragments);
               },
               [&] {
                   std::size_t all = 0;
                   for (const auto& ray : rays) all += all_hits(index, ray, hits);
                   return all;
               },
               [&] {
                   std::size_t all = 0;
                   for (const auto& ray : rays) all += in_pieces(index, ray, piece);
                   return all;
               }});
    // Compare the lists of every sample.
    std::size_t differ = 0;
    FragmentLists<float>(samples).list(mesh.view(), [&](const FragmentBand<float>& band) {
        for (int y = band.top(); y <= band.bottom(); ++y)
            for (int x = 0; x < samples.width(); ++x) {
                all_hits(index, samples.ray(x, y), hits);
                const auto list = band.at(x, y);
                differ += !std::equal(list.begin(), list.end(), hits.begin(), hits.end());
            }
    });
    const auto milliseconds = [&](double millions) { return double(rays.size()) / millions * 1e-3; };
    std::printf(
        "  512 x 512: %zu fragments in %zu bands, %.1f tests each; lists by triangles %.0f ms, by rays "
        "%.0f ms, in pieces of 8 %.0f ms; %zu lists differ\n",
        std::size_t(counts.fragments), std::size_t(counts.bands),
        double(counts.raster.tests) / double(counts.fragments), milliseconds(rate[0]), milliseconds(rate[1]),
        milliseconds(rate[2]), differ);
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%s, %s, one thread, medians of %d\n", processor().c_str(), compiler().c_str(), repeats);
    std::vector<std::string> names(arguments + 1, arguments + count);
    if (names.empty()) names = {"gen:hairball:200000", "gen:soup:50000", "stack:1000"};
    for (const auto& name : names) {
        const auto mesh = name.starts_with("stack:") ? stack(std::stoi(name.substr(6))) : scene(name);
        std::printf("%s: %zu triangles\n", name.c_str(), mesh.size());
        const auto index = build(mesh);
        const auto rays = hitting_rays(index);
        if (rays.empty()) continue;
        queries(index, rays);
        pictures(index, rays);
        lists(mesh, index);
    }
}
