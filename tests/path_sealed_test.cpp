/// Closed rooms in bright surroundings: no path finds light, wherever it begins and whatever edge or vertex
/// it meets. HEDGEROW_LONG follows 10⁸ paths, half of them in double.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <hedgerow/scenes/meshes.h>

#include "long_runs.h"
#include "path_scenes.h"

using namespace hedgerow;
using namespace hedgerow::test;

namespace {

/// A closed mesh, and a point from which all of its inside is seen.
struct Room {
    std::string name;
    TriangleMesh<double> mesh;
    Vec3d middle;
};

/// A room of two arms, whose middle is in the corner that both share.
TriangleMesh<double> angle_room() {
    TriangleMesh<double> mesh;
    const double outline[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const double z : {0.0, 1.0})
        for (const auto& p : outline) mesh.vertices.push_back({p[0], p[1], z});
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        mesh.triangles.push_back({i, j, j + 6}), mesh.triangles.push_back({i, j + 6, i + 6});
        // Fans around the corner that points inward.
        if (i == 3 || j == 3) continue;
        mesh.triangles.push_back({3, j, i}), mesh.triangles.push_back({9, i + 6, j + 6});
    }
    return mesh;
}
/// A roof with a square floor: the walls meet it at the angle whose tangent is `steepness`.
TriangleMesh<double> roof(double steepness) {
    TriangleMesh<double> mesh{
        {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, steepness}}, {{0, 2, 1}, {0, 3, 2}}, {}};
    for (std::uint32_t i = 0; i < 4; ++i) mesh.triangles.push_back({i, (i + 1) % 4, 4});
    return mesh;
}
/// A ball of random bumps.
TriangleMesh<double> bumps() {
    TriangleMesh<double> mesh = cube<double>(1200);
    Random random(1);
    for (Vec3d& p : mesh.vertices) p = normalized(p) * random.uniform(0.8, 1.2);
    return mesh;
}
std::vector<Room> rooms() {
    std::vector<Room> all;
    const auto add = [&](const char* name, const TriangleMesh<double>& mesh, const Vec3d& middle = {}) {
        all.push_back({name, mesh, middle});
    };
    const auto moved = [](TriangleMesh<double> mesh, const Transform<3>& to) {
        for (auto& p : mesh.vertices) p = to.there().point(p);
        return mesh;
    };
    const auto turn = Transform<3>::rotation({1, 2, 3}, 0.7);
    add("box", box<double>(1, 2, 3));
    add("turned cube", moved(cube<double>(12), turn));
    add("fine cube", moved(cube<double>(5000), turn));
    add("bumps", bumps());
    add("angle", angle_room(), {0.5, 0.5, 0.5});
    add("roof", roof(1), {0, 0, 0.3});
    add("flat roof", roof(0.1), {0, 0, 0.03});
    add("low room", moved(box<double>(1, 1, 0.02), turn));
    add("tiny", moved(box<double>(1e-12, 2e-12, 1e-12), turn));
    add("huge", moved(cube<double>(300), Transform<3>::scaling(1e12)));
    add("far away", box<double>(1, 1, 1, {1000, -3000, 500}), {1000, -3000, 500});
    return all;
}
/// Normals of the vertices: the means of those of the triangles around.
CornerValues<Vec3f> smooth_normals(const TriangleMesh<double>& mesh) {
    std::vector<Vec3d> sums(mesh.vertices.size());
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const std::uint32_t v : mesh.triangles[i]) sums[v] += normalized(mesh.view().normal(i));
    CornerValues<Vec3f> normals;
    for (const Vec3d& n : sums) normals.values.push_back(Vec3f(normalized(n)));
    return normals;
}

/// A room in a box that shines, with a lamp of each kind and a sky around.
template <class T>
Model<T> in_bright_surroundings(const Room& room, const Material& walls, bool smooth) {
    Box<double, 3> bounds;
    for (const Vec3d& p : room.mesh.vertices) bounds.expand(p);
    const Vec3d middle = bounds.center(), extent = bounds.extent();
    TriangleMesh<T> inside;
    for (const Vec3d& p : room.mesh.vertices) inside.vertices.push_back(Vec<T, 3>(p));
    inside.triangles = room.mesh.triangles;
    auto model = model_of<T>(
        {{inside, walls},
         {box<T>(extent[0], extent[1], extent[2], middle), matte(Vec3f::all(0.5f), Vec3f::all(100))}});
    if (smooth) model.objects[0].attributes.normals = smooth_normals(room.mesh);
    model.lights.push_back(PointLight{"", middle + extent * 0.7, Vec3f::all(1000)});
    model.lights.push_back(DirectionalLight{"", {0.2, 0.1, -1}, Vec3f::all(1000)});
    model.environment = Environment();
    return model;
}

