/// How the verbs that make pictures say how large they are and from where.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/render/raycast.h>

#include "common.h"
#include "upright.h"

namespace hedgerow::cli {

struct ViewArguments {
    std::string size = "1024x768", up = "auto";
    std::vector<float> eye, target, light;
    float fov = 0;
    double radius = 0;
};
void add_view(CLI::App& verb, ViewArguments& view);
/// Only where the camera is and where it looks.
void add_camera(CLI::App& verb, ViewArguments& view);

/// Width and height. Throws UsageError unless it is WIDTHxHEIGHT, each from 1 to 32768.
std::pair<int, int> parse_size(const std::string& text);

/// Which way is up: as the user says, or as the scene does.
template <class P>
Upright upright_of(const ViewArguments& view, const Common& common, const P& primitives) {
    if (view.up != "auto") return {view.up[0] - 'x', ""};
    return upright_of(common, primitives);
}
/// A line for people: what was chosen for them. Empty where nothing was, and for generated scenes.
std::string up_text(const ViewArguments& view, const Common& common, const Upright& upright);

/// Where the scene is best seen from, but for what the user says. Throws UsageError for a camera that
/// sees nothing, as one that looks along up.
Camera camera_of(const ViewArguments& view, const Common& common, const Box3f& bounds,
                 const Upright& upright);

/// Whether a picture's file is .exr, layers of numbers, or .png, colours. Throws UsageError for any other
/// ending, and InputError for .exr in a build without OpenEXR.
bool asks_for_layers(const std::string& output);

/// Where a picture goes: one that was interrupted must not replace one of before.
struct FinishedPicture {
    std::string output;
    bool whole = true;

    /// After a message, if it is not whole.
    int exit_code() const;
};
/// By how many of its rows are done. Throws Cancelled if none is.
FinishedPicture finish_picture(const std::string& output, std::uint64_t rows, int height);

/// Throws MemoryShort for a picture too large to be held. `layers` are kept beside its colours.
void check_picture_memory(const std::string& size, bool layers);

/// Writes layers, if the picture has them, else colours.
void save(const std::string& output, const Picture& picture);

/// Rays pass between points, so that points are seen as small spheres.
template <class T>
SphereSet<T, 3> spheres_at(const PointCloud<T, 3>& cloud, double wanted_radius) {
    Box<T, 3> box;
    for (const auto& p : cloud.points) box.expand(p);
    T radius = static_cast<T>(wanted_radius);
    if (radius == 0 && cloud.size() > 0)
        radius = length(box.extent()) / (10 * std::cbrt(static_cast<T>(cloud.size())));
    SphereSet<T, 3> spheres;
    for (const auto& p : cloud.points) spheres.spheres.push_back({p, radius > 0 ? radius : T(1)});
    return spheres;
}

}  // namespace hedgerow::cli
