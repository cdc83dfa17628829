/// Looks of generated scenes: which triangles have which material, and the Cornell box's measured colours.
#include <hedgerow/scenes/looks.h>

#include <array>
#include <cmath>

#include "model_support.h"

namespace hedgerow {
namespace {

using testing_io::expect_sound;

TEST(SceneLooks, AreOfTheMeshThatIsGenerated) {
    int meshes = 0;
    for (const SceneInfo& info : scene_list()) {
        SCOPED_TRACE(info.name);
        const SceneSpec spec{std::string(info.name), 3000, 5};
        const Scene<float> scene = generate<float>(spec);
        const auto* const mesh = std::get_if<TriangleMesh<float>>(&scene);
        if (mesh == nullptr) {
            EXPECT_THROW(generate_model<float>(spec), UsageError);
            continue;
        }
        ++meshes;
        const auto model = generate_model<float>(spec);
        expect_sound(model);
        ASSERT_EQ(model.objects.size(), 1u);
        EXPECT_EQ(model.objects[0].mesh.vertices, mesh->vertices);
        EXPECT_EQ(model.objects[0].mesh.triangles, mesh->triangles);
        EXPECT_EQ(model.triangles(), mesh->size());
        EXPECT_EQ(model.materials.size() > 1, !model.objects[0].materials.empty());
    }
    EXPECT_GT(meshes, 9);
    EXPECT_THROW(generate_model<double>({"no-such-scene", {}, 0}), UsageError);
}

template <class T>
std::string name_of(const Model<T>& model, std::size_t triangle) {
    return model.materials[model.objects[0].material_of(triangle)].name;
}

TEST(SceneLooks, TheCornellBoxHasItsWalls) {
    for (const std::uint64_t size : {1u, 32u, 100u, 777u, 5000u}) {
        const auto model = generate_model<double>({"cornell-box", size, 0});
        const auto& mesh = model.objects[0].mesh;
        int lamps = 0;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const auto t = mesh.view().triangle(i);
            const auto all = [&](auto f) { return f(t.a) && f(t.b) && f(t.c); };
            // Left and right are seen from the open side: the left wall is at large x, and not quite upright.
            const bool right = all([](const Vec3d& p) { return p[0] == 0; });
            const bool left = all([](const Vec3d& p) { return p[0] > 549; });
            const bool lamp = all([](const Vec3d& p) { return std::abs(p[1] - 548.7) < 1e-9; });
            EXPECT_EQ(name_of(model, i), lamp ? "light" : right ? "green" : left ? "red" : "white") << i;
            lamps += lamp;
        }
        EXPECT_GT(lamps, 1);
    }
    const auto model = generate_model<float>({"cornell-box", {}, 0});
    int lit = 0;
    for (const Material& m : model.materials) lit += max_component(m.emission) > 0;
    EXPECT_EQ(lit, 1) << "the lamp alone shines";
}

TEST(SceneLooks, PartsOfOtherScenes) {
    // The ground comes first, and blades have vertices of their own.
    const auto grass = generate_model<float>({"grass", 4000, 3});
    std::uint32_t most_ground = 0, least_blade = 0xFFFFFFFFu;
    std::size_t blades = 0;
    for (std::size_t i = 0; i < grass.objects[0].mesh.size(); ++i)
        for (const std::uint32_t v : grass.objects[0].mesh.triangles[i])
            if (name_of(grass, i) == "earth")
                most_ground = std::max(most_ground, v);
            else
                least_blade = std::min(least_blade, v), ++blades;
    EXPECT_EQ(most_ground + 1, least_blade);
    EXPECT_EQ(blades % 9, 0u) << "three corners of three triangles a blade";
    EXPECT_GT(blades, 3 * 3000u);
    // The teapot is on the field.
    const auto stadium = generate_model<float>({"teapot-in-stadium", 9000, 0});
    std::size_t glazed = 0;
    for (std::size_t i = 0; i < stadium.objects[0].mesh.size(); ++i) {
        const auto box = stadium.objects[0].mesh.view().bounds(i);
        const bool near = box.low[0] > -4 && box.high[0] < 4 && box.low[2] > 0 && box.high[2] < 4;
        EXPECT_EQ(name_of(stadium, i) == "glaze", near) << i;
        glazed += near;
    }
    EXPECT_GT(glazed, 500u);
    const auto soup = generate_model<float>({"soup", 100, 0});
    EXPECT_EQ(soup.materials.size(), 6u);
    EXPECT_NE(name_of(soup, 0), name_of(soup, 1));
    EXPECT_EQ(name_of(soup, 5), name_of(soup, 11));
}

// "Cornell Box Data", Cornell University Program of Computer Graphics, 1998: reflectances from 400 to 700 nm,
// every 4 nm, and the light at every 100 nm.
using Spectrum = std::array<double, 76>;
constexpr Spectrum white_paint = {0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.71,  0.745,
                                  0.758, 0.739, 0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757,
                                  0.753, 0.75,  0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733,
                                  0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.74,
                                  0.754, 0.764, 0.752, 0.736, 0.734, 0.741, 0.74,  0.732, 0.745, 0.755, 0.751,
                                  0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.73,  0.727, 0.707,
                                  0.703, 0.729, 0.75,  0.76,  0.751, 0.739, 0.724, 0.73,  0.74,  0.737};
constexpr Spectrum green_paint = {0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097,
                                  0.098, 0.096, 0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.14,
                                  0.16,  0.187, 0.229, 0.285, 0.343, 0.39,  0.435, 0.464, 0.472, 0.476, 0.481,
                                  0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277,
                                  0.266, 0.25,  0.23,  0.207, 0.186, 0.171, 0.16,  0.148, 0.141, 0.136, 0.13,
                                  0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118, 0.12,
                                  0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.15,  0.152, 0.157, 0.159};
constexpr Spectrum red_paint = {0.04,  0.046, 0.048, 0.053, 0.049, 0.05,  0.053, 0.055, 0.057, 0.056, 0.059,
                                0.057, 0.061, 0.061, 0.06,  0.062, 0.062, 0.062, 0.061, 0.062, 0.06,  0.059,
                                0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059,
                                0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.08,
                                0.09,  0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487,
                                0.513, 0.558, 0.584, 0.62,  0.606, 0.609, 0.651, 0.612, 0.61,  0.65,  0.638,
                                0.627, 0.62,  0.63,  0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642};
constexpr std::array<double, 4> lamp = {0, 8, 15.6, 18.4};
/// CIE D65, from 400 to 700 nm every 20 nm.
constexpr std::array<double, 16> d65 = {82.75, 93.43, 104.86, 117.81, 115.92, 109.35, 104.79, 104.41,
                                        100,   95.79, 90.01,  87.70,  83.70,  80.21,  78.28,  71.61};

template <std::size_t N>
double at(const std::array<double, N>& values, double wavelength) {
    const double place = (wavelength - 400) / 300 * (N - 1);
    const auto i = std::min(static_cast<std::size_t>(place), N - 2);
    return values[i] + (values[i + 1] - values[i]) * (place - static_cast<double>(i));
}

/// The CIE 1931 observer by the lobes of Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE
/// XYZ Color Matching Functions", JCGT 2(2), 2013.
std::array<double, 3> observer(double wavelength) {
    const auto lobe = [&](double height, double middle, double left, double right) {
        const double x = (wavelength - middle) / (wavelength < middle ? left : right);
        return height * std::exp(-x * x / 2);
    };
    return {lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) + lobe(-0.065, 501.1, 20.4, 26.2),
            lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
            lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)};
}

