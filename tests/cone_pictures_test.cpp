/// Pictures by cones: smooth edges are those of many samples, and soft shadows those of many rays to a disc.
#include <gtest/gtest.h>

#include <hedgerow/hedgerow.h>
#include <hedgerow/mesh_index.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/render.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>

using namespace hedgerow;

namespace {

template <class T>
class ConePictures : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ConePictures, Scalars);

template <class T>
RenderOptions options_for(const TriangleMesh<T>& mesh, const char* preset) {
    Box3f box;
    for (const auto& v : mesh.vertices) box.expand(Vec3f(v));
    const auto camera = camera_for(preset);
    RenderOptions options;
    options.width = 40, options.height = 30, options.layers = true;
    options.camera = camera ? *camera : automatic_camera(box);
    options.shading = Shading::normals;
    return options;
}
/// A mesh with all that pictures by cones are made from.
template <class T>
struct ConeScene {
    using Engine = MeshIndex<T>;
    Engine index;
    IndexTracer<Engine> tracer{index};
    IndexCones<Engine> cones{index};
    SurfacesOf<TriangleMesh<T>> surfaces;
    RayCasting<T> casting{tracer};

    explicit ConeScene(const TriangleMesh<T>& mesh) : index(build<WideBvh>(mesh)), surfaces(mesh) {}
    ConeScene(const ConeScene&) = delete;
    PictureParts<T> parts() { return {casting, surfaces, &tracer, nullptr, &cones}; }
};
template <class T>
Picture by_cones(const TriangleMesh<T>& mesh, RenderOptions options) {
    ConeScene<T> scene(mesh);
    options.cones = true;
    return render(scene.parts(), by(default_executor(), options));
}
float difference(const Vec3f& a, const Vec3f& b) {
    return max_component(abs(a - b));
}

/// On pixels that an edge crosses the colours are those of many samples, within 2% in the mean; on others
/// those of one.
TYPED_TEST(ConePictures, HaveTheEdgesOfManySamples) {
    using T = TypeParam;
    const auto expect = [](const char* name, const TriangleMesh<T>& mesh) {
        for (const auto projection : {Projection::perspective, Projection::orthographic}) {
            SCOPED_TRACE(std::string(name) +
                         (projection == Projection::orthographic ? ", parallel rays" : ""));
            RenderOptions options = options_for(mesh, name);
            options.camera.projection = projection;
            const Picture cones = by_cones(mesh, options);
            EXPECT_EQ(cones.costs.cones, cones.image.pixels.size());
            const auto index = build<WideBvh>(mesh);
            const Picture one = render(index, mesh, by(default_executor(), options));
            options.samples = 1024;  // 256 err by 1% themselves
            const Picture many = render(index, mesh, by(default_executor(), options));
            double edges = 0, even = 0;
            std::size_t on_edges = 0, others = 0;
            for (std::size_t i = 0; i < many.light.size(); ++i) {
                const auto error = double(difference(cones.light[i], many.light[i]));
                // An edge is where the samples are not all alike.
                if (difference(one.light[i], many.light[i]) > 0.02f)
                    edges += error, ++on_edges;
                else
                    even += error, ++others;
            }
            EXPECT_GT(on_edges, 50u);
            EXPECT_LT(edges / double(on_edges), 0.02);
            EXPECT_LT(even / double(others), 0.002);
        }
    };
    expect("cornell-box", cornell_box<T>(0));
    expect("teapot", teapot<T>(2000));
    expect("hairball", hairball<T>(3000));
    expect("soup", soup<T>(300));
}

