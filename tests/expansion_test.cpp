/// Expansions of winding numbers: their moments and bounds, every instruction set, and points with normals.
#include <gtest/gtest.h>

#include <numbers>

#include <hedgerow/hedgerow.h>
#include <hedgerow/scenes/generate.h>
#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/random.h>
#include <hedgerow/structures/kdtree/kdtree.h>

using namespace hedgerow;

namespace {

using Corners = std::array<Vec3d, 3>;

TriangleMesh<float> scene(const char* spec) {
    return std::get<TriangleMesh<float>>(generate<float>(parse_scene_spec(spec)));
}
/// Places around the unit cube, corners of the mesh, and places next to these.
std::vector<Vec3f> points_around(const TriangleMesh<float>& mesh, std::size_t count) {
    Random random(31, 7);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f corner = mesh.vertices[random.bits() % mesh.vertices.size()];
        points.push_back(Vec3f(random.in_cube<3>() * 4.0 - Vec3d::all(1.5)));
        points.push_back(corner);
        points.push_back(corner + Vec3f(random.direction<3>() * 1e-3));
    }
    points.push_back(Vec3f::all(std::numeric_limits<float>::max()));
    return points;
}
/// A cluster of small triangles in the unit ball.
std::vector<Corners> cluster_of(std::size_t count, std::uint64_t seed) {
    Random random(32, seed);
    std::vector<Corners> cluster;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d middle = random.direction<3>() * (0.5 * std::cbrt(random.uniform()));
        Corners t;
        for (auto& p : t) p = middle + random.direction<3>() * 0.4;
        cluster.push_back(t);
    }
    return cluster;
}
Vec3d normal_of(const Corners& t) {
    return cross(t[1] - t[0], t[2] - t[0]) * 0.5;
}
/// The row of a cluster of radius 1 about the origin.
std::vector<double> row_of(const std::vector<Corners>& cluster, const Vec3d& center = {}) {
    WindingMoments moments;
    double area = 0, eighth = 0;
    for (const Corners& t : cluster) {
        const Corners y{t[0] - center, t[1] - center, t[2] - center};
        moments.add_triangle(y, normal_of(t));
        area += length(normal_of(t));
        eighth += length(normal_of(t)) * WindingMoments::mean_of_eighth_power(y);
    }
    std::vector<double> row(WindingRow::count);
    WindingRow::write(row.data(), 1, center, 1, area, eighth, moments);
    return row;
}

TEST(WindingMoments, MeansAreThoseOfManyPlaces) {
    const Corners t = cluster_of(1, 3)[0];
    // The middles of n² equal triangles.
    constexpr int n = 400;
    double sum = 0;
    const auto at = [&](double v, double w) {
        const double r2 = length2(t[0] + (t[1] - t[0]) * v + (t[2] - t[0]) * w);
        sum += r2 * r2 * r2 * r2;
    };
    for (int i = 0; i < n; ++i)
        for (int k = 0; i + k < n; ++k) {
            at((i + 1.0 / 3) / n, (k + 1.0 / 3) / n);
            if (i + k + 1 < n) at((i + 2.0 / 3) / n, (k + 2.0 / 3) / n);
        }
    const double mean = WindingMoments::mean_of_eighth_power(t);
    EXPECT_NEAR(mean, sum / (n * n), 1e-4 * mean);
}

TEST(WindingMoments, BoundsHoldAndAreNotVain) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const auto cluster = cluster_of(1 + seed % 7, seed);
        const auto row = row_of(cluster);
        Random random(33, seed);
        double worst = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3d x = random.direction<3>() * (1.02 + 9 * random.uniform() * random.uniform());
            HalfAngles sum;
            for (const Corners& t : cluster) sum.add(0, t, x, 1);
            const WindingTerm term = WindingRow::expanded(row.data(), 1, x);
            ASSERT_LE(std::abs(term.value - sum.turns()), term.error) << length(x);
            worst = std::max(worst, std::abs(term.value - sum.turns()) / term.error);
        }
        EXPECT_GT(worst, 0.05);
    }
    const auto row = row_of(cluster_of(3, 1));
    EXPECT_EQ(WindingRow::expanded(row.data(), 1, Vec3d(1, 0, 0)).error,
              std::numeric_limits<double>::infinity());
}