/// The sum of a spectrum as a linear colour with the primaries of sRGB.
template <class F>
Vec3d colour_of(F spectrum) {
    Vec3d xyz;
    for (int wavelength = 400; wavelength <= 700; wavelength += 4)
        for (std::size_t k = 0; k < 3; ++k)
            xyz[static_cast<int>(k)] += observer(wavelength)[k] * spectrum(wavelength);
    return {dot(xyz, Vec3d(3.2404542, -1.5371385, -0.4985314)),
            dot(xyz, Vec3d(-0.9692660, 1.8760108, 0.0415560)),
            dot(xyz, Vec3d(0.0556434, -0.2040259, 1.0572252))};
}

TEST(SceneLooks, TheCornellBoxHasItsMeasuredColours) {
    const auto model = generate_model<float>({"cornell-box", {}, 0});
    const auto material = [&](const std::string& name) {
        for (const Material& m : model.materials)
            if (m.name == name) return m;
        ADD_FAILURE() << "no material " << name;
        return Material();
    };
    const Vec3d daylight = colour_of([](double w) { return at(d65, w); });
    const auto expect_paint = [&](const std::string& name, const Spectrum& paint) {
        const Vec3d reflected = colour_of([&](double w) { return at(d65, w) * at(paint, w); });
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(static_cast<double>(material(name).base_colour[k]), reflected[k] / daylight[k], 0.001)
                << name << " " << k;
        EXPECT_EQ(material(name).specular, 0) << "matte";
    };
    expect_paint("white", white_paint);
    expect_paint("green", green_paint);
    expect_paint("red", red_paint);
    double luminance_of_one = 0;
    for (int w = 400; w <= 700; w += 4) luminance_of_one += observer(w)[1];
    const Vec3d shine = colour_of([](double w) { return at(lamp, w); }) / luminance_of_one;
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(static_cast<double>(material("light").emission[k]), shine[k], 0.01) << k;
}

}  // namespace
}  // namespace hedgerow