/// The share of a disc of 5 degrees that points see, beside 256 rays to it.
TYPED_TEST(ConePictures, HaveTheShadowsOfManyRays) {
    using T = TypeParam;
    const auto mesh = soup<T>(300);
    const auto index = build<WideBvh>(mesh);
    const IndexCones cones(index);
    const double slope = std::tan(2.5 * 3.14159265358979323846 / 180);
    double error = 0;
    std::size_t partly = 0;
    for (std::uint64_t i = 0; i < 4000 && partly < 400; ++i) {
        Random random(91, i);
        Vec3d from(index.bounds().center());
        for (int k = 0; k < 3; ++k) from[k] += (random.uniform() - 0.5) * double(index.bounds().extent()[k]);
        const Vec3d axis = random.direction<3>();
        Vec3d beside;
        beside[std::abs(axis[0]) < 0.5 ? 0 : 1] = 1;
        const Vec3d right = normalized(cross(axis, beside)), up = cross(axis, right);
        std::vector<Ray<T, 3>> rays;
        for (int s = 0; s < 256; ++s) {
            const int column = s % 16, row = s / 16;
            const LensPoint p =
                lens_point((static_cast<float>(column) + 0.5f) / 16, (static_cast<float>(row) + 0.5f) / 16);
            rays.push_back(
                {Vec<T, 3>(from), Vec<T, 3>(axis + (right * double(p.right) + up * double(p.up)) * slope)});
        }
        const auto blocked = std::make_unique<bool[]>(rays.size());
        any_hits(index, rays, std::span<bool>(blocked.get(), rays.size()));
        const double open = double(std::count(blocked.get(), blocked.get() + 256, false)) / 256;
        const double seen =
            double(cones.open({Ray<T, 3>{Vec<T, 3>(from), Vec<T, 3>(axis)}, T(0), static_cast<T>(slope)}));
        if (open == 0 || open == 1) {
            EXPECT_NEAR(seen, open, 0.05) << i;
            continue;
        }
        error += std::abs(seen - open), ++partly;
    }
    EXPECT_GE(partly, 200u);
    EXPECT_LT(error / double(partly), 0.02);
}

/// A square over a floor: its shadow is soft as far as the disc of the light reaches beyond its edge.
TYPED_TEST(ConePictures, ShadowsAreSoftAtTheirEdges) {
    using T = TypeParam;
    const TriangleMesh<T> mesh{
        {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}, {-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}},
        {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}},
        {}};
    ConeScene<T> scene(mesh);
    RenderOptions options;
    options.width = 200, options.height = 1, options.layers = true;
    options.camera.eye = {0, 0, 0.5f}, options.camera.target = {0, 0, 0}, options.camera.up = {0, 1, 0};
    options.camera.projection = Projection::orthographic,
    options.camera.height = 0.002f;  // x from -0.2 to 0.2
    options.camera.light = {0, 0, 1};
    options.light_degrees = 10;
    const Picture soft = render(scene.parts(), by(serial_executor(), options));
    const PlainShading shading(options.camera, 0);
    const float reach = std::tan(5 * 3.14159265f / 180);  // of the penumbra, to either side
    for (std::size_t i = 0; i < 200; ++i) {
        const float x = (float(i) + 0.5f - 100) * 0.002f, at = std::clamp(x / reach, -1.f, 1.f);
        // The part of a disc beyond a chord.
        const float open = 1 - (std::acos(at) - at * std::sqrt(1 - at * at)) / 3.14159265f;
        const float got = (soft.light[i][0] - shading.sky({0, 0, 1})[0]) / shading.direct(1)[0];
        EXPECT_NEAR(got, open, 0.03f) << x;
    }
    EXPECT_EQ(soft.costs.cones, 200u);
}

TYPED_TEST(ConePictures, RefuseWhatTheyCannotSee) {
    using T = TypeParam;
    const auto mesh = cornell_box<T>(0);
    ConeScene<T> scene(mesh);
    const Cones<T>* const answering = &scene.cones;
    const auto refused = [&](const Cones<T>* cones, auto change) {
        PictureParts<T> parts = scene.parts();
        parts.cones = cones;
        RenderOptions options = options_for(mesh, "cornell-box");
        options.cones = true;
        change(options);
        EXPECT_THROW(render(parts, by(serial_executor(), options)), InputError);
    };
    refused(nullptr, [](RenderOptions&) {});
    refused(answering, [](RenderOptions& o) { o.samples = 2; });
    refused(answering, [](RenderOptions& o) { o.transparent = true; });
    refused(answering, [](RenderOptions& o) { o.shading = Shading::steps; });
    refused(answering, [](RenderOptions& o) { o.camera.lens_radius = 1; });
    refused(answering, [](RenderOptions& o) { o.camera.projection = Projection::panorama; });
    refused(answering, [](RenderOptions& o) { o.light_degrees = 90; });
    refused(nullptr,
            [](RenderOptions& o) { o.cones = false, o.light_degrees = 5, o.shading = Shading::diffuse; });
}

}  // namespace
