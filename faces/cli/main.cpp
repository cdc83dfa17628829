/// The tool: render, info, generate.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>

#include <unistd.h>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/io/image.h>
#include <hedgerow/io/mesh_file.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/render/raycast.h>
#include <hedgerow/scenes/generate.h>

using namespace hedgerow;

namespace {

std::atomic<bool> interrupted{false};

double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// A line on stderr with rate and time left; silent unless a person looks.
class ProgressLine {
public:
    ProgressLine(std::string what, bool quiet)
        : what_(std::move(what)), shown_(!quiet && isatty(2)), start_(now()) {}
    ~ProgressLine() {
        if (shown_) fmt::print(stderr, "\r\033[K");
    }
    Progress progress() {
        return {[this](std::uint64_t done, std::uint64_t total) { show(done, total); }, &interrupted};
    }

private:
    void show(std::uint64_t done, std::uint64_t total) {
        const std::lock_guard lock(mutex_);
        if (!shown_ || now() - last_ < 0.1) return;
        last_ = now();
        const double rate = double(done) / (last_ - start_ + 1e-9);
        if (total > 0)
            fmt::print(stderr, "\r\033[K{} {:3.0f}%  {:.3g}/s  {:.0f} s left", what_,
                       100.0 * double(done) / double(total), rate, double(total - done) / (rate + 1e-9));
        else
            fmt::print(stderr, "\r\033[K{} {}  {:.3g}/s", what_, done, rate);
    }
    std::string what_;
    bool shown_;
    double start_, last_ = 0;
    std::mutex mutex_;
};

struct Common {
    std::string scene, output, json_dummy;
    bool json = false, quiet = false, drop_bad = false;
    std::uint64_t seed = 0;
};

Scene<float> load(const Common& c) {
    if (c.scene.starts_with("gen:")) {
        auto spec = parse_scene_spec(c.scene);
        spec.seed = c.seed;
        return generate<float>(spec);
    }
    ProgressLine line("loading", c.quiet);
    const auto extension = std::filesystem::path(c.scene).extension();
    if (extension == ".npy" || extension == ".csv")
        return load_points<float, 3>(c.scene, {c.drop_bad}, line.progress());
    return load_mesh<float>(c.scene, {c.drop_bad}, line.progress());
}

void check_writable(const std::string& path) {
    const auto folder = std::filesystem::absolute(path).parent_path();
    if (!std::filesystem::is_directory(folder))
        throw InputError(fmt::format("{}: there is no folder {}; make it first", path, folder.string()));
    if (std::filesystem::is_directory(path) || access(folder.c_str(), W_OK) != 0)
        throw InputError(path + ": cannot be written; choose another output");
}

struct RenderArguments : Common {
    std::string structure = "bvh", size = "1024x768", shading = "diffuse", up = "auto";
    std::vector<float> eye, target;
    float fov = 0;
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

template <class P>
int render(const RenderArguments& a, const P& primitives) {
    const auto [width, height] = parse_size(a.size);
    check_writable(a.output);
    const ThreadLimit limit(a.threads);
    const double start = now();
    const auto index = build_any(a.structure, primitives);
    const double built = now();
    RenderOptions options;
    options.width = width, options.height = height, options.samples = a.spp, options.seed = a.seed,
    options.steps_max = a.steps_max;
    options.shading = parse_shading(a.shading);
    options.camera = a.scene.starts_with("gen:teapot-in-stadium")
                         ? beside_the_teapot()
                         : automatic_camera(Box3f{Vec3f(index->bounds().low), Vec3f(index->bounds().high)});
    if (a.eye.size() == 3) options.camera.eye = {a.eye[0], a.eye[1], a.eye[2]};
    if (a.target.size() == 3) options.camera.target = {a.target[0], a.target[1], a.target[2]};
    if (a.up == "x") options.camera.up = {1, 0, 0};
    if (a.up == "y") options.camera.up = {0, 1, 0};
    if (a.up == "z") options.camera.up = {0, 0, 1};
    if (a.fov > 0) options.camera.field_of_view = a.fov;
    ProgressLine line("rendering", a.quiet);
    const double traced = now();
    const Picture picture = raycast(*index, primitives, options, default_executor(), line.progress());
    const double seconds = now() - traced;
    save_png(a.output, picture.image);
    const double rays = double(std::max<std::uint64_t>(picture.rays, 1));
    if (a.json) {
        nlohmann::json j = {{"structure", a.structure},
                            {"output", a.output},
                            {"width", width},
                            {"height", height},
                            {"rays", picture.rays},
                            {"seconds", seconds},
                            {"rays_per_second", rays / seconds},
                            {"nodes_per_ray", double(picture.visits.nodes) / rays},
                            {"leaves_per_ray", double(picture.visits.leaves) / rays},
                            {"primitives_per_ray", double(picture.visits.primitives) / rays},
                            {"build_seconds", built - start},
                            {"bytes", index->bytes()},
                            {"primitives", index->size()},
                            {"finished", !interrupted.load()}};
        fmt::print("{}\n", j.dump(2));
    } else if (!a.quiet) {
        fmt::print("{}: {}x{}, {} primitives, {} built in {:.1f} ms, {:.1f} bytes a primitive\n", a.output,
                   width, height, index->size(), a.structure, (built - start) * 1e3,
                   double(index->bytes()) / double(std::max<std::size_t>(1, index->size())));
        fmt::print(
            "{} rays in {:.3f} s: {:.3f} million a second; a ray visits {:.1f} nodes, {:.1f} leaves, {:.1f} "
            "primitives\n",
            picture.rays, seconds, rays / seconds * 1e-6, double(picture.visits.nodes) / rays,
            double(picture.visits.leaves) / rays, double(picture.visits.primitives) / rays);
    }
    if (!interrupted) return 0;
    fmt::print(stderr, "hedgerow: interrupted; the finished part is in {}\n", a.output);
    return 130;
}

int render(const RenderArguments& a) {
    parse_size(a.size);
    check_writable(a.output);
    const auto scene = load(a);
    if (const auto* mesh = std::get_if<TriangleMesh<float>>(&scene)) return render(a, *mesh);
    if (const auto* spheres = std::get_if<SphereSet<float, 3>>(&scene)) return render(a, *spheres);
    throw InputError(a.scene +
                     ": only triangles and spheres in space can be rendered; rays pass between points");
}

nlohmann::json facts(const TriangleMesh<float>& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    std::vector<bool> used(mesh.vertices.size());
    Box3f box;
    std::size_t flat = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const auto& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            used[t[k]] = true;
            box.expand(mesh.vertices[t[k]]);
            ++edges[std::minmax(t[k], t[(k + 1) % 3])];
        }
        const auto n = mesh.view().normal(i);
        flat += length2(Vec3d(n)) == 0;
    }
    std::size_t open = 0, many = 0;
    for (const auto& [edge, faces] : edges) open += faces == 1, many += faces > 2;
    return {{"kind", "triangles"},
            {"triangles", mesh.size()},
            {"vertices", mesh.vertices.size()},
            {"low", {box.low[0], box.low[1], box.low[2]}},
            {"high", {box.high[0], box.high[1], box.high[2]}},
            {"zero_area_triangles", flat},
            {"open_edges", open},
            {"non_manifold_edges", many},
            {"unused_vertices", std::count(used.begin(), used.end(), false)},
            {"closed", open == 0 && many == 0}};
}
template <class T, int D>
nlohmann::json facts(const SphereSet<T, D>& s) {
    return {{"kind", "spheres"}, {"spheres", s.size()}, {"dimension", D}};
}
template <class T, int D>
nlohmann::json facts(const PointCloud<T, D>& s) {
    return {{"kind", "points"}, {"points", s.size()}, {"dimension", D}};
}
template <class T>
nlohmann::json facts(const SegmentSet<T>& s) {
    return {{"kind", "segments"}, {"segments", s.size()}, {"dimension", 2}};
}

