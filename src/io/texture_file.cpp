/// Chooses the decoder of an image by its first bytes.
#include <hedgerow/io/texture_file.h>

#include "byte_source.h"
#include "file_bytes.h"
#include "pixels.h"
#include "text.h"

namespace hedgerow {

namespace {

struct Decoder {
    bool (*knows)(std::string_view bytes);
    Pixels (*decode)(const detail::ImageBytes& image);
};

constexpr Decoder decoders[] = {{detail::is_png, detail::decode_png},
                                {detail::is_jpeg, detail::decode_jpeg},
                                {detail::is_hdr, detail::decode_hdr},
                                {detail::is_exr, detail::decode_exr}};

}  // namespace

Pixels decode_pixels(std::string_view bytes, const std::string& name, const PixelLimits& limits) {
    const detail::ImageBytes image{bytes, name, limits};
    for (const Decoder& decoder : decoders)
        if (decoder.knows(bytes)) return detail::within_memory(name, [&] { return decoder.decode(image); });
    image.fail("begins with " + detail::shown(bytes.substr(0, 12)) +
               ", as no PNG, JPEG, Radiance HDR or OpenEXR image does. Convert it to one of these");
}

Pixels load_pixels(const std::filesystem::path& path, const PixelLimits& limits) {
    const detail::FileBytes file = detail::mapped_file(path);
    return decode_pixels({reinterpret_cast<const char*>(file.data), file.size}, path.string(), limits);
}

Environment load_environment(const std::filesystem::path& path, const PixelLimits& limits) {
    Environment environment;
    environment.panorama.name = path.string();
    environment.panorama.pixels = std::make_shared<const Pixels>(load_pixels(path, limits));
    environment.panorama.space = ColourSpace::srgb;
    return environment;
}

}  // namespace hedgerow
