/// Thousands of damaged files: every outcome is a sound result or an InputError.
#include <hedgerow/io/image.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/io/validate.h>

#include "damage.h"
#include "gltf_text.h"

namespace hedgerow {
namespace {

using namespace testing_io;

const char* const ascii_stl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "a\n";
const char* const ascii_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty double "
    "z\nproperty uchar r\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty list short float uv\nend_header\n"
    "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n4 0 1 2 3 2 0.5 0.5\n3 0 1 2 0\n";
const char* const obj =
    "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1 4/1\nf -4//1 -3 \\\n-2\n";
const char* const off = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0 255 0 0\n0 1 0\n4 0 1 2 3\n3 0 1 2 0.5 0.5 0.5\n";

TEST(Fuzz, Meshes) {
    TempFolder folder;
    const auto read = [](const std::filesystem::path& path) {
        validate_mesh(load_mesh<float>(path), "the result");
        validate_mesh(load_mesh<double>(path, {.drop_bad = true}), "the result");
    };
    std::mt19937_64 random(4);
    const auto mesh = random_mesh<double>(random);
    for (const std::string name : {"a.ply", "a.stl"}) {
        if (name == "a.stl")
            save_mesh(folder / name, random_mesh<float>(random));  // STL has floats
        else
            save_mesh(folder / name, mesh);
        const std::string whole = contents(folder / name);
        survivors(folder, name, whole, 1500, [&](const auto& path) {
            validate_mesh(load_mesh<double>(path, {.drop_bad = true}), "the result");
        });
        gzip(folder / (name + ".gz"), whole);
        survivors(folder, name + ".gz", contents(folder / (name + ".gz")), 500, read);
    }
    EXPECT_GT(survivors(folder, "b.ply", ascii_ply, 3000, read), 30);
    EXPECT_GT(survivors(folder, "b.stl", ascii_stl, 3000, read), 30);
    EXPECT_GT(survivors(folder, "b.obj", obj, 3000, read), 30);
    EXPECT_GT(survivors(folder, "b.off", off, 3000, read), 30);
}

TEST(Fuzz, Gltf) {
    TempFolder folder;
    const auto read = [](const std::filesystem::path& path) {
        validate_mesh(load_mesh<float>(path), "the result");
        validate_mesh(load_mesh<double>(path, {.drop_bad = true}), "the result");
    };
    int well = 0;
    for (const testing_gltf::GltfCase& c : testing_gltf::gltf_cases()) {
        write_buffer(folder, c.file);
        well += survivors(folder, "a.gltf", c.file.text(), 200, read);
        well += survivors(folder, "a.glb", c.file.container(), 100, read);
    }
    EXPECT_GT(well, 100);
}

TEST(Fuzz, PointsArraysAndImages) {
    TempFolder folder;
    const PointCloud<float, 3> cloud{{{1, 2, 3}, {4, 5, 6}, {0.5f, -1e-9f, 1e18f}}};
    for (const std::string name : {"a.ply", "a.npy", "a.csv"}) {
        save_points(folder / name, cloud);
        const auto read = [](const std::filesystem::path& path) {
            validate_points(load_points<float, 3>(path), "the result");
            validate_points(load_points<double, 3>(path), "the result");
        };
        EXPECT_GT(survivors(folder, name, contents(folder / name), 2000, read), 50) << name;
    }
    save_points(folder / "b.npy", cloud);
    survivors(folder, "b.npy", contents(folder / "b.npy"), 2000, [](const auto& path) {
        const NpyArray array = load_npy(path);
        EXPECT_EQ(array.as<double>().size(), array.size());
    });
    save_png(folder / "a.png", Image(9, 7, {1, 2, 3}));
    survivors(folder, "a.png", contents(folder / "a.png"), 2000, [](const auto& path) {
        const Image image = load_png(path);
        EXPECT_EQ(image.pixels.size(),
                  static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    });
}

TEST(Fuzz, Rows) {
    TempFolder folder;
    const InputColumns columns{{"x", "y", "z", "t"}, {1}};
    const auto read = [&](const std::filesystem::path& path) {
        const auto reader = open_rows<float>(path, row_format(path), columns);
        std::vector<float> numbers;
        while (const std::size_t rows = reader->read(numbers, 3)) EXPECT_EQ(numbers.size(), 4 * rows);
    };
    std::string records;
    for (int i = 0; i < 5; ++i)
        append_record(records, [i](Record& record) {
            record("z", float(i)), record("id", std::uint32_t(i)), record("y", 2.5), record("x", 1.0f);
        });
    {
        RowWriter out(
            folder / "a.npy", RowFormat::npy,
            {{"z", NumberType::f32}, {"id", NumberType::id}, {"y", NumberType::f64}, {"x", NumberType::f32}},
            5);
        out.write(records, 5);
        out.finish();
    }
    EXPECT_GT(survivors(folder, "a.npy", contents(folder / "a.npy"), 3000, read), 50);
    const std::vector<double> plain(20, 1.5);
    save_npy<double>(folder / "b.npy", plain, {5, 4});
    EXPECT_GT(survivors(folder, "b.npy", contents(folder / "b.npy"), 3000, read), 50);
    EXPECT_GT(survivors(folder, "a.csv", "z,x,y\n1,2,3\n4.5,-1e9,inf\n7,8,9\n", 3000, read), 50);
    EXPECT_GT(survivors(folder, "b.csv", "1 2 3 4\n4.5 -1e9 inf 0\n7 8 9 1\n", 3000, read), 50);
    EXPECT_GT(survivors(folder, "a.json", "[[1,2,3],[4.5,-1e9,null],[7,8,9]]", 3000, read), 50);
    EXPECT_GT(survivors(folder, "b.json",
                        "{\"x\":1,\"y\":2,\"z\":3}\n{\"z\":4,\"name\":\"}]\",\"x\":5,\"y\":6}", 3000, read),
              50);
}

}  // namespace
}  // namespace hedgerow
