/// The program that scripts/cross runs on this processor and, emulated, on others. It compares the engine
/// and the rasteriser with brute force for every instruction set that is available, and prints hashes of the
/// bits of all hits and pairs, of paths and of fluids. The hashes must be the same on every processor.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <memory>

#include <hedgerow/ask.h>
#include <hedgerow/ask/families.h>
#include <hedgerow/engine/wide_bvh.h>
#include <hedgerow/fluid/fluid_flow.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/integrators/path_picture.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/scenes/looks.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/brute_force.h>

using namespace hedgerow;

namespace {

std::vector<Ray3f> rays_through(const Box3f& box, const TriangleMesh<float>& mesh, std::size_t count) {
    std::vector<Ray3f> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(5, i / 64 % 2 == 0 ? i : i / 64);  // the rays of every other 64 start in one point
        Vec3f p, q;
        for (int k = 0; k < 3; ++k) {
            p[k] = box.low[k] + (box.high[k] - box.low[k]) * (3 * static_cast<float>(random.uniform()) - 1);
            q[k] = box.low[k] + (box.high[k] - box.low[k]) * static_cast<float>(random.uniform());
        }
        if (i / 64 % 2 == 1) q = q + box.extent() * (0.002f * static_cast<float>(i % 64));
        if (i % 7 == 0) q = mesh.vertices[random.bits() % mesh.vertices.size()];
        rays.push_back({p, q - p});
        if (i % 11 == 0) rays.back().direction[static_cast<int>(i) % 3] = 0;
    }
    return rays;
}

void add(std::uint64_t& sum, std::uint32_t word) {
    sum = (sum ^ word) * 0x100000001B3u;  // FNV-1a, by words
}

/// Prints the hash of brute force's hits. Returns false if the engine differs with some instruction set.
bool agrees(const char* name, const TriangleMesh<float>& mesh, std::size_t count) {
    const auto brute = build<BruteForce>(mesh);
    const auto rays = rays_through(brute.bounds(), mesh, count);
    std::vector<Hit<float>> want(count), got(count);
    closest_hits(brute, std::span<const Ray3f>(rays), std::span(want));
    const std::unique_ptr<bool[]> any(new bool[count]);
    // Hash the hits of brute force.
    std::uint64_t sum = 0xCBF29CE484222325u;
    std::size_t found = 0;
    for (const auto& h : want) {
        for (const float x : {h.t, h.u, h.v}) add(sum, std::bit_cast<std::uint32_t>(x));
        add(sum, h.element);
        found += static_cast<bool>(h);
    }
    std::printf("%-10s %zu of %zu rays hit, sum %016llx\n", name, found, count,
                static_cast<unsigned long long>(sum));
    // Compare every width and instruction set with brute force, in batches and alone.
    for (const int width : wide_widths) {
        WideOptions options;
        options.width = width;
        const auto index = build<WideBvh>(mesh, options);
        for (const auto set : instruction_sets()) {
            use_instruction_set(set);
            closest_hits(index, std::span<const Ray3f>(rays), std::span(got));
            any_hits(index, std::span<const Ray3f>(rays), {any.get(), count});
            for (std::size_t i = 0; i < count; ++i) {
                const auto one = closest_hit(index, rays[i]);
                if (got[i] == want[i] && one == want[i] && any[i] == static_cast<bool>(want[i])) continue;
                std::printf("%s, width %d: ray %zu differs\n", std::string(set).c_str(), width, i);
                return false;
            }
        }
    }
    return true;
}

/// Whether the rasteriser and beams see, with every instruction set, what the rays of a picture do.
bool draws(const char* name, const TriangleMesh<float>& mesh) {
    const auto index = build<WideBvh>(mesh);
    const PictureSamples<float> samples(automatic_camera(index.bounds()), 90, 50);
    const auto rays = samples.rays();
    std::vector<Hit<float>> want(rays.size()), got(rays.size());
    closest_hits(index, std::span<const Ray3f>(rays), std::span(want));
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        Rasteriser<float> rasteriser(samples);
        rasteriser.draw(mesh.view(), got, {.threads = serial_executor()});
        std::vector<Visible> visible(rays.size());
        std::vector<Hit<float>> resolved(rays.size());
        rasteriser.draw_visible(mesh.view(), visible, {.threads = serial_executor()});
        rasteriser.resolve(mesh.view(), visible, resolved, {.threads = serial_executor()});
        const bool drawn = got == want && resolved == want;
        beam_hits(index, samples, got, {.threads = serial_executor()});
        if (drawn && got == want) continue;
        std::printf("%s, %s: differs with %s\n", name, drawn ? "by beams" : "drawn",
                    std::string(set).c_str());
        return false;
    }
    return true;
}
/// Whether lists of first hits, and what cones see, are those of brute force with every instruction set.
bool lists_agree(const char* name, const TriangleMesh<float>& mesh, std::size_t count) {
    const auto brute = build<BruteForce>(mesh);
    const auto index = build<WideBvh>(mesh);
    for (const auto& ray : rays_through(brute.bounds(), mesh, count)) {
        std::array<Hit<float>, 4> want, got;
        const std::size_t hits = first_hits(brute, ray, want);
        const ConeRays<float, 3> cone(ray, 0, 0.05f);
        std::vector<ConeFragment<float>> seen, found;
        cone_fragments(brute, cone, seen);
        for (const auto set : instruction_sets()) {
            use_instruction_set(set);
            cone_fragments(index, cone, found);
            if (first_hits(index, ray, got) == hits &&
                std::equal(got.begin(), got.begin() + hits, want.begin()) && found == seen)
                continue;
            std::printf("%s: first hits or a cone differ with %s\n", name, std::string(set).c_str());
            return false;
        }
    }
    return true;
}
/// Prints the hash of the pairs of points within a radius. Returns false if an instruction set lists others.
bool pairs_agree(std::size_t count) {
    const auto cloud = points<float>(count);
    const auto index = build<WideBvh>(cloud);
    std::vector<PairWithin<float>> want, got;
    for (PrimitiveId a = 0; a < cloud.size(); ++a)
        for (PrimitiveId b = a + 1; b < cloud.size(); ++b) {
            const float distance2 = closest_point(cloud.points[a], cloud.points[b]).distance2;
            if (within_radius(distance2, 0.1f)) want.push_back({a, b, distance2});
        }
    std::uint64_t sum = 0xCBF29CE484222325u;
    for (const auto& pair : want)
        for (const std::uint32_t word : {pair.a, pair.b, std::bit_cast<std::uint32_t>(pair.distance2)})
            add(sum, word);
    std::printf("%-10s %zu pairs, sum %016llx\n", "points", want.size(),
                static_cast<unsigned long long>(sum));
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        pairs_within(index, 0.1f, got, {.threads = serial_executor()});
        if (got == want) continue;
        std::printf("points: pairs differ with %s\n", std::string(set).c_str());
        return false;
    }
    return true;
}