int info(const Common& c) {
    const auto scene = load(c);
    const auto j = std::visit([](const auto& set) { return facts(set); }, scene);
    if (c.json) {
        fmt::print("{}\n", j.dump(2));
    } else {
        for (const auto& [key, value] : j.items()) fmt::print("{:22} {}\n", key, value.dump());
    }
    return 0;
}

int generate_file(const Common& c) {
    if (!c.scene.starts_with("gen:"))
        throw InputError(c.scene + ": only a gen: scene can be generated, as gen:terrain:200000");
    check_writable(c.output);
    const auto scene = load(c);
    if (const auto* mesh = std::get_if<TriangleMesh<float>>(&scene))
        save_mesh(c.output, *mesh);
    else if (const auto* p3 = std::get_if<PointCloud<float, 3>>(&scene))
        save_points(c.output, *p3);
    else if (const auto* p2 = std::get_if<PointCloud<float, 2>>(&scene))
        save_points(c.output, *p2);
    else
        throw InputError(c.scene + ": no file format here holds these primitives");
    if (!c.quiet) fmt::print("{}\n", c.output);
    return 0;
}

std::string footer() {
    std::string text = "Structures (options behind a colon, as bvh:builder=sweep):\n";
    for (const auto& s : structure_list()) {
        text += fmt::format("  {:14} {}\n", s.name, s.description);
        for (const auto& o : s.options)
            text += fmt::format("    {}={} [{}]: {}\n", o.name, o.values, o.standard, o.meaning);
    }
    text += "Generated scenes (gen:NAME[:SIZE]):\n";
    for (const auto& s : scene_list()) text += fmt::format("  {:20} {}\n", s.name, s.description);
    return text;
}

