/// Pictures: their parts fit together in every combination, and the parts' pictures have the same bits.
#include <gtest/gtest.h>

#include <hedgerow/any_index.h>
#include <hedgerow/instances/instance_set.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/shading/transparency.h>
#include <hedgerow/render/visibility/beams.h>
#include <hedgerow/render/visibility/rasterise.h>
#include <hedgerow/render/visibility/rasterise_stream.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>
#include <hedgerow/structures/bvh/bvh.h>

using namespace hedgerow;

namespace {

template <class T>
class Rendered : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Rendered, Scalars);

template <class I>
RenderOptions options_for(const I& index) {
    RenderOptions options;
    options.width = 75, options.height = 41;
    options.camera = automatic_camera({Vec3f(index.bounds().low), Vec3f(index.bounds().high)});
    return options;
}
void expect_same(const Picture& want, const Picture& is) {
    EXPECT_EQ(want.image, is.image);
    EXPECT_EQ(want.light, is.light);
    ASSERT_EQ(want.seen.size(), is.seen.size());
    for (std::size_t i = 0; i < want.seen.size(); ++i) {
        ASSERT_EQ(want.seen[i].depth, is.seen[i].depth);
        ASSERT_EQ(want.seen[i].normal, is.seen[i].normal);
        ASSERT_EQ(want.seen[i].id, is.seen[i].id);
    }
}

TYPED_TEST(Rendered, RaysAndTrianglesMakeTheSamePicture) {
    using T = TypeParam;
    const auto mesh = teapot_in_stadium<T>(2000);
    const auto index = build<WideBvh>(mesh);
    const IndexTracer tracer(index);
    const SurfacesOf surfaces(mesh);
    for (const auto shading : {Shading::normals, Shading::depth, Shading::diffuse})
        for (const int samples : {1, 3})
            for (const auto coverage : {Coverage::box, Coverage::tiles}) {
                SCOPED_TRACE(shading_names[static_cast<std::size_t>(shading)]);
                RenderOptions options = options_for(index);
                options.camera = *camera_for("teapot-in-stadium");
                options.samples = samples, options.seed = 7, options.shading = shading;
                options.layers = true;
                const Picture cast = render(index, mesh, by(default_executor(), options));
                Rasterising<T> rasterising(mesh.view(), coverage);
                const Picture drawn = render(
                    PictureParts<T>{rasterising, surfaces, shading == Shading::diffuse ? &tracer : nullptr},
                    by(default_executor(), options));
                expect_same(cast, drawn);
                BeamTracing beams(index);
                const Picture beamed =
                    render(PictureParts<T>{beams, surfaces, &tracer}, by(default_executor(), options));
                expect_same(cast, beamed);
                EXPECT_EQ(beamed.costs.rays, cast.costs.rays);
                EXPECT_EQ(drawn.costs.drawn.triangles, mesh.size() * static_cast<std::size_t>(samples));
                EXPECT_EQ(cast.costs.drawn.triangles, 0u);
                EXPECT_LT(drawn.costs.rays, cast.costs.rays);
                EXPECT_TRUE(cast.whole && drawn.whole);
            }
}

TYPED_TEST(Rendered, AnyIndexAndInstancesAreTracersToo) {
    using T = TypeParam;
    const auto mesh = teapot<T>(800);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.layers = true;
    const Picture want = render(index, mesh, by(default_executor(), options));
    expect_same(want, render(*build_any("kdtree", mesh), mesh, by(default_executor(), options)));
    // One instance that stays where it is shows the same hits.
    const InstanceSet set{Instance(index)};
    const auto placed = build<Bvh>(set);
    const Picture instance = render(placed, set, by(default_executor(), options));
    ASSERT_EQ(want.seen.size(), instance.seen.size());
    for (std::size_t i = 0; i < want.seen.size(); ++i) {
        ASSERT_EQ(want.seen[i].id, instance.seen[i].id);
        ASSERT_EQ(want.seen[i].depth, instance.seen[i].depth);
    }
    EXPECT_EQ(want.image.pixels.size(), instance.image.pixels.size());
}

