/// PNG through libpng's full interface: its simplified one would convert colours. libpng reports errors by
/// longjmp, so nothing that a jump leaves may have a destructor.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "pixels.h"

namespace hedgerow::detail {

namespace {

class PngReader {
public:
    explicit PngReader(const ImageBytes& image) : image_(image), left_(image.bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    Pixels read() {
        guarded([this] { read_header(); });
        check_header();
        guarded([this] { start(); });
        return bits_ == 16 ? read_samples<std::uint16_t>() : read_samples<std::uint8_t>();
    }

private:
    /// Calls f. An error of libpng inside of it becomes an InputError. f may have no variables with
    /// destructors.
    template <class F>
    void guarded(F f) {
        if (setjmp(png_jmpbuf(png_)) != 0)
            image_.fail(std::string("is not a sound PNG image (") + message_ + "). Fetch or write it again");
        f();
    }
    [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
        auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
        std::strncpy(reader.message_, message, sizeof reader.message_ - 1);
        png_longjmp(png, 1);
    }
    static void on_warning(png_structp, png_const_charp) {}
    static void on_read(png_structp png, png_bytep to, std::size_t size) {
        auto& left = static_cast<PngReader*>(png_get_io_ptr(png))->left_;
        if (size > left.size()) png_error(png, "it ends early");
        std::memcpy(to, left.data(), size);
        left.remove_prefix(size);
    }

    void read_header() {
        png_set_read_fn(png_, this, on_read);
        png_set_user_limits(png_, 0x7FFFFFFF, 0x7FFFFFFF);  // check_header has limits of its own
        png_read_info(png_, info_);
        width_ = png_get_image_width(png_, info_);
        height_ = png_get_image_height(png_, info_);
    }
    /// Refuses sizes before libpng takes memory for rows.
    void check_header() const {
        check_promised(image_, width_, height_, 1);
        // Deflate packs at most 1032 to 1.
        if (png_get_rowbytes(png_, info_) * std::uint64_t(height_) >
            std::uint64_t(image_.bytes.size()) * 1032)
            image_.fail("promises " + std::to_string(width_) + "x" + std::to_string(height_) +
                        " pixels, which " + std::to_string(image_.bytes.size()) +
                        " bytes cannot hold. Fetch it again");
    }
    void start() {
        png_set_expand(png_);  // palettes, few bits and transparent colours
        if (std::endian::native == std::endian::little) png_set_swap(png_);
        passes_ = png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        bits_ = png_get_bit_depth(png_, info_);
        channels_ = png_get_channels(png_, info_);
    }
    template <class U>
    Pixels read_samples() {
        Pixels pixels = make_pixels<U>(image_, width_, height_, channels_);
        U* const samples = std::get<std::vector<U>>(pixels.samples).data();
        guarded([&] {
            for (int pass = 0; pass < passes_; ++pass)
                for (png_uint_32 y = 0; y < height_; ++y)
                    png_read_row(png_, reinterpret_cast<png_bytep>(samples + row_size() * y), nullptr);
            png_read_end(png_, nullptr);
        });
        return pixels;
    }
    /// Samples of a row.
    std::size_t row_size() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
    }

    const ImageBytes& image_;
    std::string_view left_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    char message_[160] = {};
    png_uint_32 width_ = 0, height_ = 0;
    int bits_ = 0, channels_ = 0, passes_ = 0;
};

}  // namespace

bool is_png(std::string_view bytes) {
    return bytes.starts_with("\x89PNG");
}

Pixels decode_png(const ImageBytes& image) {
    return PngReader(image).read();
}

}  // namespace hedgerow::detail
