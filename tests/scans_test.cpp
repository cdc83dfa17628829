/// The matrix on scanned meshes. Some rays are compared with brute force, the others between the structures.
/// scripts/fetch-scenes brings the scans.
#include "matrix.h"

#include <filesystem>

#include <hedgerow/io/mesh_file.h>

using namespace hedgerow;
using namespace hedgerow::matrix;

namespace {

template <class T>
void expect_equal(const std::string& file) {
    const std::string path = HEDGEROW_DATA "/" + file;
    if (!std::filesystem::exists(path))
        GTEST_SKIP() << "skipped: there is no data/" << file << "; scripts/fetch-scenes brings it";
    const auto mesh = load_mesh<T>(path);
    const auto targets = targets_of(mesh);
    Indexes<T, 3> indexes;
    for (const char* spec : fast_structures) {
        indexes.push_back(build_any(spec, mesh));
        EXPECT_EQ(indexes.back()->validate(), "") << spec;
    }
    const std::size_t with_oracle = in_long_runs(10000, 200), rays = in_long_runs(1000000, 20000);
    expect_equal_rays(indexes, targets, 0, rays);
    indexes.insert(indexes.begin(), build_any("brute-force", mesh));
    expect_equal_rays(indexes, targets, 0, with_oracle);
    expect_equal_regions(indexes, in_long_runs(100, 5));
}

TEST(Scans, BunnyFloat) {
    expect_equal<float>("bunny.ply");
}
TEST(Scans, BunnyDouble) {
    expect_equal<double>("bunny.ply");
}
TEST(Scans, DragonFloat) {
    expect_equal<float>("dragon.ply.gz");
}
TEST(Scans, DragonDouble) {
    if (in_long_runs(0, 1) == 1) GTEST_SKIP() << "skipped: a minute, in the long suites (HEDGEROW_LONG=1)";
    expect_equal<double>("dragon.ply.gz");
}

}  // namespace
