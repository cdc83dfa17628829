/// Beams and cones miss nothing that one of their rays hits: every structure, set and scalar. What cones see.
#include <hedgerow/ask/families.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/generate.h>

#include "every_structure.h"
#include "generated.h"

using namespace hedgerow;
using namespace hedgerow::generated;
namespace gen = rc::gen;

namespace {

/// Calls f(name, index) for every structure, and for BVHs of every volume.
template <class P, class F>
void for_each_type_and_volume(const P& set, F f) {
    for_each_type(set, f);
    constexpr bool space = P::dimension == 3;
    for (const Volume volume :
         {Volume::obb, space ? Volume::kdop14 : Volume::kdop8, space ? Volume::cylinder : Volume::kdop4,
          space ? Volume::hull : Volume::obb}) {
        VolumeBvhOptions options;
        options.volume = volume;
        f("bvh of volumes", build<VolumeBvh>(set, options));
    }
}

/// Every hit of a ray is a candidate, at a depth that is not beyond that of the hit.
template <class Rays, class T, int D>
std::string missed(const Rays& rays, const std::vector<FamilyCandidate<T>>& found, const Ray<T, D>& ray,
                   const std::vector<Hit<T>>& hits) {
    for (const auto& hit : hits) {
        const auto it =
            std::find_if(found.begin(), found.end(), [&](const auto& c) { return c.element == hit.element; });
        if (it == found.end()) return "misses primitive " + std::to_string(hit.element);
        if (!(static_cast<double>(it->depth) <= rays.depth_of(ray, hit.t) * (1 + 4 * unit_roundoff<T>)))
            return "finds primitive " + std::to_string(hit.element) + " too late";
    }
    return "";
}
/// What is wrong with the candidates of an index; empty if nothing is.
template <class Index, class Rays, class T, int D>
std::string wrong(const Index& index, const Rays& rays, const std::vector<Ray<T, D>>& some,
                  const std::vector<std::vector<Hit<T>>>& hits) {
    std::vector<FamilyCandidate<T>> found;
    candidates(index, rays, found);
    for (std::size_t i = 1; i < found.size(); ++i)
        if (!(found[i - 1].depth <= found[i].depth)) return "has candidates in the wrong order";
    for (std::size_t i = 0; i < some.size(); ++i)
        if (auto fault = missed(rays, found, some[i], hits[i]); !fault.empty()) return fault;
    // Up to a limit: some of these candidates, and among them what rays hit within it.
    if (found.empty()) return "";
    const T limit = found[found.size() / 2].depth;
    std::vector<FamilyCandidate<T>> near;
    candidates(index, rays, near, {.limit = limit});
    for (const auto& c : near)
        if (c.depth > limit || std::find(found.begin(), found.end(), c) == found.end())
            return "has other candidates within a limit";
    for (std::size_t i = 0; i < some.size(); ++i) {
        auto within = hits[i];
        std::erase_if(within, [&](const auto& h) { return rays.depth_of(some[i], h.t) > double(limit); });
        if (auto fault = missed(rays, near, some[i], within); !fault.empty())
            return fault + " within a limit";
    }
    return "";
}

template <class T, int D>
using Corners = typename FrustumRays<T, D>::Corners;

/// A ray of a beam: the combination of its corners by some weights, in double, rounded once. It reaches as
/// far as the beam does.
template <class T, int D>
Ray<T, D> ray_between(const Corners<T, D>& corners, const std::vector<int>& weights) {
    Vec<double, D> origin, direction;
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double w = weights[i];
        const Vec<double, D> d(corners[i].direction);
        origin += Vec<double, D>(corners[i].origin) * w;
        direction += d * (w / max_component(abs(d)));
        sum += w;
    }
    if (sum == 0) return corners[0];
    return {Vec<T, D>(origin / sum), Vec<T, D>(direction)};
}
/// Corners around a direction, from one eye or parallel. False if they are no beam.
template <class T, int D>
bool make_corners(const Vec<T, D>& eye, const Vec<T, D>& towards, const std::vector<Vec<T, D>>& beside,
                  T spread, bool parallel, Corners<T, D>& corners) {
    const T size = max_component(abs(towards));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const T sign = i % 2 == 0 ? T(1) : T(-1);
        const Vec<T, D> aside = beside[D == 3 ? i / 2 : 0] * (spread * sign);
        corners[i] = {eye, towards};
        if (parallel)
            corners[i].origin = eye + aside;
        else
            corners[i].direction = towards + aside * (size > 0 ? size : T(1));
    }
    if (D == 3) std::swap(corners[1], corners[2]);  // around: +a, +b, −a, −b
    try {
        FrustumRays<T, D>{corners};
        return true;
    } catch (const InputError&) {
        return false;
    }
}