/// What the first ray of a path meets.
enum class Aim { walls, edges, vertices };

/// A path that starts in the middle of a room, between that and a wall, or closer to a wall.
template <class T>
PathStart<T> start_in(const Room& room, Aim aim, std::size_t number) {
    Random random(5, number);
    const TriangleMesh<double>& mesh = room.mesh;
    const auto some_triangle = [&] {
        return mesh.view().triangle(static_cast<std::size_t>(random.uniform() * double(mesh.size())));
    };
    const auto some_point = [&](double most) {
        const auto t = some_triangle();
        const double u = random.uniform(), v = most * random.uniform() * (1 - u);
        return t.a + (t.b - t.a) * u + (t.c - t.a) * v;
    };
    // From close to a wall, a ray to its own edge would run along it.
    const double ways[] = {0, 0.5, aim == Aim::walls ? 0.9 : 0.25};
    const Vec<T, 3> eye(room.middle + (some_point(1) - room.middle) * ways[number % 3]);
    const PathSamples samples(PixelSequence(Sampler::independent, 6, number), 0);
    for (;;) {
        const Vec3d to = aim == Aim::vertices ? some_triangle().a : some_point(aim == Aim::walls ? 1 : 0);
        const Vec<T, 3> along = Vec<T, 3>(to) - eye;
        const T largest = max_component(abs(along));
        if (largest > 0) return {{eye, normalized(along / largest)}, samples};
    }
}

/// Follows paths in a room, and returns how many find light.
template <class T>
std::size_t bright_paths(const Room& room, const Material& walls, bool smooth, Aim aim, std::size_t paths) {
    const auto model = in_bright_surroundings<T>(room, walls, smooth);
    const ModelScene<T> scene(model, serial_executor());
    const SceneLights<T> lights(scene);
    const PathSurfaces<T> surfaces(scene);
    const PathOptions options;
    static const Compensation compensation;
    const PathWorld<T> world{surfaces, lights, options, &compensation};
    std::size_t bright = 0;
    PathWavefront<T>(world, scene.tracer())
        .follow(
            paths, [](std::size_t, std::size_t) {}, [&](std::size_t i) { return start_in<T>(room, aim, i); },
            [&](std::size_t, const PathLight& light) { bright += light.all != Vec3f(); });
    return bright;
}

template <class T>
class SealedRooms : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SealedRooms, Scalars);

/// A ray that runs almost along a wall to its edge leaves less room there than the error of a point. Few
/// paths may get out so.
constexpr double most_at_edges = 1e-4;

TYPED_TEST(SealedRooms, AreBlack) {
    Material rough = matte(Vec3f::all(0.8f));
    rough.specular = 1, rough.roughness = 0.3f;
    Material mirror = matte(Vec3f::all(0.8f));
    mirror.metallic = 1, mirror.roughness = 0;
    const Material white = matte(Vec3f::all(0.7f));
    const auto all = rooms();
    const std::size_t paths = in_long_runs(50'000'000, 66'000) / (all.size() * 6);
    for (const Room& room : all) {
        SCOPED_TRACE(room.name);
        const auto bright = [&](const Material& walls, bool smooth, Aim aim) {
            return bright_paths<TypeParam>(room, walls, smooth, aim, paths);
        };
        EXPECT_EQ(bright(white, false, Aim::walls), 0u);
        EXPECT_EQ(bright(white, true, Aim::walls), 0u) << "smooth";
        EXPECT_EQ(bright(rough, true, Aim::walls), 0u) << "smooth and glossy";
        EXPECT_EQ(bright(mirror, false, Aim::walls), 0u) << "mirrors";
        const double most = most_at_edges * static_cast<double>(paths);
        EXPECT_LE(static_cast<double>(bright(white, false, Aim::edges)), most);
        EXPECT_LE(static_cast<double>(bright(rough, true, Aim::vertices)), most);
    }
}

/// A room with a hole shows that light would be found.
TYPED_TEST(SealedRooms, WouldShowALeak) {
    Room room{"leak", cube<double>(5000), {}};
    room.mesh.triangles.pop_back();
    EXPECT_GT(bright_paths<TypeParam>(room, matte(Vec3f::all(0.7f)), false, Aim::walls, 20000), 3u);
}

}  // namespace
