/// The list of scenes, and scenes by name.
#include <hedgerow/scenes/generate.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <type_traits>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>
#include <hedgerow/scenes/size_text.h>

#include "precision.h"

namespace hedgerow {
namespace {

using U = std::uint64_t;
using P = Progress;

template <class T>
struct In {};  // names a precision

/// An entry of the list, from a function of (In<T>, size, seed, progress).
template <class F>
constexpr SceneInfo scene(std::string_view name, std::uint64_t size, std::string_view yields, int dimension,
                          std::string_view description, double bytes, F) {
    return {name,
            size,
            yields,
            dimension,
            description,
            bytes,
            [](U n, U seed, const Progress& progress) -> Scene<float> {
                return F{}(In<float>{}, n, seed, progress);
            },
            [](U n, U seed, const Progress& progress) -> Scene<double> {
                return F{}(In<double>{}, n, seed, progress);
            },
            nullptr};
}

/// An entry of particles: their places, and all of them for those who ask.
template <class F>
constexpr SceneInfo particles(std::string_view name, std::string_view description, F) {
    SceneInfo info =
        scene(name, 100'000, "points", 3, description, 80, []<class T>(In<T>, U n, U seed, const P& p) {
            return PointCloud<T, 3>{detail::narrowed<T>(F{}(n, seed, p).places)};
        });
    info.particles = [](U n, U seed, const P& p) { return F{}(n, seed, p); };
    return info;
}

/// The one list of scenes.
constexpr SceneInfo scenes[] = {
    scene("teapot", 6'320, "triangles", 3, "the Utah teapot from its Bézier patches", 60,
          []<class T>(In<T>, U n, U, const P& p) { return teapot<T>(n, p); }),
    scene("teapot-in-stadium", 54'056, "triangles", 3, "a small fine teapot in a huge coarse stadium", 24,
          []<class T>(In<T>, U n, U, const P& p) { return teapot_in_stadium<T>(n, p); }),
    scene("turned-stadium", 54'056, "triangles", 3, "the same, turned by 30 degrees about two axes", 24,
          []<class T>(In<T>, U n, U, const P& p) { return turned_stadium<T>(n, p); }),
    scene("terrain", 2 * 1024 * 1024, "triangles", 3, "a fractal landscape over the unit square", 24,
          []<class T>(In<T>, U n, U seed, const P& p) { return terrain<T>(n, seed, p); }),
    scene("grass", 1'000'001, "triangles", 3, "thin blades of grass on uneven ground", 52,
          []<class T>(In<T>, U n, U seed, const P& p) { return grass<T>(n, seed, p); }),
    scene("hairball", 1'000'000, "triangles", 3, "thin long curved strands around a ball", 37,
          []<class T>(In<T>, U n, U seed, const P& p) { return hairball<T>(n, seed, p); }),
    scene("soup", 1'000'000, "triangles", 3, "separate random triangles in the unit cube", 84,
          []<class T>(In<T>, U n, U seed, const P& p) { return soup<T>(n, seed, p); }),
    scene("boulder", 999'940, "triangles", 3, "a smooth closed surface with fine detail, like a scan", 60,
          []<class T>(In<T>, U n, U seed, const P& p) { return boulder<T>(n, seed, p); }),
    scene("interior", 967'616, "triangles", 3, "a furnished flat of six rooms, from walls to pens", 24,
          []<class T>(In<T>, U n, U seed, const P& p) { return interior<T>(n, seed, p); }),
    scene("cornell-box", 32, "triangles", 3, "the Cornell box: a room with a light and two blocks", 60,
          []<class T>(In<T>, U n, U, const P& p) { return cornell_box<T>(n, p); }),
    scene("cube", 12, "triangles", 3, "the closed cube from -1 to 1", 60,
          []<class T>(In<T>, U n, U, const P& p) { return cube<T>(n, p); }),
    scene("spheres", 10'000, "spheres", 3, "random spheres in the unit cube", 32,
          []<class T>(In<T>, U n, U seed, const P& p) { return spheres<T>(n, seed, p); }),
    scene("points", 100'000, "points", 3, "random points in the unit cube", 24,
          []<class T>(In<T>, U n, U seed, const P& p) { return points<T>(n, seed, p); }),
    particles("plummer", "stars: a Plummer sphere in equilibrium",
              [](U n, U seed, const P& p) { return plummer(n, seed, p); }),
    particles("hernquist", "stars: Hernquist's galaxy in equilibrium, dense in its center",
              [](U n, U seed, const P& p) { return hernquist(n, seed, p); }),
    particles("uniform-sphere", "stars: a uniform sphere that swings about equilibrium",
              [](U n, U seed, const P& p) { return uniform_sphere(n, seed, p); }),
    particles("cold-collapse", "stars: a uniform sphere at rest, which falls into its center",
              [](U n, U seed, const P& p) { return cold_collapse(n, seed, p); }),
    particles("cold-cube", "stars: the unit cube at rest, which clumps where it repeats",
              [](U n, U seed, const P& p) { return cold_cube(n, seed, p); }),
    particles("disc", "stars: a thin disc that turns",
              [](U n, U seed, const P& p) { return disc(n, seed, p); }),
    particles("two-clusters", "stars: two Plummer spheres that fall into each other",
              [](U n, U seed, const P& p) { return two_clusters(n, seed, p); }),
    scene("points2d", 100'000, "points", 2, "random points in the unit square", 16,
          []<class T>(In<T>, U n, U seed, const P& p) { return points2d<T>(n, seed, p); }),
    scene("clusters2d", 100'000, "points", 2, "random points in 16 heaps in the unit square", 16,
          []<class T>(In<T>, U n, U seed, const P& p) { return clusters2d<T>(n, seed, p); }),
    scene("segments2d", 10'000, "segments", 2, "short random segments in the unit square", 32,
          []<class T>(In<T>, U n, U seed, const P& p) { return segments2d<T>(n, seed, p); }),
};

const SceneInfo& scene_named(std::string_view name) {
    const auto found = std::ranges::find(scenes, name, &SceneInfo::name);
    if (found != std::end(scenes)) return *found;
    std::vector<std::string_view> names;
    std::string list;
    for (const SceneInfo& s : scenes) {
        names.push_back(s.name);
        list += (list.empty() ? "" : ", ") + std::string(s.name);
    }
    throw UsageError("gen:" + std::string(name) + ": there is no scene '" + std::string(name) + "'" +
                     suggestion(name, names) + "; the scenes are " + list);
}

void check_size(std::string_view name, std::uint64_t size) {
    if (size > largest_scene_size)
        throw UsageError("gen:" + std::string(name) + ": size " + std::to_string(size) +
                         " is too large; ask for at most " + std::to_string(largest_scene_size));
}

/// The factor for the letter after a number; 0 if the letter is unknown.
std::uint64_t multiplier(std::string_view suffix) {
    if (suffix.empty()) return 1;
    if (suffix == "k" || suffix == "K") return 1'000;
    if (suffix == "m" || suffix == "M") return 1'000'000;
    if (suffix == "g" || suffix == "G") return 1'000'000'000;
    return 0;
}

}  // namespace

