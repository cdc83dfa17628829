#include "view.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <hedgerow/error.h>
#include <hedgerow/io/exr.h>
#include <hedgerow/io/image.h>

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

std::pair<int, int> parse_size(const std::string& text) {
    int w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &rest) != 2 || w < 1 || h < 1 || w > 32768 || h > 32768)
        throw InputError(fmt::format(
            "--size {}: a picture is WIDTHxHEIGHT pixels, each from 1 to 32768, as 1024x768", text));
    return {w, h};
}

bool asks_for_layers(const std::string& output) {
    const auto ending = std::filesystem::path(output).extension();
    if (ending == ".png") return false;
    if (ending != ".exr")
        throw InputError(fmt::format(
            "{}: a picture is written as .png (colours) or .exr (layers of numbers); let the output end so",
            output));
    if (!exr_supported())
        throw InputError(output + ": this tool was built without OpenEXR; let the output end with .png");
    return true;
}

void save(const std::string& output, const Picture& picture) {
    if (picture.seen.empty())
        save_png(output, picture.image);
    else
        save_exr(output, picture.layers());
}

std::string up_text(const ViewArguments& view, const Common& common, const Upright& upright) {
    if (view.up != "auto" || common.scene.starts_with("gen:")) return {};
    return fmt::format("{} is up, {}; --up turns the view\n", upright.letter(), upright.reason);
}

Camera camera_of(const ViewArguments& view, const Common& common, const Box3f& bounds,
                 const Upright& upright) {
    auto c = automatic_camera(bounds, upright.axis);
    // A scene's own view serves unless the user turns it.
    if (const auto own = camera_for(generated_name(common)); own && (view.up == "auto" || own->up == c.up))
        c = *own;
    if (view.eye.size() == 3) c.eye = {view.eye[0], view.eye[1], view.eye[2]};
    if (view.target.size() == 3) c.target = {view.target[0], view.target[1], view.target[2]};
    if (view.light.size() == 3) c.light = {view.light[0], view.light[1], view.light[2]};
    if (view.fov > 0) c.field_of_view = view.fov;
    if (length2(cross(c.target - c.eye, c.up)) == 0)
        throw InputError("the camera looks along its up direction; change --eye, --target or --up");
    return c;
}

}  // namespace hedgerow::cli