template <class P>
class OfEverySet : public testing::Test {};
using Sets = testing::Types<TriangleMesh<float>, TriangleMesh<double>, SphereSet<float, 3>,
                            SphereSet<double, 3>, SegmentSet<float>, SegmentSet<double>>;
TYPED_TEST_SUITE(OfEverySet, Sets);

/// Compares every structure with all hits of some rays, by brute force. Counts the hits.
template <class P, class Rays, class T, int D>
void expect_nothing_missed(const P& set, const Rays& rays, const std::vector<Ray<T, D>>& some,
                           std::size_t& hit) {
    std::vector<std::vector<Hit<T>>> hits(some.size());
    const auto oracle = build<BruteForce>(set);
    for (std::size_t i = 0; i < some.size(); ++i) all_hits(oracle, some[i], hits[i]), hit += hits[i].size();
    for_each_type_and_volume(set, [&](const char* name, const auto& index) {
        if (const auto fault = wrong(index, rays, some, hits); !fault.empty())
            RC_FAIL(std::string(name) + " " + fault);
    });
}

TYPED_TEST(OfEverySet, BeamsMissNothingThatTheirRaysHit) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    std::size_t hit = 0, tried = 0;
    expect_always([&] {
        const AnyCase<TypeParam> one;
        const auto aim = one.ray();
        const auto beside = *gen::container<std::vector<Vec<T, D>>>(2, vectors<T, D>(false)).as("beside");
        const T spread = *gen::element(T(0), T(0x1p-20), T(0x1p-8), T(0x1p-3), T(1)).as("spread");
        const bool parallel = *gen::arbitrary<bool>().as("parallel");
        Corners<T, D> corners;
        const T size = one.wild && parallel ? T(0x1p40) : T(1);
        if (!make_corners(aim.origin, aim.direction, beside, spread * size, parallel, corners)) return;
        ++tried;
        std::vector<Ray<T, D>> rays(corners.begin(), corners.end());
        for (int i = 0; i < 8; ++i)
            rays.push_back(ray_between<T, D>(
                corners,
                *gen::container<std::vector<int>>(corners.size(), gen::inRange(0, 9)).as("weights")));
        expect_nothing_missed(one.set, FrustumRays<T, D>(corners), rays, hit);
    });
    EXPECT_GT(tried, 100u);
    EXPECT_GT(hit, 100u);
}

TYPED_TEST(OfEverySet, ConesMissNothingThatTheirRaysHit) {
    using T = typename TypeParam::Scalar;
    constexpr int D = TypeParam::dimension;
    std::size_t hit = 0;
    expect_always([&] {
        const AnyCase<TypeParam> one;
        const auto axis = one.ray();
        if (!RayProbe<T, D>(axis, {axis.origin, axis.origin}).usable()) return;
        const T radius = *gen::element(T(0), T(0x1p-10), T(1)).as("radius");
        const T slope = *gen::element(T(0), T(0x1p-20), T(0x1p-6), T(1), T(20)).as("slope");
        const ConeRays<T, D> cone(axis, radius, slope);
        // Rays on the rim and within it.
        std::vector<Ray<T, D>> rays{axis};
        for (int i = 0; i < 8; ++i) {
            const auto across = [&](const char* name) {
                const auto v = normalized(Vec<double, D>(*vectors<T, D>(false).as(name)));
                const auto aside = v - cone.axis() * dot(v, cone.axis());
                return length(aside) > 1e-6 ? normalized(aside) : Vec<double, D>();
            };
            Ray<T, D> ray = axis;
            ray.origin = Vec<T, D>(Vec<double, D>(axis.origin) + across("origin") * double(radius));
            const double share = i % 2 == 0 ? 1 : 0.5;
            ray.direction = Vec<T, D>(cone.axis() + across("direction") * (double(slope) * share));
            ray.t_min = 0, ray.t_max = std::numeric_limits<T>::infinity();
            const double scale = double(max_component(abs(axis.direction)));
            if (axis.t_min > 0 || axis.t_max < ray.t_max) {  // the same depths
                ray.t_min = static_cast<T>(double(axis.t_min) * scale * (1 + 0x1p-20) * 2);
                ray.t_max = static_cast<T>(double(axis.t_max) * scale * (1 - 0x1p-20));
                if (!(ray.t_min <= ray.t_max)) continue;
            }
            rays.push_back(ray);
        }
        expect_nothing_missed(one.set, cone, rays, hit);
    });
    EXPECT_GT(hit, 100u);
}

