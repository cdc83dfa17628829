/// What surfaces do to light, against closed forms and quadratures: energy, textbooks, and the parts that
/// scattering is made of.
#include <gtest/gtest.h>

#include <map>

#include <hedgerow/render/scattering/frame.h>

#include "scattering_support.h"

namespace hedgerow {
namespace {

using namespace scatterings;

constexpr double furnace_cosines[] = {1.0, 0.8, 0.5, 0.2, 0.05};

TEST(Furnace, WhiteSurfacesReflectAllLight) {
    const Vec3f white = Vec3f::all(1);
    for (const double cosine : furnace_cosines) {
        const auto sum = [&](const SurfaceMaterial& m, bool inside = false) {
            const Surface s{"", m, inside, true};
            const double quick = albedo(s, direction(cosine), 2048)[0];
            return std::abs(quick - 1) < 0.008 ? quick : albedo(s, direction(cosine), 1 << 16)[0];
        };
        EXPECT_NEAR(sum(matte(white)), 1, 0.001);
        EXPECT_NEAR(sum(metal(0, white)), 1, 0.001);
        EXPECT_NEAR(sum(coated(0, white)), 1, 0.001);
        EXPECT_NEAR(sum(thin(0, white)), 1, 0.001);
        for (const bool inside : {false, true}) EXPECT_NEAR(sum(glass(0), inside), 1, 0.001);
        for (const float r : {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 1.0f}) {
            EXPECT_NEAR(sum(metal(r, white)), 1, 0.01) << r << ' ' << cosine;
            EXPECT_NEAR(sum(coated(r, white)), 1, 0.01) << r << ' ' << cosine;
            EXPECT_NEAR(sum(thin(r, white)), 1, 0.01) << r << ' ' << cosine;
            for (const float ior : {1.2f, 1.5f, 2.4f})
                for (const bool inside : {false, true})
                    EXPECT_NEAR(sum(glass(r, ior), inside), 1, 0.01)
                        << r << ' ' << cosine << ' ' << ior << inside;
        }
    }
}

/// Light within a body of glass meets its surface several times, so what the tables leave out adds up. The
/// mean over directions, between the rows of the tables, too.
TEST(Furnace, TablesOfGlassAreRightInTheMean) {
    for (const float ior : {1.33f, 1.5f, 2.0f})
        for (const bool inside : {false, true})
            for (float r = 0.2f; r < 1; r += 0.04f) {
                const float eta = inside ? 1 / ior : ior;
                constexpr int steps = 24, turns = 32, heights = 64;
                double error = 0;
                for (int k = 0; k < steps; ++k) {
                    const double x = (k + 0.5) / steps, share = 4 * x * x * x / steps;
                    const auto cosine = static_cast<float>(x * x);
                    const double exact = VisibleMirrors(r, cosine, turns, heights).glass(eta);
                    error += share * (static_cast<double>(tables().glass(r, cosine, eta)) - exact);
                }
                EXPECT_NEAR(error, 0, 0.0012) << ior << ' ' << inside << ' ' << r;
            }
}

/// What is reflected once, by an independent quadrature of the formula in double: the average over
/// directions, and at normal incidence for the greatest roughness.
TEST(Furnace, OneReflectionLosesWhatQuadratureSays) {
    const auto average = [](float roughness) {
        constexpr int steps = 40;
        double sum = 0;
        for (int k = 0; k < steps; ++k) {
            const double cosine = (k + 0.5) / steps;
            const Surface s{"", metal(roughness, Vec3f::all(1)), false, false};
            sum += 2 * cosine * albedo(s, direction(cosine), 2048)[0] / steps;
        }
        return sum;
    };
    for (const auto& [roughness, expected] :
         std::map<float, double>{{0.2f, 0.994}, {0.4f, 0.940}, {0.6f, 0.803}, {0.8f, 0.604}, {1.0f, 0.409}}) {
        EXPECT_NEAR(average(roughness), expected, 0.0015);
        EXPECT_NEAR(tables().ggx_average(roughness).white, expected, 0.0015);
    }
    EXPECT_NEAR(tables().ggx(1.0f, 1.0f).white, 0.307, 0.001);
}

TEST(Furnace, NoMaterialGivesMoreLightThanItGets) {
    double most = 0;
    const auto look = [&](const SurfaceMaterial& m, bool inside, bool compensated) {
        for (const double cosine : {1.0, 0.5, 0.1, 0.01}) {
            const Surface s{"", m, inside, compensated};
            Vec3d sum = albedo(s, direction(cosine), 512);
            if (max_component(sum) > 1.004) sum = albedo(s, direction(cosine), 1 << 14);
            most = std::max(most, max_component(sum));
            EXPECT_LT(max_component(sum), 1.01)
                << m.metallic << ' ' << m.roughness << ' ' << m.transmission << ' ' << m.specular << ' '
                << m.ior << ' ' << m.thin << inside << compensated << ' ' << cosine;
        }
    };
    SurfaceMaterial m = matte(Vec3f::all(1));
    m.specular_colour = {1, 4, 0.2f};
    for (const float metallic : {0.0f, 0.4f, 1.0f})
        for (const float roughness : {0.0f, 0.15f, 0.4f, 0.7f, 1.0f})
            for (const float transmission : {0.0f, 0.5f, 1.0f})
                for (const float specular : {0.0f, 1.0f})
                    for (const float ior : {1.0f, 1.5f, 2.5f})
                        for (const int kind : {0, 1, 2, 3, 4, 5}) {
                            m.metallic = metallic, m.roughness = roughness, m.transmission = transmission;
                            m.specular = specular, m.ior = ior, m.thin = kind / 2 == 0;
                            look(m, kind / 2 == 2, kind % 2 == 0);
                        }
    EXPECT_GT(most, 0.99);
}

/// Appendix B of glTF 2.0 and Walter et al., as they stand there, in double.
struct Textbook {
    double alpha;
    static double heaviside(double x) { return x > 0 ? 1 : 0; }
    double distribution(const Vec3d& h) const {
        const double a2 = alpha * alpha, f = h[2] * h[2] * (a2 - 1) + 1;
        return a2 * heaviside(h[2]) / (std::numbers::pi * f * f);
    }
    double lambda(double mu) const { return (std::sqrt(1 + alpha * alpha * (1 / (mu * mu) - 1)) - 1) / 2; }
    double shadowing(double o, double i) const { return 1 / (1 + lambda(o) + lambda(i)); }
};

TEST(Values, ReflectionIsThatOfTheTextbook) {
    const Surface s{"", metal(0.6f, {0.9f, 0.5f, 0.1f}), false, false};
    const Textbook textbook{0.36f};
    for (int k = 0; k < 200; ++k) {
        const auto [a, b, c] = even_point(k);
        const Vec3f o = direction(0.05 + 0.95 * static_cast<double>(a)), i = cosine_direction(b, c);
        const Vec3d od(o), id(i), h = normalized(od + id);
        const double f0 = 0.5, fresnel = f0 + (1 - f0) * std::pow(1 - dot(od, h), 5);
        const double expected =
            fresnel * textbook.distribution(h) * textbook.shadowing(od[2], id[2]) / (4 * od[2]);
        EXPECT_NEAR(s.at(o).value(i)[1], expected, 1e-5 * (1 + expected));
    }
}

TEST(Values, RefractionIsThatOfTheTextbook) {
    const Textbook textbook{0.25f};
    for (const bool inside : {false, true}) {
        const Surface s{"", glass(0.5f), inside, false};
        const double n_o = inside ? 1.5 : 1, n_i = inside ? 1 : 1.5;
        int lit = 0;
        for (int k = 0; k < 200; ++k) {
            const auto [a, b, c] = even_point(k);
            const Vec3f o = direction(0.05 + 0.95 * static_cast<double>(a)), i = -cosine_direction(b, c);
            const Vec3d od(o), id(i);
            Vec3d h = normalized(od * n_o + id * n_i);
            if (h[2] < 0) h = -h;
            const double oh = dot(od, h), ih = dot(id, h), root = 1 - (1 - oh * oh) * n_o * n_o / (n_i * n_i);
            double expected = 0;
            if (oh > 0 && ih < 0 && root > 0) {
                const double ct = std::sqrt(root), across = (n_o * oh - n_i * ct) / (n_o * oh + n_i * ct),
                             along = (n_i * oh - n_o * ct) / (n_i * oh + n_o * ct);
                const double fresnel = (across * across + along * along) / 2, sum = n_i * ih + n_o * oh;
                // Walter et al. have the index of the side that energy goes to. Radiance takes the other one.
                expected = oh * -ih / od[2] * n_o * n_o * (1 - fresnel) * textbook.distribution(h) *
                           textbook.shadowing(od[2], -id[2]) / (sum * sum);
            }
            EXPECT_NEAR(s.at(o).value(i)[1], expected, 1e-4 * (1 + expected)) << inside << ' ' << k;
            lit += expected > 1e-3;
        }
        EXPECT_GT(lit, 40);
    }
}

TEST(Values, CoatOfNoStrengthIsMatte) {
    const Scattering s(matte({0.5f, 0.25f, 1}), direction(0.3), false, &tables());
    EXPECT_NEAR(s.value({0, 0, 1})[1], 0.25 / std::numbers::pi, 1e-6);
    EXPECT_EQ(s.value({0, 0, -1}), Vec3f());
    EXPECT_FALSE(s.only_specular());
}

TEST(Values, TablesChangeNothingWithoutRoughFacets) {
    for (const SurfaceMaterial& m :
         {matte({0.9f, 0.6f, 0.2f}), metal(0), coated(0), glass(0), thin(0), mixed(0)})
        for (int k = 0; k < 200; ++k) {
            const auto [choice, u, v] = even_point(k);
            const Vec3f o = cosine_direction(v, choice), i = sphere_direction(u, choice);
            const Scattering with(m, o, k % 2 == 0, &tables()), without(m, o, k % 2 == 0, nullptr);
            EXPECT_EQ(with.value(i), without.value(i));
            EXPECT_EQ(with.density(i), without.density(i));
            const auto to = with.sample(choice, u, v), other = without.sample(choice, u, v);
            ASSERT_EQ(to.exists, other.exists);
            EXPECT_TRUE(!to || (to.direction == other.direction && to.weight == other.weight));
        }
}

TEST(Values, SmoothGlassRefractsBySnell) {
    for (const bool inside : {false, true}) {
        const Vec3f o = direction(0.9, 0);
        const Scattering s(glass(0), o, inside, &tables());
        EXPECT_TRUE(s.only_specular());
        const auto to = s.sample(0.999f, 0.3f, 0.3f);
        ASSERT_TRUE(to && to.specular && to.transmitted);
        const float eta = inside ? 1 / 1.5f : 1.5f;
        EXPECT_NEAR(to.direction[0], -o[0] / eta, 1e-6);
        EXPECT_NEAR(to.weight[0], 1 / (eta * eta), 1e-6) << "radiance is greater in the denser body";
        EXPECT_EQ(s.value(to.direction), Vec3f());
    }
    const Scattering straight(thin(0), direction(0.9), false, &tables());
    EXPECT_EQ(straight.sample(0.999f, 0.3f, 0.3f).direction, -direction(0.9));
}

/// The mean of f over the unit square, by midpoints.
template <class F>
double mean_of_square(F f) {
    constexpr int n = 256;
    double sum = 0;
    for (int k = 0; k < n * n; ++k) {
        const int row = k / n, column = k % n;
        sum += static_cast<double>(
            f((static_cast<float>(row) + 0.5f) / n, (static_cast<float>(column) + 0.5f) / n));
    }
    return sum / (n * n);
}

/// The means of x, x², xy, z and z² say where points lie.
TEST(Warps, HaveTheMomentsOfTheirDensities) {
    const auto expect = [](auto warp, std::array<double, 5> moments, const char* name) {
        const auto moment = [&](auto f) {
            return mean_of_square([&](float u, float v) { return f(warp(u, v)); });
        };
        EXPECT_NEAR(moment([](const Vec3f& p) { return p[0]; }), moments[0], 1e-4) << name;
        EXPECT_NEAR(moment([](const Vec3f& p) { return p[0] * p[0]; }), moments[1], 1e-4) << name;
        EXPECT_NEAR(moment([](const Vec3f& p) { return p[0] * p[1]; }), moments[2], 1e-4) << name;
        EXPECT_NEAR(moment([](const Vec3f& p) { return p[2]; }), moments[3], 2e-4) << name;
        EXPECT_NEAR(moment([](const Vec3f& p) { return p[2] * p[2]; }), moments[4], 1e-4) << name;
    };
    const auto flat = [](const Vec2f& p) { return Vec3f(p[0], p[1], 0); };
    const double third = 1.0 / 3;
    expect([&](float u, float v) { return flat(disc_point(u, v)); }, {0, 0.25, 0, 0, 0}, "disc");
    expect(cosine_direction<float>, {0, 0.25, 0, 2 * third, 0.5}, "cosine");
    expect(hemisphere_direction<float>, {0, third, 0, 0.5, third}, "hemisphere");
    expect(sphere_direction, {0, third, 0, 0, third}, "sphere");
    expect([&](float u, float v) { return flat(triangle_point(u, v)); }, {third, 1.0 / 6, 1.0 / 12, 0, 0},
           "triangle");
    // z is even in 0.6..1, so that z² has the mean (1 − 0.6³)/(3·0.4).
    const double z2 = (1 - 0.216) / 1.2;
    expect([](float u, float v) { return cone_direction(0.4f, u, v); }, {0, (1 - z2) / 2, 0, 0.8, z2},
           "cone");
    EXPECT_NEAR(cone_direction_density(0.4f), 1 / (2 * std::numbers::pi * 0.4), 1e-6);
    EXPECT_NEAR(sphere_direction_density, 1 / (4 * std::numbers::pi), 1e-7);
    EXPECT_NEAR(cosine_direction_density(0.5f), 0.5 / std::numbers::pi, 1e-7);
    EXPECT_NEAR(length(cone_direction(1e-9f, 0.3f, 0.7f)), 1, 1e-6);
    EXPECT_GT(cone_direction(1e-9f, 0, 0.7f)[0], 3e-5f) << "small cones keep their width";
}

TEST(Frames, AreOrthonormal) {
    for (int k = 0; k < 1000; ++k) {
        const auto [u, v, w] = even_point(k);
        Vec3f n = sphere_direction(u, v);
        if (k < 2) n = {0, 0, k == 0 ? 1.0f : -1.0f};
        const Frame frame(n);
        const Vec3f d = sphere_direction(w, u), local = frame.to_local(d);
        EXPECT_NEAR(local[2], dot(n, d), 1e-6);
        EXPECT_NEAR(length(local), 1, 1e-6);
        EXPECT_LT(length(frame.to_world(local) - d), 1e-6f);
        EXPECT_GT(dot(cross(frame.to_world({1, 0, 0}), frame.to_world({0, 1, 0})), n), 0.999f);
    }
}

TEST(Frames, UsableNormalsReflectAboveTheSurface) {
    int kept = 0, turned = 0;
    for (int k = 0; k < 20000; ++k) {
        const auto [u, v, w] = even_point(k);
        const Frame surface(sphere_direction(w, u));
        const Vec3f g = surface.normal(), o = surface.to_world(cosine_direction(u, v)),
                    shading = sphere_direction(v, w);
        const Vec3f n = usable_normal(shading, g, o);
        const float height = dot(g, o), least = std::min(0.9f * height, 0.01f);
        EXPECT_NEAR(length(n), 1, 1e-5);
        EXPECT_GE(dot(n, o), height / 2 - 1e-5f);
        EXPECT_GE(dot(reflected(o, n), g), least - 1e-5f);
        const bool usable = dot(shading, g) > 0 && dot(reflected(o, shading), g) > least + 1e-5f;
        EXPECT_TRUE(!usable || n == shading);
        if (n != shading && n != g) {
            // The normal is turned no further than needed, and in the plane of both.
            EXPECT_NEAR(dot(reflected(o, n), g), least, 1e-4);
            EXPECT_NEAR(dot(n, normalized(cross(g, shading))), 0, 1e-4);
            ++turned;
        }
        kept += n == shading;
    }
    EXPECT_GT(kept, 3000);
    EXPECT_GT(turned, 3000);
    EXPECT_EQ(usable_normal({0, 0, -1}, {0, 0, 1}, {0.6f, 0, 0.8f}), Vec3f(0, 0, 1));
    EXPECT_EQ(usable_normal({0, 1, 0}, {0, 0, 1}, {0, 0.6f, -0.8f}), Vec3f(0, 0, 1));
}

TEST(Fresnel, IsKnownAtSomeAngles) {
    EXPECT_NEAR(dielectric_reflectance(1.0f, 1.5f), 0.04, 1e-7);
    EXPECT_NEAR(dielectric_reflectance(1.0f, 1 / 1.5f), 0.04, 1e-7);
    EXPECT_EQ(dielectric_reflectance(0.0f, 1.5f), 1);
    EXPECT_EQ(dielectric_reflectance(0.0f, 1), 1);
    EXPECT_EQ(dielectric_reflectance(0.5f, 1), 0);
    EXPECT_EQ(dielectric_reflectance(0.5f, 1 / 1.5f), 1) << "total reflection";
    // At Brewster's angle, tan θ = η, all reflected light is polarised: half of ((η² − 1)/(η² + 1))².
    EXPECT_NEAR(dielectric_reflectance(1 / std::sqrt(3.25f), 1.5f), (1.25 / 3.25) * (1.25 / 3.25) / 2, 1e-6);
    const Vec3f o = direction(0.4), below = refracted(o, {0, 0, 1}, 1.5f);
    EXPECT_NEAR(dielectric_reflectance(0.4f, 1.5f), dielectric_reflectance(-below[2], 1 / 1.5f), 1e-6);
    EXPECT_NEAR(1 - tables().refracted_average(1.5f), 0.0918, 2e-4)
        << "known from the theory of diffuse light";
    EXPECT_NEAR(1 - tables().refracted_average(1 / 1.5f), 0.5963, 2e-4);
    EXPECT_NEAR((SchlickFresnel{Vec3f::all(0.04f), 1}.average()[0]), 0.04 + 0.96 / 21, 1e-6);
}

TEST(GgxDistribution, CoversTheSurfaceAndWhatIsSeen) {
    for (const float alpha : {0.1f, 0.4f, 1.0f}) {
        const Ggx ggx(alpha);
        const Vec3f o = direction(0.3);
        // Even areas of the projected disc have even shares of the integral of the cosine.
        const double area = mean_of_square([&](float u, float v) {
            return std::numbers::pi_v<float> * ggx.distribution(cosine_direction(u, v));
        });
        EXPECT_NEAR(area, 1, 0.002);
        const double seen = mean_of_square([&](float u, float v) {
            // The height 1 − v² puts more places close to the normal, in proportion to 1/(2v).
            const Vec3f h = hemisphere_direction(u, 1 - v * v);
            const float per_normal = 4 * std::max(dot(o, h), 0.0f) * ggx.reflected_density(o, h);
            return 2 * v * per_normal / hemisphere_direction_density;
        });
        EXPECT_NEAR(seen, 1, 0.002);
        EXPECT_NEAR(ggx.lambda(0.3f), Textbook{static_cast<double>(alpha)}.lambda(0.3), 1e-5);
        const float g2 = 1 / (1 + ggx.lambda(0.3f) + ggx.lambda(0.6f));
        EXPECT_NEAR(ggx.visibility(0.3f, 0.6f) * 4 * 0.3f * 0.6f, g2, 1e-6);
        EXPECT_NEAR(ggx.unshadowed(0.3f, 0.6f), g2 * (1 + ggx.lambda(0.3f)), 1e-6);
    }
}

}  // namespace
}  // namespace hedgerow
