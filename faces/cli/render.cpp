/// hedgerow render: a picture, by rays.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/error.h>
#include <hedgerow/io/image.h>
#include <hedgerow/render/raycast.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

struct RenderArguments : Common {
    std::string structure = "bvh", size = "1024x768", shading = "diffuse", up = "auto";
    std::vector<float> eye, target, light;
    float fov = 0;
    double radius = 0;
    int spp = 1;
    unsigned threads = 0;
    std::uint64_t steps_max = 0;
};

std::pair<int, int> parse_size(const std::string& text) {
    int w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &rest) != 2 || w < 1 || h < 1 || w > 32768 || h > 32768)
        throw InputError(fmt::format(
            "--size {}: a picture is WIDTHxHEIGHT pixels, each from 1 to 32768, as 1024x768", text));
    return {w, h};
}

Camera camera_of(const RenderArguments& a, const Box3f& bounds) {
    Camera c = camera_for(generated_name(a)).value_or(automatic_camera(bounds));
    if (a.eye.size() == 3) c.eye = {a.eye[0], a.eye[1], a.eye[2]};
    if (a.target.size() == 3) c.target = {a.target[0], a.target[1], a.target[2]};
    if (a.light.size() == 3) c.light = {a.light[0], a.light[1], a.light[2]};
    if (a.up == "x") c.up = {1, 0, 0};
    if (a.up == "y") c.up = {0, 1, 0};
    if (a.up == "z") c.up = {0, 0, 1};
    if (a.fov > 0) c.field_of_view = a.fov;
    if (length2(cross(c.target - c.eye, c.up)) == 0)
        throw InputError("the camera looks along its up direction; change --eye, --target or --up");
    return c;
}

struct Outcome {
    Picture picture;
    std::size_t primitives = 0, bytes = 0;
    double build_seconds = 0, seconds = 0;
};

void report(const RenderArguments& a, const Outcome& o) {
    const double rays = double(std::max<std::uint64_t>(o.picture.rays, 1));
    const Visits& v = o.picture.visits;
    if (a.json) {
        const nlohmann::ordered_json j = {{"structure", a.structure},
                                          {"output", a.output},
                                          {"width", o.picture.image.width},
                                          {"height", o.picture.image.height},
                                          {"primitives", o.primitives},
                                          {"bytes", o.bytes},
                                          {"build_seconds", o.build_seconds},
                                          {"rays", o.picture.rays},
                                          {"seconds", o.seconds},
                                          {"rays_per_second", rays / o.seconds},
                                          {"nodes_per_ray", double(v.nodes) / rays},
                                          {"leaves_per_ray", double(v.leaves) / rays},
                                          {"primitives_per_ray", double(v.primitives) / rays},
                                          {"finished", !interrupted.load()}};
        fmt::print("{}\n", j.dump(2));
    } else if (!a.quiet) {
        fmt::print("{}: {}x{}, {} primitives, {} built in {:.1f} ms, {:.1f} bytes a primitive\n", a.output,
                   o.picture.image.width, o.picture.image.height, o.primitives, a.structure,
                   o.build_seconds * 1e3, double(o.bytes) / double(std::max<std::size_t>(1, o.primitives)));
        fmt::print(
            "{} rays in {:.3f} s: {:.3f} million a second; a ray visits {:.1f} nodes, {:.1f} leaves, "
            "{:.1f} primitives\n",
            o.picture.rays, o.seconds, rays / o.seconds * 1e-6, double(v.nodes) / rays,
            double(v.leaves) / rays, double(v.primitives) / rays);
    }
}

template <class P>
int render(const RenderArguments& a, const P& primitives) {
    RenderOptions options;
    std::tie(options.width, options.height) = parse_size(a.size);
    options.samples = a.spp, options.seed = a.seed, options.steps_max = a.steps_max;
    options.shading = parse_shading(a.shading);
    const ThreadLimit limit(a.threads);
    Outcome o;
    double start = now();
    const auto index = build_any(a.structure, primitives);
    o.build_seconds = now() - start;
    o.primitives = index->size(), o.bytes = index->bytes();
    options.camera = camera_of(a, Box3f{Vec3f(index->bounds().low), Vec3f(index->bounds().high)});
    {
        ProgressLine line("rendering", a.quiet);
        start = now();
        o.picture = raycast(*index, primitives, options, default_executor(), line.progress());
        o.seconds = now() - start;
    }
    save_png(a.output, o.picture.image);
    report(a, o);
    if (!interrupted) return 0;
    fmt::print(stderr, "hedgerow: interrupted; the finished part is in {}\n", a.output);
    return 130;
}
/// Rays pass between points, so points are drawn as small spheres.
template <class T>
int render(const RenderArguments& a, const PointCloud<T, 3>& cloud) {
    Box<T, 3> box;
    for (const auto& p : cloud.points) box.expand(p);
    T radius = static_cast<T>(a.radius);
    if (radius == 0 && cloud.size() > 0)
        radius = length(box.extent()) / (10 * std::cbrt(static_cast<T>(cloud.size())));
    SphereSet<T, 3> spheres;
    for (const auto& p : cloud.points) spheres.spheres.push_back({p, radius > 0 ? radius : T(1)});
    return render(a, spheres);
}
template <class T>
int render(const RenderArguments& a, const PointCloud<T, 2>&) {
    throw InputError(a.scene + ": only what lies in space can be rendered, and this is flat");
}
template <class T>
int render(const RenderArguments& a, const SegmentSet<T>&) {
    throw InputError(a.scene + ": only what lies in space can be rendered, and this is flat");
}

}  // namespace

Run add_render(CLI::App& verb) {
    auto a = std::make_shared<RenderArguments>();
    add_common(verb, *a, true);
    verb.add_option("--structure", a->structure, "NAME[:OPTION=VALUE,...]")->capture_default_str();
    verb.add_option("--size", a->size, "WIDTHxHEIGHT")->capture_default_str();
    verb.add_option("--shading", a->shading, "normals, depth, diffuse or steps")
        ->capture_default_str()
        ->check(CLI::IsMember({"normals", "depth", "diffuse", "steps"}));
    verb.add_option("--spp", a->spp, "samples a pixel")->check(CLI::Range(1, 4096));
    verb.add_option("--threads", a->threads, "0: all cores")->check(CLI::Range(0, 1024));
    verb.add_option("--eye", a->eye, "x,y,z")->delimiter(',')->expected(3);
    verb.add_option("--target", a->target, "x,y,z")->delimiter(',')->expected(3);
    verb.add_option("--light", a->light, "x,y,z: towards the light")->delimiter(',')->expected(3);
    verb.add_option("--up", a->up, "x, y or z")->check(CLI::IsMember({"auto", "x", "y", "z"}));
    verb.add_option("--fov", a->fov, "vertical angle of view in degrees; 45 if not given")
        ->check(CLI::Range(1.0f, 170.0f));
    verb.add_option("--radius", a->radius, "of points, drawn as spheres; 0: by their number")
        ->check(CLI::NonNegativeNumber);
    verb.add_option("--steps-max", a->steps_max, "the top of the scale of --shading steps; 0: what was seen");
    return [a] {
        parse_size(a->size);
        check_writable(a->output);
        return in_precision(*a, [&]<class T>(T) {
            return std::visit([&](const auto& set) { return render(*a, set); }, load<T>(*a));
        });
    };
}

}  // namespace hedgerow::cli