// ---- Pictures: each tile of a picture is a beam

TEST(Beams, TilesOfPicturesMissNothing) {
    for (const char* name : {"teapot:1000", "terrain:2000", "hairball:1000", "cornell-box", "grass:1000"}) {
        SCOPED_TRACE(name);
        const auto spec = parse_scene_spec(std::string("gen:") + name);
        const auto mesh = std::get<TriangleMesh<float>>(generate<float>(spec));
        const auto index = build<WideBvh>(mesh);
        const RayMaker make(camera_for(spec.name).value_or(automatic_camera(index.bounds())), 64, 64);
        std::size_t hit = 0, offered = 0, beams = 0;
        for_each_type(mesh, [&](const char* structure, const auto& other) {
            SCOPED_TRACE(structure);
            std::vector<FamilyCandidate<float>> found;
            for (int y = 0; y < 64; y += 8)
                for (int x = 0; x < 64; x += 8) {
                    Corners<float, 3> corners;
                    const float ends[4][2] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}};
                    for (std::size_t c = 0; c < 4; ++c)
                        corners[c] = make.ray<float>(float(x) + ends[c][0], float(y) + ends[c][1]);
                    const FrustumRays<float, 3> beam(corners);
                    candidates(other, beam, found);
                    offered += found.size(), ++beams;
                    for (int k = 0; k < 64; k += 5) {
                        const int column = x + k % 8, row = y + k / 8;
                        const auto ray = make.ray<float>(float(column) + 0.5f, float(row) + 0.5f);
                        const auto closest = closest_hit(index, ray);
                        if (!closest) continue;
                        ++hit;
                        ASSERT_EQ(missed(beam, found, ray, {closest}), "") << x << ' ' << y;
                    }
                }
        });
        EXPECT_GT(hit, 500u);
        // A 64th of the picture has few of the triangles.
        EXPECT_LT(double(offered), 0.25 * double(beams) * double(mesh.size()));
    }
}

// ---- What is entered, and where