TYPED_TEST(Rendered, TracersTakeFiltersAndCount) {
    using T = TypeParam;
    const auto mesh = soup<T>(300);
    const auto index = build<WideBvh>(mesh);
    const auto any = build_any("bvh", mesh);
    const IndexTracer of_index(index);
    const IndexTracer of_any(*any);
    const auto options = options_for(index);
    const auto rays = PictureSamples<T>(options.camera, 40, 30).rays();
    const auto odd = [](std::size_t ray, const Hit<T>& hit) { return hit.element % 2 == ray % 2; };
    std::vector<Hit<T>> want(rays.size()), found(rays.size());
    const auto blocked = std::make_unique<bool[]>(rays.size());
    closest_hits(index, rays, std::span(want), odd);
    std::size_t hits = 0;
    for (const auto& hit : want) hits += bool(hit);
    EXPECT_GT(hits, rays.size() / 20);
    for (const Tracer<T>* const tracer :
         {static_cast<const Tracer<T>*>(&of_index), static_cast<const Tracer<T>*>(&of_any)}) {
        EXPECT_EQ(tracer->bounds(), index.bounds());
        tracer->closest_hits(rays, found, {}, odd);
        EXPECT_EQ(found, want);
        tracer->any_hits(rays, {blocked.get(), rays.size()}, {}, odd);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(blocked[i], bool(want[i])) << i;
        std::vector<Visits> visits(rays.size());
        tracer->closest_hits(rays, found, visits, odd);
        EXPECT_EQ(found, want);
        std::uint64_t nodes = 0;
        for (const auto& v : visits) nodes += v.nodes;
        EXPECT_GT(nodes, rays.size());
        tracer->closest_hits(rays, found, visits);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(found[i], closest_hit(index, rays[i])) << i;
        tracer->closest_hits(rays, found);
        for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(found[i], closest_hit(index, rays[i])) << i;
    }
}

TYPED_TEST(Rendered, EveryCameraSeesByRays) {
    using T = TypeParam;
    const auto mesh = cornell_box<T>(0);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.shading = Shading::normals, options.samples = 2;
    options.camera = *camera_for("cornell-box");
    const auto seen = [&](auto change) {
        RenderOptions changed = options;
        change(changed.camera);
        const Picture picture = render(index, mesh, by(default_executor(), changed));
        std::size_t shown = 0;
        for (const auto& pixel : picture.image.pixels) shown += pixel != picture.image.at(0, 0);
        EXPECT_GT(shown, picture.image.pixels.size() / 8);
        return picture.image;
    };
    const Image pinhole = seen([](Camera&) {});
    EXPECT_NE(pinhole, seen([](Camera& c) { c.projection = Projection::orthographic; }));
    EXPECT_NE(pinhole, seen([](Camera& c) {
                  c.projection = Projection::panorama, c.eye = {278, 273, 280}, c.target = {278, 273, 400};
              }));
    EXPECT_NE(pinhole, seen([](Camera& c) { c.lens_radius = 60; }));
    // Beams leave what they are not made for to rays.
    for (const auto projection : {Projection::orthographic, Projection::panorama}) {
        options.camera.projection = projection;
        BeamTracing beams(index);
        const SurfacesOf surfaces(mesh);
        expect_same(render(index, mesh, by(default_executor(), options)),
                    render(PictureParts<T>{beams, surfaces}, by(default_executor(), options)));
    }
}

