/// PNG through libpng's simplified interface, which reports by return values.
#include <hedgerow/io/image.h>

#include <png.h>

#include <cstring>
#include <memory>
#include <string>

#include <hedgerow/base/error.h>

#include "byte_source.h"
#include "image_size.h"
#include "output_file.h"

namespace hedgerow {

namespace {

/// libpng's handle, freed whatever happens.
struct Handle : png_image {
    Handle() : png_image() { version = PNG_IMAGE_VERSION; }
    ~Handle() { png_image_free(this); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
};

[[noreturn]] void fail_png(const std::string& name, const png_image& png) {
    throw InputError(name + ": is not a sound PNG image (" + png.message + "). Fetch or write it again");
}

}  // namespace

void save_png(const std::filesystem::path& path, const Image& image, const Progress& progress) {
    detail::expect_pixels(path, image.width, image.height, image.pixels.size(), "pixels");
    Handle png;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    detail::OutputFile file(path, progress);
    if (!png_image_write_to_stdio(&png, file.stream(), 0, image.pixels.data(), 0, nullptr))
        throw OutputError(path.string() + ": cannot be written (" + png.message +
                          "). Check the folder, its permissions and the space left");
    file.commit();
}

Image load_png(const std::filesystem::path& path) {
    detail::check_readable(path);
    const std::string name = path.string();
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) throw InputError(name + ": cannot be opened. Check its permissions");
    Handle png;
    if (!png_image_begin_read_from_stdio(&png, file.get())) fail_png(name, png);
    // Deflate packs at most 1032 to 1, and a pixel has at least a bit.
    const std::uint64_t most = std::uint64_t(std::filesystem::file_size(path)) * 1032 * 8;
    const std::uint64_t count = std::uint64_t(png.width) * png.height;
    if (count == 0 || count > most)
        throw InputError(name + ": promises " + std::to_string(png.width) + "x" + std::to_string(png.height) +
                         " pixels, which a file of this size cannot hold. Fetch it again");
    png.format = PNG_FORMAT_RGB;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height));
    if (!png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr)) fail_png(name, png);
    return image;
}

}  // namespace hedgerow
