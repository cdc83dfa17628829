/// What is seen through each pixel of a picture, on one thread: by rasterising and by casting rays, with the
/// build of an index and without, and by beams; beside Mesa's rasteriser, if it was found. The rasteriser
/// draws a visibility buffer, numbers and depths as Mesa does, and hits, at once or from that buffer. Times
/// in milliseconds, and the geometric means of Mesa's times to those of visibility buffers and of hits, and
/// of those of rays to those of beams.
///
///   visibility_benchmark [SIZE] [SCENE ...]     default: 1024, and the dragon if it is there,
///   gen:teapot-in-stadium:50000 gen:terrain:200000 gen:hairball:200000 gen:cornell-box
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include <hedgerow/ask/rays.h>
#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/index.h>
#include <hedgerow/measure/contest.h>
#include <hedgerow/measure/machine.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>

#include "peers/rasterisers.h"
#include "picture_scene.h"

using namespace hedgerow;
using namespace hedgerow::measure;

namespace {

constexpr int rounds = 9;

/// What is measured of a scene: Mesa's time by that of a visibility buffer and of hits, or 0 without Mesa;
/// the time of rays by that of beams, and the visits of beams by those of packets.
struct Ratios {
    double visible = 1, hits = 1, beams = 1, visits = 1;
    void multiply(const Ratios& r) {
        visible *= r.visible, hits *= r.hits, beams *= r.beams, visits *= r.visits;
    }
};
/// Deferred shading, each hit once, beside forward shading, each fragment that is nearest so far: by normals,
/// all by the plain loops.
void measure_shading(const TriangleMesh<float>& mesh, const PictureSamples<float>& samples,
                     const std::vector<Ray<float, 3>>& rays) {
    const SurfacesOf surfaces(mesh);
    Rasteriser<float> rasteriser(samples);
    std::vector<Hit<float>> hits(rays.size());
    std::vector<Vec3f> colours(rays.size());
    const auto shade = [&](std::size_t i, const Hit<float>& hit) {
        colours[i] = surfaces.normal(rays[i], hit);
    };
    const auto draw = [&](Coverage coverage) {
        return rasteriser.draw(mesh.view(), hits,
                               by(serial_executor(), RasterOptions{coverage, false, true}));
    };
    Contest contest;
    std::size_t forward[2]{};
    for (const Coverage coverage : {Coverage::box, Coverage::tiles}) {
        const bool sorted = coverage == Coverage::tiles;
        contest.add(sorted ? "front to back" : "in order",
                    [&draw, coverage] { return draw(coverage).triangles; });
        contest.add("with forward shading", [&, coverage, sorted] {
            return forward[sorted] =
                       rasteriser
                           .draw(mesh.view(), hits,
                                 by(serial_executor(), RasterOptions{coverage, false, true}), shade)
                           .nearest;
        });
    }
    std::size_t seen = 0;
    contest.add("deferred", [&] {
        seen = 0;
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (hits[i]) shade(i, hits[i]), ++seen;
        return seen;
    });
    const auto times = measured_in_turn(3, contest, Clock::thread, [](const std::string&) { return true; });
    const auto more = [&](std::size_t i) { return 1e3 * (times[i + 1].median - times[i].median); };
    const auto a_hit = [&](std::size_t shaded) {
        return double(shaded) / double(std::max<std::size_t>(seen, 1));
    };
    std::printf(
        "    shading: deferred once a hit, %.1f ms; forward %.2f times in order, %.1f ms, and %.2f times "
        "front to "
        "back, %.1f ms\n",
        1e3 * times[4].median, a_hit(forward[0]), more(0), a_hit(forward[1]), more(2));
}

/// A mirror in the plane of the triangle that most samples show, by beams from the eye's image, and by the
/// rays of the samples that show that plane.
void measure_mirror(const MeshIndex<float>& index, const PictureSamples<float>& samples,
                    std::span<const Hit<float>> first) {
    const auto mesh = index.primitives();
    std::vector<std::size_t> shown(mesh.size());
    for (const Hit<float>& hit : first)
        if (hit) ++shown[hit.element];
    const FlatMirror mirror = FlatMirror::through(
        mesh.triangle(static_cast<std::size_t>(std::ranges::max_element(shown) - shown.begin())));
    const auto reflected = samples.in_mirror(mirror);
    const auto wanted = std::make_unique<bool[]>(samples.size());
    std::vector<Ray<float, 3>> rays;
    for (int y = 0; y < samples.height(); ++y)
        for (int x = 0; x < samples.width(); ++x) {
            const std::size_t i = samples.number(x, y);
            const auto lies_in = [&](const Vec3f& p) {
                return std::abs(mirror.above(Vec3d(p))) <= 1e-5 * mirror.reach;
            };
            const auto t = mesh.triangle(first[i] ? first[i].element : 0);
            wanted[i] = first[i] && lies_in(t.a) && lies_in(t.b) && lies_in(t.c);
            if (wanted[i]) rays.push_back(reflected.ray(x, y));
        }
    if (rays.size() < samples.size() / 20) return;
    std::vector<Hit<float>> cast(rays.size()), beamed(samples.size());
    const BeamOptions options{.wanted = {wanted.get(), samples.size()}};
    Contest contest;
    contest.add("rays", [&] {
        closest_hits(index, rays, std::span(cast), {.threads = serial_executor()});
        return rays.size();
    });
    contest.add("beams",
                [&] { return beam_hits(index, reflected, beamed, by(serial_executor(), options)).beams; });
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });
    std::size_t differ = 0, next = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (wanted[i]) differ += !(beamed[i] == cast[next++]);
    std::printf(
        "    a mirror in %.1f%% of the picture: rays %.2f ms, beams %.2f ms, %.2f times as fast; %zu "
        "differ\n",
        100 * double(rays.size()) / double(samples.size()), 1e3 * times[0].median, 1e3 * times[1].median,
        times[0].median / times[1].median, differ);
}