TEST(WindingMoments, OfPartsAreThoseOfTheWhole) {
    const auto cluster = cluster_of(6, 5);
    const Vec3d center(0.1, -0.2, 0.3), of_part(-0.2, 0.15, 0.4);
    const double radius = 2, of_radius = 0.7;
    const auto offsets = [](const Corners& t, const Vec3d& c, double r) {
        return Corners{(t[0] - c) / r, (t[1] - c) / r, (t[2] - c) / r};
    };
    WindingMoments whole, part, sum;
    for (const Corners& t : cluster) {
        whole.add_triangle(offsets(t, center, radius), normal_of(t));
        part.add_triangle(offsets(t, of_part, of_radius), normal_of(t));
    }
    sum.add_part(part, (of_part - center) / radius, of_radius / radius);
    for (int n = 1; n <= WindingMoments::degrees; ++n) {
        EXPECT_NEAR(sum.norm(n), whole.norm(n), 1e-12 * (1 + whole.norm(n)));
        for (int m = 0; m <= n; ++m) {
            const auto [a, b] = whole.coefficients(n, m);
            const auto [c, d] = sum.coefficients(n, m);
            EXPECT_NEAR(a, c, 1e-10 * (1 + whole.norm(n)));
            EXPECT_NEAR(b, d, 1e-10 * (1 + whole.norm(n)));
        }
    }
}
// As many levels as the deepest tree has, each half as large again as the one below, up to a cluster of
// radius 1: roundings stay a hundred times below what WindingRow allows for.
TEST(WindingMoments, RoundingsOfManyLevelsAreFarBelowTheirAllowance) {
    constexpr int levels = 64;
    constexpr double allowed = 0x1p-38;
    Random random(34, 0);
    double radius = std::pow(1.5, -levels);
    Vec3d center{};
    WindingMoments moments, whole;
    std::vector<Corners> all;
    for (int level = 0; level <= levels; ++level) {
        if (level > 0) {
            const Vec3d moved = random.direction<3>() * (radius / 2);
            WindingMoments larger;
            larger.add_part(moments, moved * -1.0 / (1.5 * radius), 1 / 1.5);
            moments = larger, radius *= 1.5, center = center + moved;
        }
        // A triangle of this level, of about its size.
        Corners t;
        for (auto& p : t) p = center + random.direction<3>() * radius;
        moments.add_triangle({(t[0] - center) / radius, (t[1] - center) / radius, (t[2] - center) / radius},
                             normal_of(t));
        all.push_back(t);
    }
    double area = 0;
    for (const Corners& t : all) {
        whole.add_triangle({(t[0] - center) / radius, (t[1] - center) / radius, (t[2] - center) / radius},
                           normal_of(t));
        area += length(normal_of(t));
    }
    for (int n = 1; n <= WindingMoments::degrees; ++n)
        for (int m = 0; m <= n; ++m) {
            const auto [a, b] = whole.coefficients(n, m);
            const auto [c, d] = moments.coefficients(n, m);
            EXPECT_LE(std::abs(a - c) + std::abs(b - d), 0.01 * allowed * area) << n << " " << m;
        }
}

/// Compares every instruction set and width with the plain walk, which counts visits.
template <class Ask>
void expect_bits_of_the_walk(const std::vector<Vec3f>& points, Ask ask) {
    const std::string before(name_of(instruction_set()));
    for (const auto name : instruction_sets()) {
        SCOPED_TRACE(std::string(name));
        use_instruction_set(name);
        for (const Vec3f& p : points) {
            Visits visits;
            EXPECT_EQ(ask(p, no_visits), ask(p, visits));
        }
    }
    use_instruction_set(before);
}
TEST(Expansions, HaveTheSameBitsWithEveryInstructionSet) {
    for (const char* const spec : {"gen:soup:3000", "gen:boulder:3000", "gen:cube", "gen:soup:1"}) {
        SCOPED_TRACE(spec);
        auto mesh = scene(spec);
        if (mesh.size() > 100)  // some triangles twice
            for (std::size_t i = 0; i < 30; ++i) mesh.triangles.push_back(mesh.triangles[i]);
        for (const int width : wide_widths) {
            const auto index = build<WideBvh>(mesh, {.width = width});
            for (const double error : {1e-1, 1e-3, 1e-6, 1e-9}) {
                const Solid solid(index, {.by = SideBy::expansion, .error = error});
                expect_bits_of_the_walk(points_around(mesh, 60), [&](const Vec3f& p, auto& count) {
                    return winding_number(solid, p, {}, count);
                });
            }
        }
    }
}
TEST(Expansions, OfScaledMeshesAreTheSame) {
    const auto mesh = scene("gen:soup:500");
    const auto points = points_around(mesh, 100);
    const auto index = build(mesh);
    const Solid solid(index, {.by = SideBy::expansion});
    for (const float scale : {0x1p-60f, 0x1p-20f, 0x1p30f}) {
        auto scaled = mesh;
        for (auto& v : scaled.vertices) v *= scale;
        const auto scaled_index = build(scaled);
        const Solid of_scaled(scaled_index, {.by = SideBy::expansion});
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            EXPECT_EQ(winding_number(solid, points[i]), winding_number(of_scaled, points[i] * scale));
    }
}

