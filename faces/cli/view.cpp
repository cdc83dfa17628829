#include "view.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/exr.h>
#include <hedgerow/io/image.h>
#include <hedgerow/render/camera/presets.h>

#include "memory.h"
#include "picture_notes.h"

namespace hedgerow::cli {

void add_camera(CLI::App& verb, ViewArguments& view) {
    verb.add_option("--eye", view.eye, "x,y,z")->delimiter(',')->expected(3);
    verb.add_option("--target", view.target, "x,y,z")->delimiter(',')->expected(3);
    verb.add_option("--up", view.up, "x, y or z; auto: y for glTF, OBJ, PLY, z for STL, points, gen:")
        ->capture_default_str()
        ->check(CLI::IsMember({"auto", "x", "y", "z"}));
    verb.add_option("--fov", view.fov, "vertical angle of view in degrees; 45 if not given")
        ->check(CLI::Range(1.0f, 170.0f));
}

void add_view(CLI::App& verb, ViewArguments& view) {
    verb.add_option("--size", view.size, "WIDTHxHEIGHT")->capture_default_str();
    add_camera(verb, view);
    verb.add_option("--light", view.light, "x,y,z: towards the light")->delimiter(',')->expected(3);
    verb.add_option("--radius", view.radius, "of points, drawn as spheres; 0: by their number")
        ->check(CLI::NonNegativeNumber);
}

void add_projection(CLI::App& verb, ViewArguments& view) {
    std::vector<std::string> names = {"auto"};
    names.insert(names.end(), view_names.begin(), view_names.end());
    verb.add_option("--view", view.named,
                    "from where: corner, front, back, left, right, top or bottom; auto: the scene's own view")
        ->capture_default_str()
        ->check(CLI::IsMember(names));
    verb.add_option("--projection", view.projection,
                    "perspective, orthographic (parallel rays) or panorama (all directions)")
        ->capture_default_str()
        ->check(CLI::IsMember({"perspective", "orthographic", "panorama"}));
    verb.add_option("--height", view.height,
                    "of what an orthographic picture shows, in the scene's units; 0: by the view")
        ->check(CLI::NonNegativeNumber);
    verb.add_option("--lens", view.lens, "radius of a thin lens, in the scene's units; 0: a pinhole")
        ->check(CLI::NonNegativeNumber);
    verb.add_option("--focus", view.focus, "the distance that the lens has in focus; 0: that of the target")
        ->check(CLI::NonNegativeNumber);
}

std::pair<int, int> parse_size(const std::string& text) {
    constexpr int most = 32768;
    int w = 0, h = 0;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, w);
    const char* const by = width.ptr;
    const auto height = by != end && *by == 'x' ? std::from_chars(by + 1, end, h) : width;
    if (width.ec != std::errc() || height.ec != std::errc() || height.ptr != end || std::min(w, h) < 1 ||
        std::max(w, h) > most)
        throw UsageError(fmt::format(
            "--size {}: a picture is WIDTHxHEIGHT pixels, each from 1 to {}, as 1024x768", text, most));
    return {w, h};
}

bool asks_for_layers(const std::string& output) {
    const std::string ending = ending_of(output);
    if (ending == ".png") return false;
    if (ending != ".exr")
        throw UsageError(fmt::format(
            "{}: a picture is written as .png (colours) or .exr (layers of numbers); let the output end so",
            output));
    if (!exr_supported())
        throw InputError(output + ": this tool was built without OpenEXR; let the output end with .png");
    return true;
}

int FinishedPicture::exit_code() const {
    if (whole) return 0;
    std::fprintf(stderr, "hedgerow: interrupted; the finished part is in %s\n", output.c_str());
    return 130;
}
FinishedPicture finish_picture(const std::string& output, bool some, bool all) {
    if (!some) throw Cancelled("no row of the picture was finished");
    if (all) return {output, true};
    return {unfinished_name(output), false};
}

void check_picture_memory(const std::string& size, bool layers) {
    check_memory_of_pixels(size, sizeof(Image::Pixel) + sizeof(Vec3f) + (layers ? sizeof(Seen) : 0));
}
void check_memory_of_pixels(const std::string& size, std::size_t bytes_of_pixel) {
    const auto [width, height] = parse_size(size);
    expect_memory("a picture of " + size, double(bytes_of_pixel) * width * height,
                  "ask for a smaller --size");
}

void save(const std::string& output, const Picture& picture, std::uint64_t seed) {
    if (picture.seen.empty())
        save_png(output, picture.image, {}, picture_notes(seed));
    else
        save_exr(output, picture.layers(), {}, picture_notes(seed));
}

std::string up_text(const ViewArguments& view, const Common& common, const Upright& upright) {
    if (view.up != "auto" || common.scene.starts_with("gen:")) return {};
    return fmt::format("{} is up, {}; --up turns the view\n", upright.letter(), upright.reason);
}

Vec3f upward(const ViewArguments& view, const Common& common, const Upright& upright) {
    if (const auto own = camera_for(generated_name(common)); own && view.named == "auto" && view.up == "auto")
        return own->up;
    return scene_axes(upright.axis).up;
}

Camera camera_of(const ViewArguments& view, const Common& common, const Box3f& bounds,
                 const Upright& upright) {
    const auto [width, height] = parse_size(view.size);
    const float shape = static_cast<float>(width) / static_cast<float>(height);
    auto c =
        named_view(view.named, bounds, upright.axis, shape).value_or(automatic_camera(bounds, upright.axis));
    // Use the scene's own camera unless the user turns the view.
    if (const auto own = camera_for(generated_name(common));
        own && view.named == "auto" && (view.up == "auto" || own->up == c.up))
        c = *own;
    // Apply the user's options.
    if (view.eye.size() == 3) c.eye = {view.eye[0], view.eye[1], view.eye[2]};
    if (view.target.size() == 3) c.target = {view.target[0], view.target[1], view.target[2]};
    if (view.light.size() == 3 && view.light == std::vector<float>{0, 0, 0})
        throw UsageError("--light 0,0,0 is no direction: give one towards the light, as 1,1,2");
    if (view.light.size() == 3) c.light = {view.light[0], view.light[1], view.light[2]};
    if (view.fov > 0) c.field_of_view = view.fov;
    if (view.projection == "orthographic") c.projection = Projection::orthographic;
    if (view.projection == "panorama") c.projection = Projection::panorama;
    if (view.height > 0) c.height = view.height;
    c.lens_radius = view.lens, c.focus = view.focus;
    // Reject cameras that see nothing.
    if (c.eye == c.target)
        throw UsageError(fmt::format("the camera is at its target, ({}): change --eye or --target",
                                     fmt::join(c.eye.data, ", ")));
    if (!(length2(c.target - c.eye) <= std::numeric_limits<float>::max()))
        throw UsageError("the camera is too far from its target: bring --eye or --target nearer");
    if (length2(cross(c.target - c.eye, c.up)) == 0)
        throw UsageError("the camera looks along its up direction; change --eye, --target or --up");
    return c;
}

}  // namespace hedgerow::cli