/// What is behind a surface shows through it, whatever finds the first surface of a sample.
TYPED_TEST(Rendered, LightGoesThroughTransparentSurfaces) {
    using T = TypeParam;
    const auto mesh = hairball<T>(20000);
    const auto index = build<WideBvh>(mesh);
    const IndexTracer tracer(index);
    const SurfacesOf surfaces(mesh);
    RenderOptions options = options_for(index);
    options.layers = options.transparent = true, options.opacity = 0.7f, options.shading = Shading::normals;
    options.camera.field_of_view = 15;
    const Picture cast = render(index, mesh, by(default_executor(), options));
    // The same by compositing the rays' layers.
    const PictureSamples<T> samples(options.camera, options.width, options.height);
    const PlainShading shading(options.camera, 0);
    const auto layer = [&](const Ray<T, 3>& ray, const Hit<T>& hit) {
        return Layer{shading.normal(Vec3f(surfaces.normal(ray, hit))), options.opacity};
    };
    std::vector<Composite> want(samples.size());
    const auto counts = composite_front_to_back(index, samples.rays(), layer, want);
    EXPECT_EQ(cast.costs.layers.layers, counts.layers);
    EXPECT_GT(counts.ended, 10u);
    EXPECT_GT(counts.layers, 3 * samples.size() / 2);
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_LE(length(cast.light[i] - want[i].over(shading.background())), 1e-6f) << i;
    for (const auto lit : {Shading::normals, Shading::diffuse}) {
        options.shading = lit;
        const Picture by_rays = render(index, mesh, by(default_executor(), options));
        Rasterising<T> rasterising(mesh.view());
        BeamTracing beams(index);
        const PictureParts<T> drawn{rasterising, surfaces, &tracer}, beamed{beams, surfaces, &tracer};
        expect_same(by_rays, render(drawn, by(default_executor(), options)));
        expect_same(by_rays, render(beamed, by(default_executor(), options)));
        expect_same(by_rays, render(*build_any("kdtree", mesh), mesh, by(default_executor(), options)));
        // Opaque surfaces hide all, and those without opacity nothing.
        options.opacity = 1;
        const Picture opaque = render(index, mesh, by(default_executor(), options));
        options.opacity = 0;
        const Picture clear = render(index, mesh, by(default_executor(), options));
        for (const Vec3f& light : clear.light) ASSERT_EQ(light, shading.background());
        options.transparent = false, options.opacity = 1;
        expect_same(opaque, render(index, mesh, by(default_executor(), options)));
        options.transparent = true, options.opacity = 0.7f;
    }
}

/// A heat map of any size has a scale, or no room for one.
/// Pixels have the bits of all samples, or the mean of the first four where these are much alike.
TYPED_TEST(Rendered, RefinementGivesSamplesWhereLightDiffers) {
    using T = TypeParam;
    const auto mesh = teapot<T>(800);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.layers = true;
    options.samples = 16;
    const Picture all = render(index, mesh, by(default_executor(), options));
    options.refines = true;
    for (const bool transparent : {false, true}) {
        options.transparent = transparent;  // though all is opaque
        const Picture refined = render(index, mesh, by(default_executor(), options));
        std::size_t equal = 0;
        double off = 0;
        for (std::size_t i = 0; i < all.light.size(); ++i) {
            equal += refined.light[i] == all.light[i];
            off = std::max(
                off,
                double(max_component(max(refined.light[i] - all.light[i], all.light[i] - refined.light[i]))));
        }
        EXPECT_TRUE(refined.whole);
        EXPECT_GT(off, 0) << "most of the picture is background or smooth";
        EXPECT_LT(off, 0.15) << "contrast that is not seen";
        if (transparent) continue;
        EXPECT_LT(refined.costs.rays, all.costs.rays / 2);
        EXPECT_GT(equal, all.light.size() / 20) << "edges have all samples";
        EXPECT_EQ(refined.seen[1500].depth, all.seen[1500].depth);
    }
    options.transparent = false, options.samples = 4;
    const Picture four = render(index, mesh, by(serial_executor(), options));
    options.refines = false;
    expect_same(render(index, mesh, by(default_executor(), options)), four);
}

TYPED_TEST(Rendered, HeatMapsOfAnySize) {
    const auto mesh = cornell_box<TypeParam>(0);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.shading = Shading::steps;
    for (options.height = 1; options.height < 300; options.height += options.height < 60 ? 1 : 47)
        for (options.width = 20; options.width < 100; options.width += 37)
            EXPECT_TRUE(render(index, mesh, by(serial_executor(), options)).whole);
}

