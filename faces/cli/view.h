/// The options of verbs that make pictures: size, camera, light and the radius of points.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <hedgerow/geometry/elementary.h>
#include <hedgerow/primitives/point_cloud.h>
#include <hedgerow/primitives/sphere_set.h>
#include <hedgerow/render/render.h>

#include "common.h"
#include "upright.h"

namespace hedgerow::cli {

struct ViewArguments {
    std::string size = "1024x768", up = "auto";
    std::vector<float> eye, target, light;
    float fov = 0;
    double radius = 0;
    std::string named = "auto", projection = "perspective";
    float height = 0, lens = 0, focus = 0;
};
void add_view(CLI::App& verb, ViewArguments& view);
/// Adds the options of other cameras than a pinhole, and views by name.
void add_projection(CLI::App& verb, ViewArguments& view);
/// Adds only --eye, --target, --up and --fov.
void add_camera(CLI::App& verb, ViewArguments& view);

/// Width and height in pixels. Throws UsageError unless the text is WIDTHxHEIGHT, each from 1 to 32768.
std::pair<int, int> parse_size(const std::string& text);

/// The upward axis: the user's, or the scene's.
template <class P>
Upright upright_of(const ViewArguments& view, const Common& common, const P& primitives) {
    if (view.up != "auto") return {view.up[0] - 'x', ""};
    return upright_of(common, primitives);
}
/// A line that tells the user which upward axis was chosen, and why. Empty if the user chose, and for
/// generated scenes.
std::string up_text(const ViewArguments& view, const Common& common, const Upright& upright);

/// The upward direction of what a picture shows: that of the scene's own camera if the view is its own, else
/// the upward axis. Unlike a camera's it does not tilt when the camera looks up or down.
Vec3f upward(const ViewArguments& view, const Common& common, const Upright& upright);

/// The scene's own camera, or one from the bounds, changed as the user's options say. Throws UsageError for a
/// camera that sees nothing, such as one that looks along its up direction, and for --light 0,0,0.
Camera camera_of(const ViewArguments& view, const Common& common, const Box3f& bounds,
                 const Upright& upright);

/// True if the output is .exr (layers of numbers), false if it is .png (colours). Throws UsageError for any
/// other extension, and InputError for .exr in a build without OpenEXR.
bool asks_for_layers(const std::string& output);

/// The file that a picture is saved in. An interrupted picture has another name, so that it does not replace
/// an earlier one.
struct FinishedPicture {
    std::string output;
    bool whole = true;

    /// 0 if the picture is whole. Else prints a message to stderr and returns 130.
    int exit_code() const;
};
/// Chooses the file by what is finished: all rows, or some. Throws Cancelled if there are none.
FinishedPicture finish_picture(const std::string& output, bool some, bool all);

/// Throws MemoryShort if there is no memory for a picture of this size, with layers if `layers` is set, or
/// with so many bytes a pixel. Throw UsageError as parse_size does.
void check_picture_memory(const std::string& size, bool layers);
void check_memory_of_pixels(const std::string& size, std::size_t bytes_of_pixel);

/// Saves the layers of a picture as .exr if it has them, else its colours as .png.
void save(const std::string& output, const Picture& picture, std::uint64_t seed);

/// Small spheres in place of points, since rays pass between points. A radius of 0 stands for 1/10 of the
/// box's diagonal over the cube root of the number of points, or for 1 if the points coincide. O(n).
template <class T>
SphereSet<T, 3> spheres_at(const PointCloud<T, 3>& cloud, double wanted_radius) {
    Box<T, 3> box;
    for (const auto& p : cloud.points) box.expand(p);
    T radius = static_cast<T>(wanted_radius);
    if (radius == 0 && cloud.size() > 0)
        radius =
            length(box.extent()) / static_cast<T>(10 * power(static_cast<double>(cloud.size()), 1.0 / 3));
    SphereSet<T, 3> spheres;
    for (const auto& p : cloud.points) spheres.spheres.push_back({p, radius > 0 ? radius : T(1)});
    return spheres;
}

}  // namespace hedgerow::cli
