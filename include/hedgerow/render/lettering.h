/// Draws text on images.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/io/image.h>

namespace hedgerow {

/// Glyphs of the ASCII characters from the blank to the tilde: 12 rows of 5 dots from the top left, lowest
/// bits first. The font is 6x13 of the X Window System's misc-fixed fonts, which are in the public domain.
inline constexpr std::uint64_t letters[95] = {
    0x000000000000000, 0x000802108421080, 0x000000000052940, 0x0000a57d5f52800, 0x0008fa51c52f880,
    0x001355088855640, 0x002c9c944528800, 0x000000000021080, 0x020841084211088, 0x008844210841082,
    0x000000009575480, 0x00000213e420000, 0x0088c0000000000, 0x00000003e000000, 0x011c40000000000,
    0x000211088844200, 0x0008a8c6318a880, 0x003e42108429880, 0x003e1111108c5c0, 0x001d1841c4443e0,
    0x00108fa54a62100, 0x001d18426d087e0, 0x001d18c5e10c5c0, 0x0004211088443e0, 0x001d18c5d18c5c0,
    0x001d1843d18c5c0, 0x011c40008e20000, 0x0088c0008e20000, 0x002082082222200, 0x00000f801f00000,
    0x000222220820820, 0x00080211108c5c0, 0x003c16d6b98c5c0, 0x002318fe318a880, 0x001f2949d2949e0,
    0x001d1084210c5c0, 0x001f294a52949e0, 0x003e1085e1087e0, 0x00021085e1087e0, 0x001d18e4210c5c0,
    0x002318c7f18c620, 0x001c421084211c0, 0x000c94210842380, 0x00231494654c620, 0x003e10842108420,
    0x002318c6b5dc620, 0x00231ce6b59ce20, 0x001d18c6318c5c0, 0x00021085f18c5e0, 0x041d58c6318c5c0,
    0x00231495f18c5e0, 0x001d1841c10c5c0, 0x0008421084213e0, 0x001d18c6318c620, 0x00084529518c620,
    0x00155ad6b18c620, 0x002315288a54620, 0x000842108a54620, 0x003e110888443e0, 0x03842108421084e,
    0x002104208210420, 0x03908421084210e, 0x00000000008a880, 0x07c000000000000, 0x000000000000104,
    0x002d98fa0e00000, 0x001f18c62f08420, 0x001d10862e00000, 0x003d18c63e84200, 0x001d10fe2e00000,
    0x00042109e214980, 0x7461e8c62e00000, 0x002318c66d08420, 0x001c42108601000, 0x325284210c02000,
    0x0022928ca908420, 0x001c421084210c0, 0x00235ad6ab00000, 0x002318c66d00000, 0x001d18c62e00000,
    0x0842f8c62f00000, 0x8421e8c63e00000, 0x000210866d00000, 0x001d141a2e00000, 0x001921084f10800,
    0x002d98c63100000, 0x0008a5463100000, 0x00155ad63100000, 0x0022a2115100000, 0x74616cc63100000,
    0x003e11111f00000, 0x060842106421098, 0x000842108421080, 0x00c842130421083, 0x00000000004d640};

/// Dots that a letter takes, with the space around it.
inline constexpr int letter_width = 6, letter_height = 13;

/// Draws a line of text with its upper left corner at (x, y), `scale` pixels a dot. Draws only what fits.
/// Bytes that are not printable ASCII appear as question marks.
inline void draw_text(Image& image, int x, int y, std::string_view text, const Image::Pixel& colour,
                      int scale = 1) {
    for (const char c : text) {
        const std::uint64_t dots = letters[c >= ' ' && c <= '~' ? c - ' ' : '?' - ' '];
        for (int dot = 0; dot < 60; ++dot) {
            if (!(dots >> dot & 1)) continue;
            for (int k = 0; k < scale * scale; ++k) {
                const int px = x + dot % 5 * scale + k % scale, py = y + (dot / 5 + 1) * scale + k / scale;
                if (px >= 0 && py >= 0 && px < image.width && py < image.height) image.at(px, py) = colour;
            }
        }
        x += letter_width * scale;
    }
}

/// Draws light lines of text on a dark background whose upper left corner is (x, y).
inline void draw_note(Image& image, int x, int y, const std::vector<std::string>& lines, int scale = 1) {
    std::size_t longest = 0;
    for (const auto& line : lines) longest = std::max(longest, line.size());
    const int width = (static_cast<int>(longest) * letter_width + 8) * scale,
              height = (static_cast<int>(lines.size()) * letter_height + 4) * scale;
    for (int py = std::max(0, y); py < std::min(image.height, y + height); ++py)
        for (int px = std::max(0, x); px < std::min(image.width, x + width); ++px)
            image.at(px, py) = {12, 12, 16};
    for (const auto& line : lines) {
        draw_text(image, x + 4 * scale, y + scale, line, {235, 235, 240}, scale);
        y += letter_height * scale;
    }
}

}  // namespace hedgerow