TYPED_TEST(Rendered, PartsThatDoNotFitAreRefused) {
    using T = TypeParam;
    const auto mesh = cornell_box<T>(0);
    const auto index = build<WideBvh>(mesh);
    const RenderOptions sound = options_for(index);
    const SurfacesOf surfaces(mesh);
    const IndexTracer tracer(index);
    Rasterising<T> rasterising(mesh.view());
    const auto refused = [&](const Tracer<T>* asked, auto change) {
        RenderOptions options = sound;
        change(options);
        EXPECT_THROW(render(PictureParts<T>{rasterising, surfaces, asked}, by(serial_executor(), options)),
                     InputError);
    };
    refused(nullptr, [](RenderOptions& o) { o.shading = Shading::diffuse; });
    refused(&tracer, [](RenderOptions& o) { o.shading = Shading::steps; });
    refused(&tracer, [](RenderOptions& o) { o.shading = Shading::time; });
    refused(&tracer, [](RenderOptions& o) { o.width = 0; });
    refused(&tracer, [](RenderOptions& o) { o.samples = 0; });
    refused(&tracer, [](RenderOptions& o) { o.camera.field_of_view = 0; });
    refused(&tracer, [](RenderOptions& o) { o.camera.projection = Projection::panorama; });
    refused(&tracer, [](RenderOptions& o) { o.camera.lens_radius = 1; });
    refused(&tracer, [](RenderOptions& o) { o.transparent = true, o.opacity = 1.5f; });
    refused(&tracer, [](RenderOptions& o) { o.transparent = true, o.opacity = std::nanf(""); });
    refused(nullptr, [](RenderOptions& o) { o.transparent = true, o.shading = Shading::normals; });
    RayCasting<T> casting(tracer);
    RenderOptions steps = sound;
    steps.shading = Shading::steps, steps.transparent = true;
    EXPECT_THROW(render(PictureParts<T>{casting, surfaces, &tracer}, by(serial_executor(), steps)),
                 InputError);
}

TYPED_TEST(Rendered, AnInterruptedRasterKeepsItsFinishedSamples) {
    using T = TypeParam;
    const auto mesh = teapot<T>(500);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.shading = Shading::normals, options.samples = 4;
    const SurfacesOf surfaces(mesh);
    Rasterising<T> rasterising(mesh.view());
    std::atomic<bool> cancelled = false;
    std::uint64_t total = 0;
    const Progress progress{[&](std::uint64_t done, std::uint64_t all) {
                                total = all;
                                cancelled = done >= 41 + 10;
                            },
                            &cancelled};
    const Picture picture =
        render(PictureParts<T>{rasterising, surfaces}, by(serial_executor(), options), progress);
    EXPECT_EQ(total, 4u * 41);
    EXPECT_FALSE(picture.whole);
    EXPECT_EQ(picture.pixels, picture.image.pixels.size()) << "each has one or two samples";
    // The last rows have only the first sample.
    options.samples = 4;
    for (int x = 0; x < options.width; ++x) EXPECT_NE(picture.image.at(x, 40), Image::Pixel{}) << x;
}

/// A mesh with corners of its own for each triangle, as a stream.
template <class T>
MadeTriangles<T> stream_of(const TriangleMesh<T>& mesh) {
    return {static_cast<std::uint32_t>(mesh.size()),
            [view = mesh.view()](std::uint32_t i) { return view.triangle(i); }};
}
TYPED_TEST(Rendered, AStreamOfTrianglesMakesThePictureOfTheMesh) {
    using T = TypeParam;
    const auto mesh = terrain<T>(150'000);  // three parts
    ASSERT_GT(mesh.size(), 2 * TriangleStream<T>::part_size);
    const auto index = build<WideBvh>(mesh);
    RenderOptions options = options_for(index);
    options.layers = true, options.samples = 2;
    for (const auto shading : {Shading::normals, Shading::depth}) {
        options.shading = shading;
        const Picture want = render(index, mesh, by(default_executor(), options));
        auto stream = stream_of(mesh);
        RasterisingStream<T> rasterising(stream);
        EXPECT_EQ(rasterising.bounds(), index.bounds());
        const Picture drawn =
            render(PictureParts<T>{rasterising, rasterising}, by(default_executor(), options));
        expect_same(want, drawn);
        EXPECT_EQ(drawn.costs.drawn.triangles, 2 * mesh.size());
    }
    MadeTriangles<T> none(0, {});
    RasterisingStream<T> nothing(none);
    const Picture empty = render(PictureParts<T>{nothing, nothing}, by(serial_executor(), options));
    EXPECT_EQ(empty.seen[5].id, Hit<T>::none);
}

}  // namespace