/// Prints the hash of the linear light of a path-traced picture. Returns false if it is another with an
/// instruction set.
bool traces_paths(const char* name) {
    const auto model = generate_model<float>(parse_scene_spec(std::string("gen:") + name));
    const ModelScene<float> scene(model, serial_executor());
    const SceneLights<float> lights(scene);
    PathPictureOptions options;
    options.camera = camera_for(parse_scene_spec(std::string("gen:") + name).name)
                         .value_or(automatic_camera(scene.bounds()));
    options.width = options.height = 32, options.samples = 4;
    std::uint64_t first = 0;
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        const auto picture =
            trace_paths(PathScene<float>{scene, lights, scene.tracer()}, by(serial_executor(), options));
        std::uint64_t sum = 0xCBF29CE484222325u;
        for (std::size_t i = 0; i < picture.light.size(); ++i)
            for (const float x : picture.light.mean(i).data) add(sum, std::bit_cast<std::uint32_t>(x));
        if (first == 0) {
            first = sum;
            std::printf("%-10s paths, sum %016llx\n", name, static_cast<unsigned long long>(sum));
        }
        if (sum == first) continue;
        std::printf("%s: paths differ with %s\n", name, std::string(set).c_str());
        return false;
    }
    return true;
}

/// Prints the hash of the places of a fluid that has flowed for some steps. Returns false if they are others
/// with an instruction set.
template <int D>
bool fluids_agree(const char* name, double viscosity) {
    FluidOptions<D> options;
    options.spacing = 0.05, options.viscosity = viscosity;
    Box<double, D> tank, column;
    tank.low = column.low = {};
    tank.high = Vec<double, D>::all(0.8), column.high = Vec<double, D>::all(0.4);
    std::uint64_t first = 0;
    for (const auto set : instruction_sets()) {
        use_instruction_set(set);
        FluidState<D> start;
        start.places = fill_box(column, options.spacing);
        start.resize(start.places.size());
        FluidFlow<D> flow(start, walls_of_box(tank, options.spacing), options, serial_executor());
        for (int step = 0; step < 60; ++step) flow.step();
        std::uint64_t sum = 0xCBF29CE484222325u;
        for (const auto& place : flow.state().places)
            for (const double x : place.data) {
                const auto bits = std::bit_cast<std::uint64_t>(x);
                add(sum, static_cast<std::uint32_t>(bits)), add(sum, static_cast<std::uint32_t>(bits >> 32));
            }
        if (first == 0) {
            first = sum;
            std::printf("%-10s %zu particles, sum %016llx\n", name, flow.state().size(),
                        static_cast<unsigned long long>(sum));
        }
        if (sum == first) continue;
        std::printf("%s: fluids differ with %s\n", name, std::string(set).c_str());
        return false;
    }
    return true;
}

}  // namespace

int main() {
    std::string sets;
    for (const auto set : instruction_sets()) sets += " " + std::string(set);
    std::fprintf(stderr, "instruction sets:%s\n", sets.c_str());
    const bool good =
        agrees("soup", soup<float>(300), 6400) && agrees("stadium", teapot_in_stadium<float>(1000), 3200) &&
        agrees("hairball", hairball<float>(1000), 3200) && agrees("terrain", terrain<float>(1000), 3200) &&
        draws("soup", soup<float>(300)) && draws("hairball", hairball<float>(1000)) &&
        lists_agree("soup", soup<float>(300), 600) && lists_agree("hairball", hairball<float>(1000), 300) &&
        pairs_agree(2000) && traces_paths("cornell-box") && traces_paths("grass:1000") &&
        fluids_agree<2>("plane", 0) && fluids_agree<2>("viscous", 0.01) && fluids_agree<3>("space", 0);
    return good ? 0 : 1;
}