TEST(Families, EnterBoxesAtTheirDepth) {
    const Box3f scene{{-10, -10, -10}, {10, 10, 10}}, ahead{{-1, -1, 4}, {1, 1, 5}};
    const auto corner = [](float x, float y) { return Ray3f{{0, 0, 0}, {x, y, 1}}; };
    const FrustumProbe<float, 3> beam(FrustumRays<float, 3>({corner(-0.5f, -0.5f), corner(0.5f, -0.5f),
                                                             corner(0.5f, 0.5f), corner(-0.5f, 0.5f)}),
                                      scene);
    const ConeProbe<float, 3> cone(ConeRays<float, 3>(Ray3f{{0, 0, 0}, {0, 0, 3}}, 0.25f, 0.5f), scene);
    const auto expect = [&](const auto& probe) {
        float at = -1;
        EXPECT_TRUE(probe.enter(ahead, 100.f, at));
        EXPECT_NEAR(at, 4, 1e-3);
        EXPECT_LE(at, 4);
        EXPECT_FALSE(probe.enter(ahead, 3.9f, at));                             // beyond the limit
        EXPECT_FALSE(probe.enter(Box3f{{-1, -1, -5}, {1, 1, -4}}, 100.f, at));  // behind
        EXPECT_FALSE(probe.enter(Box3f{{3, -1, 4}, {4, 1, 5}}, 100.f, at));     // beside
        EXPECT_TRUE(probe.enter(Box3f{{2.4f, -1, 4}, {4, 1, 5}}, 100.f, at));   // on the side
        EXPECT_FALSE(probe.enter(Sphere<float, 3>{{0, 0, -4}, 1}, 100.f, at));
        EXPECT_TRUE(probe.enter(Sphere<float, 3>{{0, 0, 4}, 1}, 100.f, at));
        EXPECT_FALSE(probe.enter(Box3f(), 100.f, at));  // empty
        // Cuts: ahead of a plane, across it, and past it.
        const auto ends = probe.root(scene);
        const auto cut = probe.cut(ends, AxisPlane<float>{2, 4}, 100.f);
        EXPECT_TRUE(!cut.near_is_high && cut.to_near && cut.to_far);
        EXPECT_NEAR(cut.near.exit, 4, 1e-3);
        EXPECT_NEAR(cut.far.entry, 4, 1e-3);
        EXPECT_FALSE(probe.cut(ends, AxisPlane<float>{2, 4}, 3.f).to_far);
        const auto beside = probe.cut(cut.near, AxisPlane<float>{0, 3}, 100.f);
        EXPECT_NE(beside.near_is_high ? beside.to_near : beside.to_far, true);
        const auto slanted = probe.cut(ends, CutPlane<3>{{0, 1, 2}, 8, 0}, 100.f);
        EXPECT_TRUE(!slanted.near_is_high && slanted.to_near && slanted.to_far);
        EXPECT_GT(slanted.far.entry, 3);
        EXPECT_LT(slanted.far.entry, 4);
    };
    expect(beam), expect(cone);
    // A face excludes what lies beside an edge of the frustum, which no axis tells.
    const FrustumProbe<float, 3> slanted(
        FrustumRays<float, 3>({Ray3f{{0, 0, 0}, {1, 0, 0.1f}}, Ray3f{{0, 0, 0}, {1, 0, -0.1f}},
                               Ray3f{{0, 0, 0}, {0, 1, -0.1f}}, Ray3f{{0, 0, 0}, {0, 1, 0.1f}}}),
        scene);
    float at;
    EXPECT_FALSE(slanted.enter(Box3f{{5, -1, -1}, {6, -0.5f, 1}}, 100.f, at));
    EXPECT_TRUE(slanted.enter(Box3f{{5, -1, -1}, {6, 0.5f, 1}}, 100.f, at));
}

TEST(Families, RefuseWhatIsNoBeam) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Ray3f corners[4] = {
        {{0, 0, 0}, {1, 0, 5}}, {{0, 0, 0}, {0, 1, 5}}, {{0, 0, 0}, {-1, 0, 5}}, {{0, 0, 0}, {0, -1, 5}}};
    const auto beam = [&] { return FrustumRays<float, 3>({corners[0], corners[1], corners[2], corners[3]}); };
    EXPECT_NO_THROW(beam());
    corners[2].direction = {0, 0, 0};
    EXPECT_THROW(beam(), InputError);
    corners[2].direction = {0, 0, -1};
    EXPECT_THROW(beam(), InputError);
    corners[2] = {{nan, 0, 0}, {0, 0, 1}};
    EXPECT_THROW(beam(), InputError);
    const Ray3f axis{{0, 0, 0}, {1, 0, 5}};
    EXPECT_THROW((ConeRays<float, 3>(axis, -1, 0)), InputError);
    EXPECT_THROW((ConeRays<float, 3>(axis, 1, nan)), InputError);
    EXPECT_THROW((ConeRays<float, 3>(corners[2], 1, 0)), InputError);
    // Nothing is found in nothing.
    std::vector<FamilyCandidate<float>> found(1);
    EXPECT_EQ(candidates(build<KdTree>(TriangleMesh<float>()), ConeRays<float, 3>(axis, 1, 1), found), 0u);
    EXPECT_TRUE(found.empty());
}