int run(int count, char** arguments) {
    CLI::App app(
        "Examples:\n  hedgerow render gen:teapot-in-stadium -o stadium.png\n  hedgerow render dragon.ply "
        "--shading steps -o steps.png\n"
        "  hedgerow info dragon.ply\n  hedgerow generate gen:terrain:200000 -o terrain.ply\n\n"
        "Spatial data structures for rays, geometric queries and particles.");
    app.set_version_flag("--version", "hedgerow 0.1.0");
    app.require_subcommand(1);
    app.footer(footer());
    const auto shared = [](CLI::App* verb, Common& c, bool output) {
        verb->add_option("scene", c.scene, "a mesh or point file, or gen:NAME[:SIZE]")->required();
        if (output) verb->add_option("-o,--output", c.output, "the file to write")->required();
        verb->add_flag("--json", c.json, "results as JSON");
        verb->add_flag("--quiet", c.quiet, "no progress and no summary");
        verb->add_flag("--drop-bad", c.drop_bad, "leave out faces with NaN or infinite vertices");
        verb->add_option("--seed", c.seed, "of random scenes and samples");
    };
    RenderArguments r;
    Common i, g;
    auto* render_verb = app.add_subcommand(
        "render",
        "Examples:\n  hedgerow render gen:teapot -o teapot.png --size 640x480\n"
        "  hedgerow render gen:teapot-in-stadium --shading steps -o steps.png\n\na picture, by rays");
    shared(render_verb, r, true);
    render_verb->add_option("--structure", r.structure, "NAME[:OPTION=VALUE,...]")->capture_default_str();
    render_verb->add_option("--size", r.size, "WIDTHxHEIGHT")->capture_default_str();
    render_verb->add_option("--shading", r.shading, "normals, depth, diffuse or steps")
        ->capture_default_str()
        ->check(CLI::IsMember({"normals", "depth", "diffuse", "steps"}));
    render_verb->add_option("--spp", r.spp, "samples a pixel")->check(CLI::Range(1, 4096));
    render_verb->add_option("--threads", r.threads, "0: all cores")->check(CLI::Range(0, 1024));
    render_verb->add_option("--eye", r.eye, "x,y,z")->delimiter(',')->expected(3);
    render_verb->add_option("--target", r.target, "x,y,z")->delimiter(',')->expected(3);
    render_verb->add_option("--up", r.up, "x, y or z")->check(CLI::IsMember({"auto", "x", "y", "z"}));
    render_verb->add_option("--fov", r.fov, "vertical angle of view in degrees; 45 if not given")
        ->check(CLI::Range(1.0f, 170.0f));
    render_verb->add_option("--steps-max", r.steps_max,
                            "the top of the scale of --shading steps; 0: what was seen");
    auto* info_verb = app.add_subcommand("info",
                                         "Examples:\n  hedgerow info dragon.ply\n  hedgerow info gen:cube "
                                         "--json\n\nwhat is in a scene, and what is wrong with it");
    shared(info_verb, i, false);
    auto* generate_verb =
        app.add_subcommand("generate",
                           "Examples:\n  hedgerow generate gen:teapot:100k -o teapot.stl\n  hedgerow "
                           "generate gen:points -o points.npy\n\nwrite a generated scene");
    shared(generate_verb, g, true);
    try {
        app.parse(count, arguments);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    std::signal(SIGINT, [](int) { interrupted = true; });
    if (*render_verb) return render(r);
    return *info_verb ? info(i) : generate_file(g);
}

}  // namespace

int main(int count, char** arguments) {
    try {
        return run(count, arguments);
    } catch (const Cancelled&) {
        fmt::print(stderr, "hedgerow: interrupted\n");
        return 130;
    } catch (const InputError& e) {
        fmt::print(stderr, "hedgerow: {}\n", e.what());
        return 3;
    } catch (const std::exception& e) {
        fmt::print(stderr, "hedgerow: {}\n", e.what());
        return 1;
    }
}
