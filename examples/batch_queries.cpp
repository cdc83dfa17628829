// Many queries at once, over arrays that you already have: vertices whose positions and normals alternate,
// and particles with masses. Views read the arrays where they are.
//
//   batch_queries [MESH]      a mesh file, or else the generated teapot
#include <algorithm>
#include <cstdio>
#include <exception>
#include <vector>

#include <hedgerow/hedgerow.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

struct Vertex {
    float position[3];
    float normal[3];
};
struct Particle {
    double mass;
    double position[3];
};

/// An example of an array that your program may have.
std::vector<Vertex> interleaved(const TriangleMesh<float>& mesh) {
    std::vector<Vertex> vertices(mesh.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        std::copy_n(mesh.vertices[i].data, 3, vertices[i].position);
    return vertices;
}

/// Rays from all around into the box, the same on every machine.
std::vector<Ray3f> rays_into(const Box3f& box, std::size_t count) {
    const Vec3d center(box.center()), extent(box.extent());
    std::vector<Ray3f> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        Random random(1, i);
        const Vec3d from = center + random.direction<3>() * length(extent);
        const Vec3d to = center + random.direction<3>() * (0.4 * max_component(extent));
        rays[i] = {Vec3f(from), Vec3f(to - from)};
    }
    return rays;
}

/// Returns how many answers were wrong.
int ask_rays(const TriangleMesh<float>& mesh) {
    const std::vector<Vertex> vertices = interleaved(mesh);
    // A view is a pointer, a count and a stride. The arrays must outlive the view and every index over it.
    const TriangleMeshView<float> view(
        Strided<Vec3f>(&vertices.data()->position, vertices.size(), sizeof(Vertex)),
        Strided<TriangleIndices>(mesh.triangles.data(), mesh.triangles.size()));
    Executor& threads = default_executor();  // or your own Executor; without one, small work is serial
    const auto index = build(view, threads);

    // Find the closest hits of many rays in one call.
    const std::vector<Ray3f> rays = rays_into(index.bounds(), 100000);
    std::vector<Hit<float>> hits(rays.size());
    closest_hits(index, rays, hits, {.threads = threads});
    const auto found = std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return bool(hit); });

    // Repeat the queries with a count for each ray. Any query takes one; without it counting costs nothing.
    std::vector<Visits> visits(rays.size());
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        wrong += closest_hit(index, rays[i], KeepAll{}, visits[i]) != hits[i];
    Visits sum;
    for (const Visits& v : visits) sum += v;
    const double n = static_cast<double>(rays.size());
    std::printf("%zu triangles, %zu rays, %td hit\n", mesh.size(), rays.size(), found);
    std::printf("a ray opened %.1f nodes and tested %.1f triangles\n", static_cast<double>(sum.nodes) / n,
                static_cast<double>(sum.primitives) / n);

    // Compare some answers with those of brute force, which tests every triangle: all bits are equal.
    const auto oracle = build<BruteForce>(mesh);
    for (std::size_t i = 0; i < rays.size(); i += 1000) wrong += closest_hit(oracle, rays[i]) != hits[i];
    return wrong;
}

int ask_points() {
    // Build an index over the positions inside the particles.
    std::vector<Particle> particles(20000);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Random random(2, i);
        particles[i].mass = 1 + random.uniform();
        for (double& x : particles[i].position) x = random.uniform();
    }
    const PointCloudView<double, 3> view(
        Strided<Vec3d>(&particles.data()->position, particles.size(), sizeof(Particle)));
    const auto index = build<KdTree>(view, {.leaf_size = 8});

    // Sum the masses of the 16 nearest neighbours, in pieces over the threads. Each piece reuses its list.
    std::vector<double> masses(1000);
    default_executor().for_each_piece(masses.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<Near<double, 3>> near;
        for (std::size_t i = begin; i < end; ++i) {
            nearest(index, view.point(i), 16, near);
            for (const auto& p : near) masses[i] += particles[p.element].mass;
        }
    });
    std::printf("the 16 particles nearest to the first weigh %g\n", masses[0]);

    // Compare the answers of two structures.
    int wrong = 0;
    const auto bvh = build<Bvh>(view);
    std::vector<Near<double, 3>> near, other;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        nearest(index, view.point(i), 16, near);
        nearest(bvh, view.point(i), 16, other);
        wrong += near != other || near[0].distance2 != 0;
    }
    return wrong;
}

int main(int argc, char** argv) try {
    const int wrong = ask_rays(argc > 1 ? load_mesh<float>(argv[1]) : teapot<float>(20000)) + ask_points();
    std::printf("%d answers differ\n", wrong);
    return wrong == 0 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "batch_queries: %s\n", error.what());
    return 1;
}