TEST(Families, PointsInACone) {
    PointCloud<float, 3> cloud;
    Random random(5, 0);
    for (int i = 0; i < 2000; ++i) cloud.points.push_back(Vec3f(random.in_cube<3>()));
    for_each_type(cloud, [&](const char* name, const auto& index) {
        const auto box = index.bounds();
        const Ray<float, 3> axis{box.low, box.high - box.low};
        const ConeRays<float, 3> cone(axis, 0, 0.2f);
        std::vector<FamilyCandidate<float>> found;
        candidates(index, cone, found);
        std::size_t inside = 0;
        for (std::size_t i = 0; i < cloud.points.size(); ++i) {
            const Vec3d v(cloud.points[i] - axis.origin);
            const double h = dot(v, cone.axis());
            if (length(cross(v, cone.axis())) > 0.2 * h) continue;
            ++inside;
            ASSERT_TRUE(std::any_of(found.begin(), found.end(), [&](const auto& c) {
                return c.element == i;
            })) << name;
        }
        EXPECT_GT(inside, 10u);
        EXPECT_LT(found.size(), 3 * inside) << name;
    });
}

// ---- What a cone sees

TEST(ConeSamples, AreANetOfTheSquareAndEvenInTheDisc) {
    for (int a = 0; a <= 6; ++a) {
        std::vector<int> boxes(64);
        for (int i = 0; i < 64; ++i) {
            const Vec2d p = ConeSamples::in_square(i);
            const int column = int(p[0] * (1 << a)), row = int(p[1] * (1 << (6 - a)));
            ++boxes[std::size_t(row << a | column)];
        }
        EXPECT_EQ(std::count(boxes.begin(), boxes.end(), 1), 64) << a;
    }
    const auto& samples = ConeSamples::all();
    double x = 0, y = 0, square = 0;
    for (std::size_t i = 0; i < 64; ++i) {
        const double r2 = samples.x[i] * samples.x[i] + samples.y[i] * samples.y[i];
        EXPECT_LE(r2, 1);
        x += samples.x[i] / 64, y += samples.y[i] / 64, square += r2 / 64;
    }
    EXPECT_NEAR(x, 0, 0.01);
    EXPECT_NEAR(y, 0, 0.01);
    EXPECT_NEAR(square, 0.5, 0.02);  // of a disc
}

/// The ray of a sample of a cone.
Ray3d ray_of_sample(const ConeRays<double, 3>& cone, std::size_t i) {
    Vec3d beside;
    beside[std::abs(cone.axis()[0]) < 0.5 ? 0 : 1] = 1;
    const Vec3d first = normalized(cross(cone.axis(), beside)), second = cross(cone.axis(), first);
    const auto& samples = ConeSamples::all();
    const Vec3d w = first * samples.x[i] + second * samples.y[i];
    return {cone.origin() + w * cone.radius(), cone.axis() + w * cone.slope()};
}

