// A picture: the rays of a camera as one batch, the normals of their hits as shades, and a PNG file.
//
//   picture [FILE]      the file is picture.png if none is named
#include <cmath>
#include <cstdio>

#include <hedgerow/hedgerow.h>
#include <hedgerow/io/image.h>
#include <hedgerow/render/camera/presets.h>
#include <hedgerow/render/camera/ray_maker.h>
#include <hedgerow/scenes/meshes.h>

using namespace hedgerow;

int main(int count, char** arguments) {
    const char* const file = count > 1 ? arguments[1] : "picture.png";
    constexpr int width = 640, height = 480;
    const auto index = build(teapot_in_stadium<float>(100'000));

    // One ray through the middle of each pixel.
    const Camera camera = camera_for("teapot-in-stadium").value();
    const RayMaker make(camera, width, height);
    std::vector<Ray3f> rays;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            rays.push_back(make.ray<float>(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));

    // One call answers them all, on all cores.
    std::vector<Hit<float>> hits(rays.size());
    closest_hits(index, rays, std::span(hits));

    // The more a surface faces the eye, the brighter it is.
    Image picture(width, height, {206, 220, 235});
    std::size_t seen = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i]) continue;
        const float facing = std::fabs(dot(normal(index, rays[i], hits[i]), rays[i].direction));
        const auto shade = static_cast<std::uint8_t>(40 + 200 * facing);
        picture.pixels[i] = {shade, shade, shade};
        ++seen;
    }
    save_png(file, picture);
    std::printf("%s: %zu triangles, %zu of %zu rays hit\n", file, index.size(), seen, rays.size());
    return seen > rays.size() / 2 ? 0 : 1;
}
