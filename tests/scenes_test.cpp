/// The scene generators: equal bits everywhere, sizes, sound meshes, and scenes by name.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/random.h>

#include "matrix.h"

namespace hedgerow {
namespace {

/// FNV-1a over 64-bit words.
class Hash {
public:
    void add(std::uint64_t word) {
        for (int i = 0; i < 8; ++i, word >>= 8) value_ = (value_ ^ (word & 0xFF)) * 0x100000001B3u;
    }
    template <int D>
    void add(const Vec<double, D>& p) {
        for (int i = 0; i < D; ++i) add(std::bit_cast<std::uint64_t>(p[i]));
    }
    void add(const TriangleMesh<double>& mesh) {
        for (const Vec3d& p : mesh.vertices) add(p);
        for (const TriangleIndices& t : mesh.triangles)
            for (const std::uint32_t i : t) add(i);
    }
    void add(const SphereSet<double, 3>& set) {
        for (const auto& s : set.spheres) add(s.center), add(std::bit_cast<std::uint64_t>(s.radius));
    }
    template <int D>
    void add(const PointCloud<double, D>& cloud) {
        for (const auto& p : cloud.points) add(p);
    }
    void add(const SegmentSet<double>& set) {
        for (const auto& s : set.segments) add(s.a), add(s.b);
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xCBF29CE484222325u;
};

std::uint64_t hash_of(const SceneSpec& spec) {
    Hash hash;
    std::visit([&](const auto& scene) { hash.add(scene); }, generate<double>(spec));
    return hash.value();
}

std::size_t size_of(const Scene<double>& scene) {
    return std::visit([](const auto& s) { return s.size(); }, scene);
}

template <class T>
std::vector<Vec<T, 3>> points_of(const TriangleMesh<T>& mesh) {
    return mesh.vertices;
}
template <class T, int D>
std::vector<Vec<T, D>> points_of(const PointCloud<T, D>& cloud) {
    return cloud.points;
}
template <class T>
std::vector<Vec<T, 3>> points_of(const SphereSet<T, 3>& set) {
    std::vector<Vec<T, 3>> all;
    for (const auto& s : set.spheres) all.push_back(s.center), all.push_back(Vec<T, 3>::all(s.radius));
    return all;
}
template <class T>
std::vector<Vec<T, 2>> points_of(const SegmentSet<T>& set) {
    std::vector<Vec<T, 2>> all;
    for (const auto& s : set.segments) all.push_back(s.a), all.push_back(s.b);
    return all;
}

template <class T>
TriangleMesh<T> mesh_of(const std::string& name, std::optional<std::uint64_t> size = {}) {
    return std::get<TriangleMesh<T>>(generate<T>({name, size, 0}));
}

template <class T>
void expect_sound(const TriangleMesh<T>& mesh, const std::string& what) {
    std::vector<bool> used(mesh.vertices.size());
    std::size_t flat = 0;
    for (const TriangleIndices& t : mesh.triangles) {
        for (const std::uint32_t i : t) {
            ASSERT_LT(i, mesh.vertices.size()) << what;
            used[i] = true;
        }
        flat += !(length2(Triangle<double, 3>{Vec3d(mesh.vertices[t[0]]), Vec3d(mesh.vertices[t[1]]),
                                              Vec3d(mesh.vertices[t[2]])}
                              .normal()) > 0);
    }
    EXPECT_EQ(flat, 0u) << what << ": triangles without area";
    EXPECT_EQ(std::ranges::count(used, false), 0) << what << ": unused vertices";
}

TEST(Scenes, NumbersAreEvenAndOfLengthOne) {
    Random random(7);
    double sum = 0;
    for (int i = 0; i < 10'000; ++i) {
        const double x = random.uniform();
        ASSERT_TRUE(x >= 0 && x < 1);
        sum += x;
        ASSERT_NEAR(length(random.direction<3>()), 1, 1e-15);
    }
    EXPECT_NEAR(sum / 10'000, 0.5, 0.01);
    EXPECT_NE(Random(1).bits(), Random(2).bits());
    EXPECT_NE(Random(1, 0).bits(), Random(1, 1).bits());
}

TEST(Scenes, HaveTheSameBitsTwiceAndAnotherSeedOthers) {
    for (const SceneInfo& info : scene_list()) {
        const SceneSpec spec{std::string(info.name), 3000, 5};
        EXPECT_EQ(hash_of(spec), hash_of(spec)) << info.name;
        const bool random = info.yields != "triangles" || info.name == "terrain" || info.name == "grass" ||
                            info.name == "hairball" || info.name == "soup" || info.name == "boulder" ||
                            info.name == "interior";
        EXPECT_EQ(hash_of(spec) != hash_of({spec.name, 3000, 6}), random) << info.name;
    }
}

TEST(Scenes, HaveTheBitsTheyAlwaysHad) {
    const std::map<std::string_view, std::uint64_t> pinned = {
        {"teapot", 0xfc72af8703dc68cf},         {"teapot-in-stadium", 0xcd564bf99d31fd30},
        {"terrain", 0x8c4dc721fbc1cda7},        {"soup", 0x0597734ed88ba96d},
        {"cornell-box", 0x7bad3b1adca37542},    {"cube", 0x3ff1bbeb8cf7f725},
        {"spheres", 0xa7b8fbac8cdab736},        {"points", 0xbe25505ea67a5056},
        {"points2d", 0xe3dcdc158aeb987a},       {"clusters2d", 0x9052bdd410191d66},
        {"segments2d", 0x0e079425abdea6d3},     {"turned-stadium", 0x19bc07f5a57c7359},
        {"grass", 0xbacafbd0405bd287},          {"hairball", 0x197857a0ed444a36},
        {"interior", 0x5e64906f6b485afa},       {"boulder", 0x4b056bc5cfacadd0},
        {"plummer", 0x17c339c94a3995ee},        {"hernquist", 0xc8065dc27a617b72},
        {"uniform-sphere", 0xd1f528a1a1a8038f}, {"cold-collapse", 0x9054953ebd5bc9e2},
        {"cold-cube", 0xbe25505ea67a5056},      {"disc", 0x43f2f3ba947bd62b},
        {"two-clusters", 0x77600ee8dd56b5e6},
    };
    for (const SceneInfo& info : scene_list()) {
        const std::uint64_t size = std::min<std::uint64_t>(info.default_size, 10'000);
        const std::uint64_t hash = hash_of({std::string(info.name), size, 0});
        EXPECT_TRUE(pinned.contains(info.name) && hash == pinned.at(info.name))
            << info.name << " 0x" << std::hex << hash;
    }
}

TEST(Scenes, InFloatAreTheDoubleOnesRounded) {
    for (const SceneInfo& info : scene_list()) {
        const SceneSpec spec{std::string(info.name), 2000, 3};
        const Scene<float> narrow = generate<float>(spec);
        const Scene<double> wide = generate<double>(spec);
        ASSERT_EQ(narrow.index(), wide.index());
        const auto all = std::visit([](const auto& s) { return points_of(s).size(); }, wide);
        std::size_t equal = 0;
        std::visit(
            [&]<class N, class W>(const N& n, const W& w) {
                if constexpr (N::dimension == W::dimension) {
                    const auto a = points_of(n);
                    const auto b = points_of(w);
                    ASSERT_EQ(a.size(), b.size());
                    for (std::size_t i = 0; i < a.size(); ++i)
                        equal += a[i] == typename decltype(a)::value_type(b[i]);
                }
            },
            narrow, wide);
        EXPECT_EQ(equal, all) << info.name;
        if (const auto* mesh = std::get_if<TriangleMesh<float>>(&narrow)) {
            EXPECT_EQ(mesh->triangles, std::get<TriangleMesh<double>>(wide).triangles);
        }
    }
}

TEST(Scenes, AreAboutAsLargeAsAskedFor) {
    std::vector<unsigned> sizes{100, 130, 177, 250, 333, 500, 1000, 4000, 33'333};
    if (in_long_runs(1, 0) != 0) sizes.push_back(1'000'000);
    for (const SceneInfo& info : scene_list())
        for (const unsigned size : sizes) {
            const double got =
                static_cast<double>(size_of(generate<double>({std::string(info.name), size, 0})));
            const double slack = info.yields == "triangles" ? 0.2 : 0;
            EXPECT_NEAR(got, static_cast<double>(size), slack * static_cast<double>(size)) << info.name;
        }
}

TEST(Scenes, HaveTheDefaultSizesTheyPromise) {
    for (const SceneInfo& info : scene_list()) {
        if (info.name == "terrain") continue;
        EXPECT_EQ(size_of(generate<double>({std::string(info.name), {}, 0})), info.default_size) << info.name;
    }
    EXPECT_EQ(terrain<float>(2 * 1024 * 1024).vertices.size(), 1025u * 1025u);
}

TEST(Scenes, MayBeTiny) {
    for (const SceneInfo& info : scene_list())
        for (const unsigned size : {0u, 1u, 2u}) {
            const Scene<double> scene = generate<double>({std::string(info.name), size, 0});
            if (const auto* mesh = std::get_if<TriangleMesh<double>>(&scene))
                expect_sound(*mesh, std::string(info.name));
            else
                EXPECT_EQ(size_of(scene), size) << info.name;
        }
}

TEST(Scenes, LieWhereTheyShould) {
    for (const SceneInfo& info : scene_list()) {
        const bool in_unit_cube = (info.yields != "triangles" && info.particles == nullptr) ||
                                  info.name == "terrain" || info.name == "soup";
        const Scene<float> scene = generate<float>({std::string(info.name), 5000, 1});
        std::visit(
            [&](const auto& s) {
                for (const auto& p : points_of(s))
                    for (int i = 0; i < p.dimension; ++i) {
                        ASSERT_TRUE(std::isfinite(p[i])) << info.name;
                        if (in_unit_cube) {
                            ASSERT_TRUE(p[i] >= 0 && p[i] <= 1) << info.name;
                        }
                    }
            },
            scene);
    }
    for (const auto& s : spheres<double>(5000, 1).spheres) {
        ASSERT_GT(s.radius, 0);
        ASSERT_TRUE((Box3d{{0, 0, 0}, {1, 1, 1}}.contains(s.bounds())));
    }
}

TEST(Scenes, HaveSoundMeshes) {
    for (const SceneInfo& info : scene_list()) {
        if (info.yields != "triangles") continue;
        const std::string name(info.name);
        for (const unsigned size : {50u, 100u, 1000u, 12'345u, 300'000u}) {
            expect_sound(mesh_of<double>(name, size), name);
            expect_sound(mesh_of<float>(name, size), name);
        }
    }
}

TEST(SceneSpec, IsRead) {
    EXPECT_EQ(parse_scene_spec("gen:teapot").name, "teapot");
    EXPECT_FALSE(parse_scene_spec("gen:teapot").size.has_value());
    EXPECT_EQ(parse_scene_spec("gen:terrain:500000").size, 500'000u);
    EXPECT_EQ(parse_scene_spec("gen:terrain:100k").size, 100'000u);
    EXPECT_EQ(parse_scene_spec("gen:soup:2M").size, 2'000'000u);
    EXPECT_EQ(parse_scene_spec("gen:points:2147483648").size, largest_scene_size);
}

std::string complaint(std::string_view text) {
    try {
        parse_scene_spec(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SceneSpec, RefusesWhatItDoesNotKnow) {
    EXPECT_NE(complaint("gen:terain").find("did you mean 'terrain'?"), std::string::npos);
    for (const SceneInfo& info : scene_list())
        EXPECT_NE(complaint("gen:xyzzy").find(info.name), std::string::npos);
    for (const char* bad : {"", "teapot", "gen:", "gen::5", "gen:teapot:", "gen:teapot:x", "gen:teapot:-5",
                            "gen:teapot:5:6", "gen:teapot:5kk", "gen:teapot:1e5", "gen:teapot: 5"})
        EXPECT_NE(complaint(bad), "") << bad;
    for (const char* large : {"gen:cube:2147483649", "gen:cube:3G", "gen:cube:99999999999999999999999",
                              "gen:cube:18446744073709551615k"})
        EXPECT_NE(complaint(large).find("too large"), std::string::npos) << large;
    EXPECT_THROW(generate<float>({"terain", {}, 0}), InputError);
    EXPECT_THROW(generate<float>({"cube", largest_scene_size + 1, 0}), InputError);
    EXPECT_THROW(soup<float>(largest_scene_size), InputError);
}

}  // namespace
}  // namespace hedgerow