TEST(ConeFragments, AreWhatTheRaysOfTheSamplesHitByEveryStructure) {
    for (const char* name : {"gen:soup:300", "gen:teapot:500", "gen:cornell-box", "gen:hairball:600"}) {
        SCOPED_TRACE(name);
        const auto mesh = std::get<TriangleMesh<double>>(generate<double>(parse_scene_spec(name)));
        const auto oracle = build<BruteForce>(mesh);
        std::vector<std::vector<ConeFragment<double>>> want;
        std::vector<ConeRays<double, 3>> cones;
        std::size_t differ = 0, hit = 0, several = 0;
        for (std::uint64_t i = 0; i < 60; ++i) {
            Random random(12, i);
            const auto box = oracle.bounds();
            const Vec3d size = box.extent(), from = box.center() + random.direction<3>() * length(size);
            Vec3d to = box.center();
            for (int k = 0; k < 3; ++k) to[k] += size[k] * (random.uniform() - 0.5) * 0.8;
            const double radius = i % 3 == 0 ? 0.01 * length(size) : 0;
            cones.emplace_back(Ray3d{from, to - from}, radius, i % 2 == 0 ? 0.02 : 0.2);
            want.emplace_back();
            cone_fragments(oracle, cones.back(), want.back());
            several += want.back().size() > 1;
            std::uint64_t all = 0;
            for (const auto& f : want.back()) {
                EXPECT_EQ(all & f.samples, 0u);  // a sample belongs to one
                all |= f.samples;
            }
            for (std::size_t s = 0; s < ConeSamples::count; ++s) {
                const auto closest = closest_hit(oracle, ray_of_sample(cones.back(), s));
                const auto here = std::find_if(want.back().begin(), want.back().end(),
                                               [&](const auto& f) { return (f.samples >> s & 1) != 0; });
                const bool seen = here != want.back().end();
                hit += bool(closest);
                differ += seen != bool(closest) || (seen && here->element != closest.element);
                if (seen && closest) {
                    EXPECT_LE(here->depth, closest.t * (1 + 1e-9));
                }
            }
        }
        EXPECT_GT(hit, 500u);
        EXPECT_GT(several, 10u);
        EXPECT_LE(differ, hit / 1000);
        for_each_type(mesh, [&](const char* structure, const auto& index) {
            for (std::size_t i = 0; i < cones.size(); ++i) {
                std::vector<ConeFragment<double>> found;
                cone_fragments(index, cones[i], found);
                ASSERT_EQ(found, want[i]) << structure << ", cone " << i;
            }
        });
    }
}

/// Half of a cone is covered by what lies beyond an edge through its axis, wherever the edge turns; and an
/// edge beside the axis covers the part of the disc beyond it.
TEST(ConeFragments, CoverAsMuchAsAnEdgeLeaves) {
    double error = 0, most = 0;
    constexpr int edges = 500;
    for (int i = 0; i < edges; ++i) {
        Random random(13, std::uint64_t(i));
        const double angle = random.uniform(0, 2 * 3.14159265358979323846), at = random.uniform(-1, 1);
        const Vec3d along(std::cos(angle), std::sin(angle), 0), away(-along[1], along[0], 0);
        const Vec3d p = away * (at * 0.1) + Vec3d(0, 0, 1);  // the cone's radius is 0.1 there
        const TriangleMesh<double> mesh{
            {p - along * 10.0, p + along * 10.0, p + away * 50.0}, {{0, 1, 2}}, {}};
        std::vector<ConeFragment<double>> found;
        cone_fragments(build<WideBvh>(mesh), ConeRays<double, 3>(Ray3d{{}, {0, 0, 2}}, 0, 0.1), found);
        const double share = (std::acos(at) - at * std::sqrt(1 - at * at)) / 3.14159265358979323846;
        const double got = found.empty() ? 0 : found[0].coverage();
        error += std::abs(got - share) / edges, most = std::max(most, std::abs(got - share));
    }
    EXPECT_LT(error, 0.02);
    EXPECT_LT(most, 0.08);
}

TEST(ConeFragments, EndWhereAllSamplesAreTaken) {
    // A wall in front of a thousand triangles.
    TriangleMesh<float> mesh{{{-9, -9, 1}, {9, -9, 1}, {0, 30, 1}}, {{0, 1, 2}}, {}};
    for (std::uint32_t i = 1; i < 1000; ++i) {
        const float z = 2 + 0.01f * float(i);
        for (const Vec3f& v : {Vec3f(-9, -9, z), Vec3f(9, -9, z), Vec3f(0, 30, z)})
            mesh.vertices.push_back(v);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const ConeRays<float, 3> cone(Ray3f{{0, 0, 0}, {0, 0, 1}}, 0, 0.1f);
    const auto index = build<Bvh>(mesh);
    std::vector<FamilyCandidate<float>> all;
    std::vector<ConeFragment<float>> found;
    Visits visits;
    EXPECT_EQ(candidates(index, cone, all), 1000u);
    EXPECT_EQ(cone_fragments(index, cone, found, visits), 1u);
    EXPECT_EQ(found[0].samples, ~std::uint64_t(0));
    EXPECT_EQ(found[0].element, 0u);
    EXPECT_LT(visits.primitives, 20u);
}

}  // namespace
