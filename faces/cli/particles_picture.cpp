/// Pictures of particles before a mesh.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/render/film/colour.h>
#include <hedgerow/render/lettering.h>
#include <hedgerow/render/shading/shading.h>

#include "particles.h"

namespace hedgerow::cli {

namespace {

using BallIndex = IndexOf<WideBvh, SphereSet<float, 3>>;

TriangleMesh<float> in_float(const TriangleMesh<double>& mesh) {
    TriangleMesh<float> rounded;
    for (const Vec3d& p : mesh.vertices) rounded.vertices.emplace_back(p);
    rounded.triangles = mesh.triangles;
    return rounded;
}
/// The colour of a number from 0 to 1, as linear light.
Vec3f heat_light(double x) {
    const Image::Pixel p = heat(static_cast<float>(std::clamp(x, 0.0, 1.0)));
    return {linear_of_srgb8(p[0]), linear_of_srgb8(p[1]), linear_of_srgb8(p[2])};
}

/// The light of what glows, from dark red at 0 by orange and yellow to white at 1.
Vec3f glow_light(double x) {
    const auto from = [&](double low, double high) {
        return static_cast<float>(std::clamp((x - low) / (high - low), 0.0, 1.0));
    };
    return {0.15f + 0.85f * from(0, 0.4), from(0.1, 0.8), from(0.6, 1.1)};
}

/// Balls and the mesh, as rays see them.
struct BallsAndMesh {
    const MeshIndex<float>& mesh;
    const BallIndex& balls;
    const std::vector<Vec3f>& colours;
    bool glow;  // whether the colours of balls are lights of their own
    const PlainShading& plain;
    float least;  // how far rays to the light begin from the surface

    Vec3f light(const Ray3f& ray) const {
        const auto on_mesh = closest_hit(mesh, ray);
        Ray3f before = ray;
        if (on_mesh) before.t_max = on_mesh.t;
        const auto on_ball = closest_hit(balls, before);
        // It is dusk where balls glow.
        const float day = glow ? 0.2f : 1;
        if (!on_mesh && !on_ball) return plain.background() * day;
        if (on_ball && glow) return colours[on_ball.element];
        const Vec3f place = on_ball ? position(balls, ray, on_ball) : position(mesh, ray, on_mesh);
        Vec3f n = on_ball ? normal(balls, ray, on_ball) : normal(mesh, ray, on_mesh);
        if (dot(n, ray.direction) > 0) n = -n;
        // The plain shading is that of grey; a ball has a colour in its place.
        const Vec3f colour = on_ball ? colours[on_ball.element] * (1 / PlainShading::grey) : Vec3f::all(day);
        Vec3f sum = plain.sky(n);
        const float facing = dot(n, plain.to_light());
        const Ray3f to_light{place + n * least, plain.to_light(), 0};
        // What glows casts no shadow.
        if (facing > 0 && !any_hit(mesh, to_light) && (glow || !any_hit(balls, to_light)))
            sum += plain.direct(facing);
        return map(sum, colour, [](float a, float b) { return product(a, b); });
    }
};

}  // namespace

ParticlesPicture::ParticlesPicture(const ParticlesArguments& a, const ParticlesScene& scene)
    : arguments_(a),
      scene_(scene),
      mesh_(build(in_float(scene.mesh))),
      camera_(camera_of(a.view, a, scene.shown, scene.upright)) {}

Image ParticlesPicture::draw(const ParticleState& state) const {
    const auto size_in_pixels = parse_size(arguments_.view.size);
    const int width = size_in_pixels.first, height = size_in_pixels.second;
    // Make balls of the particles. Small ones are drawn as large as can be seen.
    const float size = static_cast<float>(scene_.size);
    const bool glow = arguments_.colour == "age";
    SphereSet<float, 3> spheres;
    std::vector<Vec3f> colours;
    for (std::size_t i = 0; i < state.size(); ++i) {
        spheres.spheres.push_back(
            {Vec3f(state.particles.places[i]), std::max(static_cast<float>(state.radii[i]), 0.004f * size)});
        colours.push_back(
            glow ? glow_light(1 - state.ages[i] / state.lives[i])
                 : heat_light(0.15 + 0.85 * length(state.particles.velocities[i]) / scene_.fastest));
    }
    const BallIndex balls = build(std::move(spheres));
    const PlainShading plain(camera_, size);
    const BallsAndMesh scene{mesh_, balls, colours, glow, plain, 1e-4f * size};
    const RayMaker rays(camera_, width, height);
    Image image(width, height);
    default_executor().for_each_piece(
        static_cast<std::size_t>(height), 4, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < width; ++x) {
                    // Four samples a pixel.
                    Vec3f sum;
                    for (const float dy : {0.25f, 0.75f})
                        for (const float dx : {0.25f, 0.75f})
                            sum += scene.light(
                                rays.ray<float>(static_cast<float>(x) + dx, static_cast<float>(y) + dy));
                    image.at(x, y) = srgb(sum / 4.f);
                }
        });
    draw_note(image, 0, 0, {fmt::format("t = {:.3g}", state.time), fmt::format("{} particles", state.size())},
              width >= 1000 ? 2 : 1);
    return image;
}

}  // namespace hedgerow::cli