Ratios measure_scene(const std::string& name, int size) {
    const PictureScene shown(name);
    const auto& mesh = shown.mesh;
    const Camera& camera = shown.camera;
    const PictureSamples<float> samples(camera, size, size);
    const auto rays = samples.rays();

    const auto index = build<WideBvh>(mesh, {}, serial_executor());
    Rasteriser<float> rasteriser(samples);
    std::vector<Hit<float>> cast(rays.size()), drawn(rays.size()), resolved(rays.size()), beamed(rays.size());
    std::vector<Visible> visible(rays.size());
    Contest contest;
    contest.add("cast", [&] {
        closest_hits(index, rays, std::span(cast), {.threads = serial_executor()});
        return rays.size();
    });
    contest.add("visible", [&] {
        return rasteriser.draw_visible(mesh.view(), visible, {.threads = serial_executor()}).triangles;
    });
    contest.add("hits of visible", [&] {
        rasteriser.resolve(mesh.view(), visible, resolved, {.threads = serial_executor()});
        return rays.size();
    });
    contest.add("hits", [&] {
        return rasteriser.draw(mesh.view(), drawn, {.threads = serial_executor()}).triangles;
    });
    contest.add("beams",
                [&] { return beam_hits(index, samples, beamed, {.threads = serial_executor()}).beams; });
    contest.add("build and cast", [&] {
        closest_hits(build<WideBvh>(mesh, {}, serial_executor()), rays, std::span(cast),
                     {.threads = serial_executor()});
        return rays.size();
    });
    const auto peer = osmesa(mesh, camera, size, size);
    if (peer)
        contest.add(peer->name(), [&] {
            peer->draw();
            return mesh.size();
        });
    const auto times =
        measured_in_turn(rounds, contest, Clock::thread, [](const std::string&) { return true; });

    std::size_t hit = 0, differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        hit += bool(cast[i]),
            differ += !(cast[i] == drawn[i]) + !(cast[i] == resolved[i]) + !(cast[i] == beamed[i]);
    std::printf("%-28s %7zu triangles, %5.1f%% of pixels hit, %zu samples differ\n", shown.kind.c_str(),
                mesh.size(), 100 * double(hit) / double(rays.size()), differ);
    for (std::size_t i = 0; i < times.size(); ++i)
        std::printf("    %-16s %9.2f ms\n", contest.names[i].c_str(), times[i].median * 1e3);
    // Beams beside rays.
    const BeamCounts packets = beam_hits(index, samples, beamed, {.widest = 0, .threads = serial_executor()}),
                     beams = beam_hits(index, samples, beamed, {.threads = serial_executor()});
    const auto time_of = [&](std::string_view way) {
        return times[static_cast<std::size_t>(std::ranges::find(contest.names, way) - contest.names.begin())]
            .median;
    };
    Ratios ratios{0, 0, time_of("cast") / time_of("beams"), double(beams.visits) / double(packets.visits)};
    std::printf(
        "    beams are %.2f times as fast as rays, with %.1f%% of their visits; %.1f%% of the samples "
        "filled, %llu tiles by packets, %llu again\n",
        ratios.beams, 100 * ratios.visits, 100 * double(beams.filled) / double(rays.size()),
        static_cast<unsigned long long>(beams.packets), static_cast<unsigned long long>(beams.again));
    measure_shading(mesh, samples, rays);
    measure_mirror(index, samples, cast);
    if (!peer) return ratios;
    std::vector<std::uint32_t> elements(rays.size());
    peer->read(elements);
    std::size_t other = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) other += elements[i] != cast[i].element;
    ratios.visible = times.back().median / time_of("visible");
    ratios.hits = times.back().median / time_of("hits");
    std::printf(
        "    %.2f times as fast as %s, %.2f times for hits; it shows another triangle at %.3f%% of the "
        "pixels\n",
        ratios.visible, peer->name().c_str(), ratios.hits, 100 * double(other) / double(rays.size()));
    return ratios;
}

}  // namespace

int main(int count, char** arguments) try {
    const auto [size, names] = PictureArguments(
        count, arguments,
        {"gen:teapot-in-stadium:50000", "gen:terrain:200000", "gen:hairball:200000", "gen:cornell-box"});
    std::printf("%s, %s, one thread, %d x %d, medians of %d\n", processor().c_str(), compiler().c_str(), size,
                size, rounds);
    Ratios product;
    for (const auto& name : names) product.multiply(measure_scene(name, size));
    const double scenes = double(names.size());
    const auto mean = [scenes](double of_all) { return std::pow(of_all, 1 / scenes); };
    if (product.visible > 0)
        std::printf("geometric mean: %.2f times as fast as Mesa, %.2f times for hits\n",
                    mean(product.visible), mean(product.hits));
    std::printf("geometric mean: beams %.2f times as fast as rays, with %.1f%% of their visits\n",
                mean(product.beams), 100 * mean(product.visits));
} catch (const InputError& error) {
    std::fprintf(stderr, "visibility_benchmark: %s\n", error.what());
    return 3;
}
