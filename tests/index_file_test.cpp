/// Saved indexes: a loaded index answers with the same bits as the index that was saved.
#include <hedgerow/io/scene_file.h>
#include <hedgerow/scenes/random.h>

#include "index_files.h"

namespace hedgerow {
namespace {

using namespace testing_io;

template <class T>
TriangleMesh<T> moved(TriangleMesh<T> mesh) {
    for (auto& v : mesh.vertices) v = Vec<T, 3>(v[1] * 2, v[0] + v[2], v[2] - 3);
    return mesh;
}

template <class T>
void expect_same_facts(const MeshIndex<T>& want, const MeshIndex<T>& got) {
    const auto &a = want.structure(), &b = got.structure();
    EXPECT_EQ(got.validate(), "");
    EXPECT_EQ(want.size(), got.size());
    EXPECT_EQ(want.bounds(), got.bounds());
    EXPECT_EQ(want.bytes(), got.bytes());
    EXPECT_EQ(a.depth(), b.depth());
    EXPECT_EQ(a.used_node_count(), b.used_node_count());
    EXPECT_EQ(a.item_count(), b.item_count());
    EXPECT_EQ(a.drift(), b.drift());
    EXPECT_EQ(a.options().width, b.options().width);
    EXPECT_EQ(a.options().builder, b.options().builder);
    EXPECT_EQ(a.options().max_leaf_size, b.options().max_leaf_size);
    EXPECT_EQ(a.options().traversal_cost, b.options().traversal_cost);
    EXPECT_EQ(a.options().intersection_cost, b.options().intersection_cost);
    EXPECT_EQ(a.options().reinsertion, b.options().reinsertion);
}

/// Compares the answers of two indexes to every query, by kernels and by the plain walk.
template <class T>
void expect_same_answers(const TriangleMesh<T>& mesh, MeshIndex<T> want, MeshIndex<T> got) {
    const auto targets = matrix::targets_of(mesh);
    for (std::size_t i = 0; i < 100 && !targets.empty(); ++i) {
        const auto ray = matrix::ray_of(want.bounds(), targets, i);
        Visits visits, as_many;
        ASSERT_EQ(closest_hit(want, ray), closest_hit(got, ray)) << "ray " << i;
        ASSERT_EQ(closest_hit(want, ray, KeepAll{}, visits), closest_hit(got, ray, KeepAll{}, as_many));
        ASSERT_EQ(visits.nodes, as_many.nodes) << "ray " << i;
        ASSERT_EQ(hit_count(want, ray), hit_count(got, ray)) << "ray " << i;
    }
    matrix::Indexes<T, 3> indexes;
    indexes.push_back(any_index(std::move(want)));
    indexes.push_back(any_index(std::move(got)));
    if (mesh.size() > 0) matrix::expect_equal_regions(indexes, 50);
    if (!targets.empty()) matrix::expect_equal_rays(indexes, targets, 0, 300);
}

template <class T>
void expect_round_trip(const TempFolder& folder, const char* name, const TriangleMesh<T>& mesh) {
    for (const int width : wide_widths) {
        SCOPED_TRACE(std::string(name) + ", width " + std::to_string(width));
        const auto path = folder / "index.hedgerow", again = folder / "again.hedgerow";
        const auto index = built(mesh, width);
        save_index(path, index);
        for (const auto& way : ways_to_load) {
            const auto loaded = load_index<T>(path, way, default_executor());
            expect_same_facts(index, loaded);
            expect_same_answers(mesh, index, load_index<T>(path, way));
            if (testing::Test::HasFatalFailure()) return;
            save_index(again, loaded);
            ASSERT_EQ(contents(path), contents(again)) << "saved again";
        }
        save_index(again, built(mesh, width, default_executor()));
        ASSERT_EQ(contents(path), contents(again)) << "built and saved again";
    }
    EXPECT_EQ(folder.file_count(), 2u);
}

TEST(Stored, CopiesAreDeepAndOwnersStay) {
    const auto owner = std::make_shared<std::vector<int>>(std::vector<int>{1, 2, 3});
    Stored<int> lent(owner, owner->data(), 3);
    EXPECT_EQ(lent.data(), owner->data());
    EXPECT_EQ(owner.use_count(), 2);
    Stored<int> copy = lent;
    copy[1] = 7;
    EXPECT_EQ((*owner)[1], 2);
    EXPECT_EQ(owner.use_count(), 2) << "a copy is its own";
    const int* const place = copy.data();
    Stored<int> taken = std::move(copy);
    EXPECT_EQ(taken.data(), place);
    EXPECT_TRUE(copy.empty());  // NOLINT: what is left of it is an empty array
    lent = std::move(taken);
    EXPECT_EQ(owner.use_count(), 1);
    EXPECT_EQ(std::vector<int>(lent.begin(), lent.end()), (std::vector<int>{1, 7, 3}));
    lent = Stored<int>();
    EXPECT_EQ(lent.bytes(), 0u);
    EXPECT_EQ(Stored<int>(lent).data(), nullptr);
}

template <class T>
class IndexFile : public testing::Test {
protected:
    TempFolder folder;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(IndexFile, Scalars);

TYPED_TEST(IndexFile, IsLoadedAsItWasSaved) {
    using T = TypeParam;
    expect_round_trip(this->folder, "stadium", teapot_in_stadium<T>(1500));
    expect_round_trip(this->folder, "soup with faces", with_faces(soup<T>(400)));
    expect_round_trip(this->folder, "one", one_triangle<T>());
    expect_round_trip(this->folder, "empty", TriangleMesh<T>());
    TriangleMesh<T> coincident = one_triangle<T>();
    coincident.triangles.assign(100, {0, 1, 2});
    expect_round_trip(this->folder, "coincident", coincident);
    TriangleMesh<T> unused = with_faces(one_triangle<T>());
    unused.vertices.push_back({T(-0.0), std::numeric_limits<T>::denorm_min(), 1e17f});
    expect_round_trip(this->folder, "a vertex that is not used", unused);
}

TYPED_TEST(IndexFile, OfEveryBuilderKeepsItsOptions) {
    using T = TypeParam;
    const auto mesh = hairball<T>(500);
    for (const auto builder : wide_builders) {
        auto options = options_of(16, builder);
        options.max_leaf_size = 3, options.reinsertion = 2;
        options.traversal_cost = 1.5, options.intersection_cost = 0.1;
        const auto index = build<WideBvh>(mesh, options);
        save_index(this->folder / "index.hedgerow", index);
        const auto loaded = load_index<T>(this->folder / "index.hedgerow");
        expect_same_facts(index, loaded);
        expect_same_answers(mesh, index, loaded);
    }
}

/// Bytes between the elements of the caller's arrays are not saved.
TYPED_TEST(IndexFile, OfStridedArraysIsAsOfPlainOnes) {
    using T = TypeParam;
    const auto mesh = with_faces(soup<T>(200));
    struct Vertex {
        float before;
        Vec<T, 3> place;
        char after;
    };
    struct Corners {
        TriangleIndices corners;
        std::uint32_t face, material;
    };
    // Put other data beside each vertex and each triangle.
    std::vector<Vertex> vertices;
    for (const auto& v : mesh.vertices) vertices.push_back({1, v, 'x'});
    std::vector<Corners> triangles;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        triangles.push_back({mesh.triangles[i], mesh.faces[i], std::uint32_t(i)});
    const TriangleMeshView<T> view(
        Strided<Vec<T, 3>>(&vertices[0].place, vertices.size(), sizeof(Vertex)),
        Strided<TriangleIndices>(&triangles[0].corners, triangles.size(), sizeof(Corners)),
        Strided<std::uint32_t>(&triangles[0].face, triangles.size(), sizeof(Corners)));
    save_index(this->folder / "strided.hedgerow", MeshIndex<T>(view, options_of(8), serial_executor()));
    save_index(this->folder / "plain.hedgerow", built(mesh));
    EXPECT_EQ(contents(this->folder / "strided.hedgerow"), contents(this->folder / "plain.hedgerow"));
}

TYPED_TEST(IndexFile, IsNotChangedByARefit) {
    using T = TypeParam;
    const auto mesh = teapot_in_stadium<T>(1000), after = moved(mesh), later = moved(after);
    const auto path = this->folder / "index.hedgerow";
    for (const auto& way : ways_to_load) {
        auto index = built(mesh);
        save_index(path, index);
        const std::string before = contents(path);
        auto loaded = load_index<T>(path, way);
        const auto copy = loaded;
        // A refit changes the loaded index, but neither the file nor a copy of the index.
        EXPECT_EQ(index.refit(after.view()), loaded.refit(after.view()));
        expect_same_facts(index, loaded);
        expect_same_answers(after, index, loaded);
        EXPECT_EQ(contents(path), before);
        expect_same_answers(mesh, built(mesh), copy);
        expect_same_answers(mesh, built(mesh), load_index<T>(path, way));

        save_index(path, loaded);  // replaces the file that some of the nodes are still mapped from
        auto saved_later = load_index<T>(path, way);
        expect_same_facts(index, saved_later);
        expect_same_answers(after, index, loaded);
        EXPECT_EQ(index.refit(later.view()), saved_later.refit(later.view()))
            << "drift is of the first build";
        expect_same_answers(later, index, saved_later);
    }
}

TYPED_TEST(IndexFile, MayBeReplacedOrDeletedWhileItsIndexLives) {
    using T = TypeParam;
    const auto mesh = teapot_in_stadium<T>(1000);
    const auto path = this->folder / "index.hedgerow";
    save_index(path, build<WideBvh>(TriangleMesh<T>(mesh), options_of(4)));
    std::optional<MeshIndex<T>> first(load_index<T>(path, {.verify = Verify::header}));
    const MeshIndex<T> second = std::move(*first);
    first.reset();
    save_index(path, built(soup<T>(3000)));
    std::filesystem::remove(path);
    expect_same_answers(mesh, built(mesh, 4), second);
    EXPECT_EQ(this->folder.file_count(), 0u);
}

TYPED_TEST(IndexFile, IsTheSceneOfItsMesh) {
    using T = TypeParam;
    const auto mesh = with_faces(soup<T>(100));
    save_index(this->folder / "A.HEDGEROW", built(mesh));
    const auto scene = std::get<TriangleMesh<T>>(load_scene<T>(this->folder / "A.HEDGEROW"));
    EXPECT_TRUE(same_bits(scene.vertices, mesh.vertices));
    EXPECT_TRUE(same_bits(scene.triangles, mesh.triangles));
    EXPECT_EQ(scene.faces, mesh.faces);
}

TYPED_TEST(IndexFile, SaysWhatItHolds) {
    using T = TypeParam;
    const auto mesh = with_faces(teapot<T>(500));
    const auto index = build<WideBvh>(mesh, options_of(4, WideBuilder::high));
    const auto path = this->folder / "index.hedgerow";
    save_index(path, index);
    const IndexFileInfo info = index_file_info(path);
    EXPECT_EQ(info.version, 3);
    EXPECT_FALSE(info.holds_points);
    EXPECT_EQ(info.dimension, 3);
    EXPECT_EQ(info.scalar, sizeof(T) == 4 ? "float" : "double");
    EXPECT_EQ(info.options.width, 4);
    EXPECT_EQ(info.options.builder, WideBuilder::high);
    EXPECT_EQ(info.triangles, mesh.size());
    EXPECT_EQ(info.vertices, mesh.vertices.size());
    EXPECT_EQ(info.nodes, index.structure().tree().nodes.size());
    EXPECT_EQ(info.leaves, index.structure().leaf_count());
    EXPECT_EQ(info.depth, index.structure().depth());
    EXPECT_TRUE(info.faces);
    EXPECT_EQ(info.bounds.low, Vec3d(index.bounds().low));
    EXPECT_EQ(info.bounds.high, Vec3d(index.bounds().high));
    EXPECT_EQ(info.file_bytes, std::filesystem::file_size(path));
    EXPECT_NEAR(double(info.index_bytes), double(index.bytes()), 200);
}

template <class T, int D>
void expect_points_round_trip(const TempFolder& folder, const PointCloud<T, D>& cloud,
                              const WideOptions& options) {
    const auto path = folder / "points.hedgerow", again = folder / "again.hedgerow";
    const auto index = build<WideBvh>(cloud, options);
    save_index(path, index);
    for (const auto& way : ways_to_load) {
        auto loaded = load_point_index<T, D>(path, way, default_executor());
        EXPECT_EQ(loaded.validate(), "");
        EXPECT_EQ(loaded.size(), cloud.size());
        EXPECT_EQ(loaded.bounds(), index.bounds());
        EXPECT_EQ(loaded.bytes(), index.bytes());
        EXPECT_EQ(loaded.structure().depth(), index.structure().depth());
        save_index(again, loaded);
        ASSERT_EQ(contents(path), contents(again)) << "saved again";
        matrix::Indexes<T, D> indexes;
        indexes.push_back(any_index(index));
        indexes.push_back(any_index(std::move(loaded)));
        if (cloud.size() > 0) matrix::expect_equal_regions(indexes, 30);
        if (testing::Test::HasFatalFailure()) return;
    }
    const IndexFileInfo info = index_file_info(path);
    EXPECT_TRUE(info.holds_points);
    EXPECT_EQ(info.dimension, D);
    EXPECT_EQ(info.points, cloud.size());
    EXPECT_EQ(info.triangles, 0u);
    EXPECT_EQ(info.file_bytes, std::filesystem::file_size(path));
    // The file is also a scene.
    const auto scene = std::get<PointCloud<T, D>>(load_scene<T>(path));
    EXPECT_TRUE(same_bits(scene.points, cloud.points));
}
template <class T, int D>
void expect_points_round_trips(const TempFolder& folder) {
    Random random(4, 0);
    PointCloud<T, D> cloud;
    expect_points_round_trip(folder, cloud, options_of(8));
    for (const std::size_t size : {1u, 9u, 3000u}) {
        while (cloud.size() < size) {
            cloud.points.emplace_back();
            for (int k = 0; k < D; ++k) cloud.points.back()[k] = static_cast<T>(random.uniform() - 0.25);
        }
        for (const int width : wide_widths) expect_points_round_trip(folder, cloud, options_of(width));
        for (const auto builder : wide_builders)
            expect_points_round_trip(folder, cloud, options_of(8, builder));
    }
    cloud.points.assign(100, cloud.points[0]);
    expect_points_round_trip(folder, cloud, options_of(16));
}

TYPED_TEST(IndexFile, OfPointsIsLoadedAsItWasSaved) {
    expect_points_round_trips<TypeParam, 2>(this->folder);
    expect_points_round_trips<TypeParam, 3>(this->folder);
}

}  // namespace
}  // namespace hedgerow
