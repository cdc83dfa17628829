/// A chart of 24 colours, and images of it that are made without the library.
#pragma once

#include <turbojpeg.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace hedgerow::testing_chart {

using Colour = std::array<std::uint8_t, 3>;

/// The patches of a common chart of 4 rows of 6 colours, in sRGB.
inline constexpr std::array<Colour, 24> patches = {
    {{115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
     {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
     {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
     {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}}};
inline constexpr int columns = 6, rows = 4;

/// The linear value of a component, by the formula of IEC 61966-2-1.
inline float linear(std::uint8_t encoded) {
    const double x = encoded / 255.0;
    return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

inline std::string big_endian(std::uint32_t x) {
    return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
            static_cast<char>(x)};
}

/// A chunk of a PNG file.
inline std::string png_chunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(data.size())) + body +
           big_endian(static_cast<std::uint32_t>(sum));
}

/// A PNG file. `type` is 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA; `lines` are the bytes of all
/// rows, `row` bytes each; `more` are chunks before the pixels.
inline std::string png(std::uint32_t width, std::uint32_t height, int bits, int type,
                       const std::string& lines, std::size_t row, const std::string& more = "",
                       bool interlaced = false) {
    std::string filtered;
    for (std::size_t at = 0; at < lines.size(); at += row) filtered += '\0' + lines.substr(at, row);
    uLongf size = compressBound(static_cast<uLong>(filtered.size()));
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(filtered.data()),
             static_cast<uLong>(filtered.size()));
    packed.resize(size);
    const std::string kind{static_cast<char>(bits), static_cast<char>(type), 0, 0,
                           static_cast<char>(interlaced)};
    return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big_endian(width) + big_endian(height) + kind) + more +
           png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

/// The chart as a PNG file of 6 × 4 pixels, of 8 or 16 bits.
inline std::string png_chart(int bits = 8) {
    std::string lines;
    for (const Colour& c : patches)
        for (const std::uint8_t x : c)
            lines += std::string(static_cast<std::size_t>(bits / 8), static_cast<char>(x));
    return png(columns, rows, bits, 2, lines, lines.size() / rows);
}

inline std::string text_of(std::initializer_list<int> bytes) {
    std::string text;
    for (const int b : bytes) text += static_cast<char>(b);
    return text;
}

/// A JPEG file of the chart, with patches of 16 × 16 pixels.
inline std::string jpeg_chart(int subsampling = TJSAMP_444, int flags = 0, int format = TJPF_RGB) {
    constexpr int size = 16, width = size * columns, height = size * rows;
    std::string lines;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Colour& c = patches[static_cast<std::size_t>(y / size * columns + x / size)];
            if (format == TJPF_GRAY)
                lines += static_cast<char>(c[1]);
            else
                for (const std::uint8_t k : c) lines += static_cast<char>(k);
            if (format == TJPF_CMYK) lines += static_cast<char>(255);
        }
    tjhandle encoder = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long length = 0;
    tjCompress2(encoder, reinterpret_cast<const unsigned char*>(lines.data()), width, 0, height, format,
                &bytes, &length, subsampling, 100, flags);
    const std::string file(reinterpret_cast<const char*>(bytes), length);
    tjFree(bytes);
    tjDestroy(encoder);
    return file;
}

/// An HDR file of these pixels, and what follows the header of another.
inline std::string hdr(const std::string& size, const std::string& pixels, const std::string& lines = "") {
    return "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n" + size + "\n" + pixels;
}

}  // namespace hedgerow::testing_chart
