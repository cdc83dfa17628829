/// The layers of pictures by paths.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hedgerow/io/exr.h>
#include <hedgerow/render/integrators/path_picture.h>

namespace hedgerow::cli {

/// The channels of an .exr: linear light, its standard error and the number of samples, what is seen first;
/// direct and indirect light apart, if the picture keeps them, and light without noise, if there is some.
struct PathLayers {
    PathLayers(const PathPicture& picture, const std::vector<FirstSurface>& first_surfaces,
               const std::vector<Vec3f>& denoised)
        : light(picture.means()), layers{picture.width, picture.height, {}} {
        for (std::size_t i = 0; i < light.size(); ++i) {
            errors.push_back(picture.light.standard_error(i)), samples.push_back(picture.light.samples(i));
            if (picture.keeps_direct())
                direct.push_back(picture.direct.mean(i)), indirect.push_back(picture.indirect(i));
        }
        add({"R", "G", "B"}, light);
        add({"direct.R", "direct.G", "direct.B"}, direct);
        add({"indirect.R", "indirect.G", "indirect.B"}, indirect);
        layers.channels.push_back({"error", Strided<float>(errors.data(), errors.size(), sizeof(float))});
        add_ids("samples", samples, samples[0]);
        const FirstSurface& first = first_surfaces[0];
        add({"albedo.R", "albedo.G", "albedo.B"}, first_surfaces, first.albedo);
        add({"normal.X", "normal.Y", "normal.Z"}, first_surfaces, first.normal);
        for (std::size_t k = 0; k < 2; ++k)
            layers.channels.push_back(
                {std::array{"uv.U", "uv.V"}[k],
                 Strided<float>(&first.uv.data[k], first_surfaces.size(), sizeof(FirstSurface))});
        layers.channels.push_back(
            {"depth.Z", Strided<float>(&first.depth, first_surfaces.size(), sizeof(FirstSurface))});
        add_ids("id", first_surfaces, first.primitive);
        add_ids("instance", first_surfaces, first.instance);
        add({"denoised.R", "denoised.G", "denoised.B"}, denoised);
    }
    PathLayers(const PathLayers&) = delete;

    std::vector<Vec3f> light, direct, indirect;
    std::vector<float> errors;
    std::vector<std::uint32_t> samples;
    Layers layers;  // of these and of the first surfaces

private:
    void add(std::array<const char*, 3> names, const std::vector<Vec3f>& colours) {
        if (!colours.empty()) add(names, colours, colours[0]);
    }
    template <class Pixel>
    void add(std::array<const char*, 3> names, const std::vector<Pixel>& pixels, const Vec3f& first) {
        for (std::size_t k = 0; k < 3; ++k)
            layers.channels.push_back(
                {names[k], Strided<float>(&first.data[k], pixels.size(), sizeof(Pixel))});
    }
    template <class Pixel>
    void add_ids(const char* name, const std::vector<Pixel>& pixels, const std::uint32_t& first) {
        layers.channels.push_back({name, Strided<std::uint32_t>(&first, pixels.size(), sizeof(Pixel))});
    }
};

}  // namespace hedgerow::cli
