/// PNG through libpng: reading by its simplified interface, which reports by return values; writing row by
/// row, with notes.
#include <hedgerow/io/image.h>

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <hedgerow/base/error.h>

#include "byte_source.h"
#include "check_notes.h"
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

/// libpng's writer, freed whatever happens.
struct Writer {
    std::string message;  // of what went wrong
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, fail, [](png_structp, png_const_charp) {});
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);

    Writer() = default;
    ~Writer() { png_destroy_write_struct(&png, &info); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    [[noreturn]] static void fail(png_structp png, png_const_charp what) {
        *static_cast<std::string*>(png_get_error_ptr(png)) = what;
        png_longjmp(png, 1);
    }
};
// Where libpng jumps back to, nothing may wait to be destroyed: what has to be is the caller's. False if it
// failed.
bool write_png(const Writer& writer, const Image& image, std::vector<png_text>& texts,
               detail::OutputFile& file) {
    if (writer.info == nullptr || setjmp(png_jmpbuf(writer.png)) != 0) return false;
    png_init_io(writer.png, file.stream());
    const auto width = static_cast<png_uint_32>(image.width), height = static_cast<png_uint_32>(image.height);
    png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(writer.png, writer.info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(writer.png, writer.info);
    for (png_uint_32 y = 0; y < height; ++y) {
        png_write_row(writer.png, image.pixels[std::size_t(y) * width].data());
        file.advance(width);
    }
    png_write_end(writer.png, writer.info);
    return true;
}

}  // namespace

void save_png(const std::filesystem::path& path, const Image& image, const Progress& progress,
              const Notes& notes) {
    detail::expect_pixels(path, image.width, image.height, image.pixels.size(), "pixels");
    detail::check_notes(path, notes);
    std::vector<std::string> words, values;  // libpng takes them as not const
    for (const Note& note : notes) words.push_back(note.word), values.push_back(note.text);
    std::vector<png_text> texts(notes.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        texts[i].compression = PNG_ITXT_COMPRESSION_NONE;
        texts[i].key = words[i].data(), texts[i].text = values[i].data();
    }
    detail::OutputFile file(path, progress);
    file.expect(image.pixels.size());
    const Writer writer;
    if (!write_png(writer, image, texts, file))
        throw OutputError(path.string() + ": cannot be written (" + writer.message +
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
