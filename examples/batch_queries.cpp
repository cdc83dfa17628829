// Many questions at once, over arrays that you already have: vertices with positions and normals side by
// side, particles with their masses. Nothing is copied to be looked at.
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

/// Stands for the arrays that a program of yours would have.
std::vector<Vertex> interleaved(const TriangleMesh<float>& mesh) {
    std::vector<Vertex> vertices(mesh.vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        std::copy_n(mesh.vertices[i].data, 3, vertices[i].position);
    return vertices;
}

/// Rays from all around into the box: the same ones on every machine.
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
    // A view is a pointer, a count and a stride. It must not outlive the arrays, nor an index the view's.
    const TriangleMeshView<float> view(
        Strided<Vec3f>(&vertices.data()->position, vertices.size(), sizeof(Vertex)),
        Strided<TriangleIndices>(mesh.triangles.data(), mesh.triangles.size()));
    Executor& threads = default_executor();  // or an Executor of yours; without one all is serial
    const auto index = build(view, threads);

    const std::vector<Ray3f> rays = rays_into(index.bounds(), 100000);
    std::vector<Hit<float>> hits(rays.size());
    closest_hits(index, rays, hits, threads);
    const auto found = std::count_if(hits.begin(), hits.end(), [](const auto& hit) { return bool(hit); });

    // The same with a count for each ray. Any query takes one, and without it counting costs nothing.
    std::vector<Visits> visits(rays.size());
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        wrong += closest_hit(index, rays[i], KeepAll{}, visits[i]).value_or(Hit<float>{}) != hits[i];
    Visits sum;
    for (const Visits& v : visits) sum += v;
    const double n = static_cast<double>(rays.size());
    std::printf("%zu triangles, %zu rays, %td hit\n", mesh.size(), rays.size(), found);
    std::printf("a ray opened %.1f nodes and tested %.1f triangles\n", static_cast<double>(sum.nodes) / n,
                static_cast<double>(sum.primitives) / n);

    const auto oracle = build<BruteForce>(mesh);  // the plain arrays, no structure: the same bits
    for (std::size_t i = 0; i < rays.size(); i += 1000)
        wrong += closest_hit(oracle, rays[i]).value_or(Hit<float>{}) != hits[i];
    return wrong;
}

int ask_points() {
    std::vector<Particle> particles(20000);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Random random(2, i);
        particles[i].mass = 1 + random.uniform();
        for (double& x : particles[i].position) x = random.uniform();
    }
    const PointCloudView<double, 3> view(
        Strided<Vec3d>(&particles.data()->position, particles.size(), sizeof(Particle)));
    const auto index = build<KdTree>(view, {.leaf_size = 8});

    // The mass of the 16 nearest neighbours, in pieces over the threads; a piece reuses its list.
    std::vector<double> masses(1000);
    default_executor().for_each_piece(masses.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<Near<double, 3>> near;
        for (std::size_t i = begin; i < end; ++i) {
            nearest(index, view.point(i), 16, near);
            for (const auto& p : near) masses[i] += particles[p.element].mass;
        }
    });
    std::printf("the 16 particles nearest to the first weigh %g\n", masses[0]);

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
