/// What pictures of lines in space are drawn over.
#pragma once

#include <string>
#include <vector>

#include <hedgerow/any_index.h>
#include <hedgerow/render/render.h>
#include <hedgerow/render/wireframe.h>

#include "draw.h"

namespace hedgerow::cli {

/// The colour that "#rrggbb" names.
inline Image::Pixel pixel_of(const std::string& colour) {
    Image::Pixel p;
    for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<std::uint8_t>(std::stoi(colour.substr(1 + 2 * k, 2), nullptr, 16));
    return p;
}

/// A pale view of the scene, and the depth of its surface at each pixel.
struct Background {
    RayMaker maker;
    Image image;
    std::vector<float> surface;

    template <class T, class Seen>
    Background(const DrawArguments& a, const AnyIndex<T, 3>& index, const Seen& seen,
               const RenderOptions& options)
        : maker(options.camera, options.width, options.height) {
        ProgressLine line("casting rays", a.quiet, "rows");
        image = render(index, seen, by(interruptible_executor(), options), line.progress()).image;
        for (auto& pixel : image.pixels)
            for (auto& c : pixel) c = static_cast<std::uint8_t>(255 - (255 - c) * 9 / 20);
        surface = depths(index, maker, options.width, options.height, interruptible_executor());
    }
};

}  // namespace hedgerow::cli
