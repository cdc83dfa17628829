/// Each file of the corpus gives the geometry that it must give, as float and as double, packed or not.
#include <variant>

#include <hedgerow/io/model_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/scene_file.h>

#include "corpus.h"

namespace hedgerow {
namespace {

using namespace testing_io;
using namespace testing_corpus;

template <class T>
std::vector<ThreeCorners> triangles_of(const TriangleMesh<T>& mesh) {
    std::vector<ThreeCorners> all;
    for (const auto& [i, j, k] : mesh.triangles)
        all.push_back({Vec3d(mesh.vertices[i]), Vec3d(mesh.vertices[j]), Vec3d(mesh.vertices[k])});
    return all;
}
template <class T>
std::vector<Vec3d> places_of(const PointCloud<T, 3>& cloud) {
    std::vector<Vec3d> all;
    for (const auto& p : cloud.points) all.emplace_back(p);
    return all;
}

template <class T>
void expect_geometry(const CorpusFile& file, const std::filesystem::path& path) {
    const Scene<T> scene = load_scene<T>(path);
    if (const auto* const mesh = std::get_if<TriangleMesh<T>>(&scene)) {
        EXPECT_EQ(triangles_of(*mesh), file.triangles);
        return;
    }
    const auto* const cloud = std::get_if<PointCloud<T, 3>>(&scene);
    ASSERT_NE(cloud, nullptr);
    EXPECT_TRUE(file.triangles.empty());
    EXPECT_EQ(places_of(*cloud), file.points);
    EXPECT_EQ((places_of(load_points<T, 3>(path))), file.points);
}

TEST(Corpus, EveryFileGivesItsGeometry) {
    const auto all = corpus();
    EXPECT_GE(all.size(), 200u);
    const TempFolder folder;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const CorpusFile& file = all[i];
        SCOPED_TRACE("file " + std::to_string(i) + ", " + file.name + ":\n" + file.bytes);
        for (const auto& [name, bytes] : file.beside) folder.file(name, bytes);
        const auto path = folder.file(file.name, file.bytes);
        try {
            expect_geometry<float>(file, path);
            expect_geometry<double>(file, path);
            gzip(folder / (file.name + ".gz"), file.bytes);
            expect_geometry<float>(file, folder / (file.name + ".gz"));
            if (!file.points.empty()) continue;
            const Model<float> model = load_model<float>(path);
            EXPECT_EQ(triangles_of(model.objects[0].mesh), file.triangles);
            if (file.colour) {
                EXPECT_EQ(model.materials[model.objects[0].material].base_colour, *file.colour);
            }
        } catch (const std::exception& fault) {
            ADD_FAILURE() << fault.what();
        }
    }
}

}  // namespace
}  // namespace hedgerow
