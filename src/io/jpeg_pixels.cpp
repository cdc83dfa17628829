/// JPEG through the TurboJPEG interface of libjpeg-turbo, which reports by return values.
#include <turbojpeg.h>

#include <memory>

#include "pixels.h"

namespace hedgerow::detail {

namespace {

[[noreturn]] void fail_jpeg(const ImageBytes& image, tjhandle decoder) {
    image.fail(std::string("is not a sound JPEG image (") + tjGetErrorStr2(decoder) +
               "). Fetch or write it again");
}

/// Whether the decoder stopped at bytes between two markers that belong to neither. Some cameras write them,
/// and they do no harm.
bool is_harmless(tjhandle decoder) {
    return tjGetErrorCode(decoder) == TJERR_WARNING &&
           std::string_view(tjGetErrorStr2(decoder)).find("extraneous bytes") != std::string_view::npos;
}

}  // namespace

bool is_jpeg(std::string_view bytes) {
    return bytes.starts_with("\xFF\xD8\xFF");
}

Pixels decode_jpeg(const ImageBytes& image) {
    const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
    if (!decoder) throw std::bad_alloc();
    // Read the header.
    const auto* const bytes = reinterpret_cast<const unsigned char*>(image.bytes.data());
    const auto size = static_cast<unsigned long>(image.bytes.size());
    int width = 0, height = 0, subsampling = 0, space = 0;
    if (tjDecompressHeader3(decoder.get(), bytes, size, &width, &height, &subsampling, &space) != 0 &&
        !is_harmless(decoder.get()))
        fail_jpeg(image, decoder.get());
    if (width <= 0 || height <= 0)  // no error: a JPEG file may have tables alone
        image.fail("is not a sound JPEG image (it has no picture). Fetch or write it again");
    if (space == TJCS_CMYK || space == TJCS_YCCK)
        image.fail("is a JPEG image in CMYK, which is made for printing. Write it as RGB");
    // Decode it whole. The scans are limited because a small progressive file can have very many.
    const int channels = space == TJCS_GRAY ? 1 : 3;
    Pixels pixels = make_pixels<std::uint8_t>(image, static_cast<std::uint64_t>(width),
                                              static_cast<std::uint64_t>(height), channels);
    unsigned char* const samples = std::get<std::vector<std::uint8_t>>(pixels.samples).data();
    const auto decode = [&](int flags) {
        return tjDecompress2(decoder.get(), bytes, size, samples, width, 0, height,
                             channels == 1 ? TJPF_GRAY : TJPF_RGB,
                             TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | flags) == 0;
    };
    if (decode(TJFLAG_STOPONWARNING)) return pixels;
    if (!is_harmless(decoder.get())) fail_jpeg(image, decoder.get());
    if (!decode(0) && !is_harmless(decoder.get())) fail_jpeg(image, decoder.get());
    return pixels;
}

}  // namespace hedgerow::detail
