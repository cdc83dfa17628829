/// Streams of triangles: what a file's stream gives is what its mesh has, in bounded memory.
#include <cmath>

#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/triangle_stream.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/visibility/rasterise_stream.h>
#include <hedgerow/scenes/meshes.h>

#include "counted_memory.h"
#include "io_support.h"

using namespace hedgerow;
using namespace hedgerow::testing_io;

namespace {

template <class T>
class Streams : public testing::Test {
protected:
    TempFolder folder;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Streams, Scalars);

/// The corners of all triangles, by two passes, of which the second begins before the first is at its end.
template <class T>
std::vector<Vec<T, 3>> corners_of(TriangleStream<T>& stream) {
    TriangleMesh<T> part;
    stream.next(part);
    std::vector<Vec<T, 3>> corners;
    stream.for_each_part([&](const TriangleMesh<T>& some, std::uint32_t first) {
        EXPECT_EQ(first, corners.size() / 3);
        EXPECT_LE(some.size(), stream.part_size);
        for (std::size_t i = 0; i < some.size(); ++i)
            for (const auto& p : some.view().corners(i)) corners.push_back(p);
    });
    stream.next(part);
    EXPECT_EQ(part.size(), 0u) << "the end stays the end";
    return corners;
}
template <class T>
std::vector<Vec<T, 3>> corners_of(const TriangleMesh<T>& mesh) {
    std::vector<Vec<T, 3>> corners;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        for (const auto& p : mesh.view().corners(i)) corners.push_back(p);
    return corners;
}

TYPED_TEST(Streams, GiveTheTrianglesOfTheMesh) {
    using T = TypeParam;
    const auto mesh = terrain<T>(70'000);
    save_mesh(this->folder / "a.stl", mesh);
    ASSERT_GT(mesh.size(), TriangleStream<T>::part_size);
    gzip(this->folder / "b.stl.gz", contents(this->folder / "a.stl"));
    const std::string text =
        "solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0.1 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n"
        "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1e-3 0 endloop endfacet\nendsolid "
        "a\n";
    for (const auto& path :
         {this->folder / "a.stl", this->folder / "b.stl.gz", this->folder.file("c.stl", text)}) {
        ASSERT_TRUE(can_stream(path));
        const auto stream = stream_triangles<T>(path);
        EXPECT_EQ(corners_of(*stream), corners_of(load_mesh<T>(path))) << path;
    }
}

TYPED_TEST(Streams, NameTheFaultsOfFiles) {
    using T = TypeParam;
    const auto expect_bad = [&](const std::string& name, const std::string& bytes,
                                const std::vector<std::string>& said) {
        expect_input_error([&] { corners_of(*stream_triangles<T>(this->folder.file(name, bytes))); }, said);
    };
    const std::string corner = "vertex 0 0 0 ", facet = "facet normal 0 0 1 outer loop ",
                      end = "endloop endfacet\n";
    const std::string good = "solid\n" + facet + corner + corner + corner + end;
    expect_bad("a.ply", "ply\n", {"a.ply", ".stl"});
    expect_bad("b.stl", "solid x\nendsolid x\n", {"b.stl", "neither faces nor points"});
    expect_bad("c.stl", "short", {"too short"});
    expect_bad("d.stl", good, {"'endsolid'"});
    expect_bad("e.stl", good + facet + corner + corner + end + "endsolid", {"facet 1", "2 corners"});
    expect_bad("f.stl", good + facet + corner + corner + corner + corner + end + "endsolid",
               {"facet 1", "4 corners"});
    expect_bad("g.stl", good + facet + corner + corner + "vertex 0 nan 0 " + end + "endsolid", {"facet 1"});
    expect_bad("h.stl", good + facet + corner + corner + "vertex 0 1e300 0 " + end + "endsolid", {"facet 1"});
    EXPECT_FALSE(can_stream("a.ply"));
    EXPECT_TRUE(can_stream("A.STL"));
    expect_input_error([&] { stream_triangles<T>(this->folder / "none.stl"); }, {"none.stl"});
}

TYPED_TEST(Streams, StopWhenTheyAreAskedTo) {
    using T = TypeParam;
    save_mesh(this->folder / "a.stl", terrain<T>(70'000));
    std::atomic<bool> cancelled = false;
    const auto stream = stream_triangles<T>(
        this->folder / "a.stl",
        {[&](std::uint64_t done, std::uint64_t) { cancelled = done > 1'000'000; }, &cancelled});
    EXPECT_THROW(corners_of(*stream), Cancelled);
}

/// Any number of triangles is drawn in bounded memory beside the picture.
TYPED_TEST(Streams, AreDrawnInBoundedMemory) {
#ifndef HEDGEROW_SANITIZED
    using T = TypeParam;
    save_mesh(this->folder / "a.stl", terrain<T>(400'000));
    const auto file = stream_triangles<T>(this->folder / "a.stl");
    // Slivers around a spiral.
    MadeTriangles<T> made(2'000'000, [](std::uint32_t i) {
        const T a = static_cast<T>(i) * T(1e-3), r = static_cast<T>(i) * T(5e-7);
        const Vec<T, 3> p(r * std::cos(a), r * std::sin(a), T(0.1) * std::sin(40 * r));
        return Triangle<T, 3>{p, p + Vec<T, 3>(T(0.004), 0, 0), p + Vec<T, 3>(0, T(0.004), T(0.002))};
    });
    for (TriangleStream<T>* const stream : {file.get(), static_cast<TriangleStream<T>*>(&made)}) {
        RasterisingStream<T> rasterising(*stream);
        const Box<T, 3> box = rasterising.bounds();
        RenderOptions options;
        options.width = options.height = 300, options.shading = Shading::normals;
        options.camera = automatic_camera({Vec3f(box.low), Vec3f(box.high)}, 2);
        Picture picture;
        const std::size_t most = most_bytes_of([&] {
            picture = render(PictureParts<T>{rasterising, rasterising}, by(serial_executor(), options));
        });
        const std::size_t pixels = 300 * 300;
        EXPECT_LT(most, (std::size_t(64) << 20) + pixels * (sizeof(Hit<T>) + 200));
        EXPECT_GT(picture.costs.drawn.triangles, 350'000u);
        std::size_t shown = 0;
        for (const auto& pixel : picture.image.pixels) shown += pixel != picture.image.at(0, 0);
        EXPECT_GT(shown, pixels / 8);
    }
#endif
}

}  // namespace