std::uint64_t parse_scene_size(std::string_view name, std::string_view text) {
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    const std::uint64_t times = multiplier({rest, static_cast<std::size_t>(end - rest)});
    if (error == std::errc::invalid_argument || times == 0)
        throw UsageError("gen:" + std::string(name) + ": '" + std::string(text) +
                         "' is not a size; write a whole number such as 5000, 100k or 2M");
    // Refuse numbers beyond 64 bits, and products beyond the largest size, without overflow.
    if (error == std::errc::result_out_of_range || value > largest_scene_size / times)
        throw UsageError("gen:" + std::string(name) + ": size " + std::string(text) +
                         " is too large; ask for at most " + std::to_string(largest_scene_size));
    return value * times;
}

std::span<const SceneInfo> scene_list() {
    return scenes;
}

SceneSpec parse_scene_spec(std::string_view text) {
    constexpr std::string_view scheme = "gen:";
    if (!text.starts_with(scheme))
        throw UsageError("'" + std::string(text) +
                         "' is not a generated scene; write gen:NAME or gen:NAME:SIZE");
    std::string_view name = text.substr(scheme.size());
    const std::size_t colon = name.find(':');
    const bool sized = colon != std::string_view::npos;
    const std::string_view size = sized ? name.substr(colon + 1) : std::string_view();
    name = name.substr(0, colon);
    SceneSpec spec;
    spec.name = scene_named(name).name;
    if (sized) spec.size = parse_scene_size(name, size);
    return spec;
}

template <class T>
Scene<T> generate(const SceneSpec& spec, const Progress& progress) {
    const SceneInfo& info = scene_named(spec.name);
    const std::uint64_t size = spec.size.value_or(info.default_size);
    check_size(info.name, size);
    if constexpr (std::is_same_v<T, float>)
        return info.in_float(size, spec.seed, progress);
    else
        return info.in_double(size, spec.seed, progress);
}
template Scene<float> generate<float>(const SceneSpec&, const Progress&);
template Scene<double> generate<double>(const SceneSpec&, const Progress&);

Particles generate_particles(const SceneSpec& spec, const Progress& progress) {
    const SceneInfo& info = scene_named(spec.name);
    if (info.particles == nullptr) {
        std::string list;
        for (const SceneInfo& s : scenes)
            if (s.particles != nullptr) list += (list.empty() ? "gen:" : ", gen:") + std::string(s.name);
        throw UsageError("gen:" + spec.name + " has no velocities and masses; those that have are " + list);
    }
    const std::uint64_t size = spec.size.value_or(info.default_size);
    check_size(info.name, size);
    return info.particles(size, spec.seed, progress);
}

}  // namespace hedgerow