/// Samples of the unit sphere, with normals of their share of its area.
template <class T>
struct Samples {
    PointCloud<T, 3> cloud;
    std::vector<Vec<T, 3>> normals;

    explicit Samples(std::size_t count) {
        Random random(34, 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3d n = random.direction<3>();
            cloud.points.emplace_back(n);
            normals.emplace_back(n * (4 * std::numbers::pi / static_cast<double>(count)));
        }
    }
    long double sum(const Vec<T, 3>& x) const {
        using L = long double;
        L sum = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            L along = 0, r2 = 0;
            for (int k = 0; k < 3; ++k) {
                const L d = L(cloud.points[i][k]) - L(x[k]);
                along += L(normals[i][k]) * d, r2 += d * d;
            }
            if (r2 > 0) sum += along / (r2 * std::sqrt(r2) * 4 * std::numbers::pi_v<L>);
        }
        return sum;
    }
};
template <class T>
class OrientedPointsOf : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(OrientedPointsOf, Scalars);

TYPED_TEST(OrientedPointsOf, KeepTheirPromises) {
    using T = TypeParam;
    const Samples<T> s(3000);
    const auto index = build(s.cloud);
    const auto tree = build<KdTree>(s.cloud);
    Random random(35, 1);
    std::vector<Vec<T, 3>> points;
    for (int i = 0; i < 100; ++i) {
        points.emplace_back(random.direction<3>() * (3 * random.uniform()));
        points.push_back(s.cloud.points[random.bits() % s.cloud.size()]);
        points.push_back(points.back() + Vec<T, 3>(random.direction<3>() * 1e-2));
    }
    points.push_back(Vec<T, 3>::all(std::numeric_limits<T>::max()));
    for (const double error : {1e-1, 1e-3, 1e-6}) {
        const OrientedPoints surface(index, s.normals, error);
        const OrientedPoints of_tree(tree, s.normals, error);
        std::vector<double> numbers(points.size());
        winding_numbers(surface, Strided<Vec<T, 3>>(points), std::span(numbers));
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double found = winding_number(surface, points[i]);
            ASSERT_NEAR(found, static_cast<double>(s.sum(points[i])), error);
            EXPECT_EQ(found, numbers[i]);
            EXPECT_EQ(found, winding_number(of_tree, points[i]));
            EXPECT_EQ(side(surface, points[i]), found >= 0.5 ? Side::inside : Side::outside);
        }
    }
    const OrientedPoints surface(index, s.normals);
    EXPECT_EQ(side(surface, {0, 0, 0}), Side::inside);
    EXPECT_EQ(side(surface, {2, 0, 0}), Side::outside);
    EXPECT_TRUE(std::isnan(winding_number(surface, {0, std::numeric_limits<T>::infinity(), 0})));
    if constexpr (std::is_same_v<T, float>)
        expect_bits_of_the_walk(
            points, [&](const Vec3f& p, auto& count) { return winding_number(surface, p, {}, count); });
}
TYPED_TEST(OrientedPointsOf, MayBeFewOrInOnePlace) {
    using T = TypeParam;
    const PointCloud<T, 3> none;
    const std::vector<Vec<T, 3>> nothing;
    const auto empty = build(none);
    EXPECT_EQ(winding_number(OrientedPoints(empty, nothing), {1, 2, 3}), 0);
    for (const std::size_t count : {std::size_t(1), std::size_t(20)}) {
        PointCloud<T, 3> cloud;
        cloud.points.assign(count, Vec<T, 3>(1, 2, 3));
        const std::vector<Vec<T, 3>> normals(count, Vec<T, 3>(0, 0, -2));
        const auto index = build(cloud);
        const OrientedPoints surface(index, normals);
        EXPECT_EQ(winding_number(surface, {1, 2, 3}), 0);
        EXPECT_NEAR(winding_number(surface, {1, 2, 5}), static_cast<double>(count) / (8 * std::numbers::pi),
                    1e-3);
    }
}
TYPED_TEST(OrientedPointsOf, BadInputIsRefused) {
    using T = TypeParam;
    Samples<T> s(10);
    const auto index = build(s.cloud);
    for (const double error : {0.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(OrientedPoints(index, s.normals, error), UsageError);
    std::vector<double> numbers(9);
    EXPECT_THROW(winding_numbers(OrientedPoints(index, s.normals), Strided<Vec<T, 3>>(s.cloud.points),
                                 std::span(numbers)),
                 InputError);
    s.normals[3][1] = std::numeric_limits<T>::infinity();
    EXPECT_THROW(OrientedPoints(index, s.normals), InputError);
    s.normals.pop_back();
    EXPECT_THROW(OrientedPoints(index, s.normals), InputError);
}

}  // namespace
