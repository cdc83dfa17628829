/// Radiance pictures (Ward, "Real Pixels", Graphics Gems II, 1991; the run-length encodings and the header
/// are those of Radiance's reference manual, "Picture file format").
#include <algorithm>
#include <array>
#include <cmath>

#include "pixels.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

using HdrPixel = std::array<std::uint8_t, 4>;

class HdrReader {
public:
    explicit HdrReader(const ImageBytes& image) : image_(image), left_(image.bytes) {}

    Pixels read() {
        read_header();
        read_size();
        Pixels pixels = make_pixels<float>(image_, width(), height(), 3);
        auto& samples = std::get<std::vector<float>>(pixels.samples);
        std::vector<HdrPixel> line(across_.count);
        for (std::uint64_t i = 0; i < down_.count; ++i) {
            read_line(line, i);
            for (std::uint64_t k = 0; k < across_.count; ++k) {
                const std::uint64_t x = is_sideways_ ? down_.at(i) : across_.at(k);
                const std::uint64_t y = is_sideways_ ? across_.at(k) : down_.at(i);
                store(line[static_cast<std::size_t>(k)],
                      &samples[static_cast<std::size_t>(3 * (y * width() + x))]);
            }
        }
        return pixels;
    }

private:
    /// One of the two directions of a picture.
    struct Direction {
        std::uint64_t count = 0;
        bool backwards = false;  ///< from the right, or from the bottom
        std::uint64_t at(std::uint64_t i) const { return backwards ? count - 1 - i : i; }
    };

    std::uint64_t width() const { return is_sideways_ ? down_.count : across_.count; }
    std::uint64_t height() const { return is_sideways_ ? across_.count : down_.count; }

    std::string_view text_line() {
        const auto end = left_.find('\n');
        if (end == left_.npos) image_.fail("ends in its header. Fetch it again");
        const std::string_view line = trimmed(left_.substr(0, end));
        left_.remove_prefix(end + 1);
        return line;
    }
    void read_header() {
        text_line();  // "#?RADIANCE", or another program's name
        double exposure = 1;
        for (std::string_view line = text_line(); !line.empty(); line = text_line()) {
            if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
                image_.fail("is of the format " + shown(line.substr(7)) +
                            ", but only 32-bit_rle_rgbe is read. Convert it (ra_xyze -r, for one)");
            if (line.starts_with("EXPOSURE=")) {
                const auto factor = parse_real<double>(trimmed(line.substr(9)));
                if (!factor || !(*factor > 0) || !std::isfinite(*factor))
                    image_.fail("has an exposure of " + shown(line.substr(9)) +
                                ", which is no positive number. Repair its header");
                exposure *= *factor;
            }
        }
        per_exposure_ = 1 / exposure;
    }
    /// Reads a line such as "-Y 480 +X 640": 480 lines from the top, each from left to right.
    void read_size() {
        std::string_view line = text_line();
        const auto direction = [&, whole = line](Direction& to) {
            const std::string_view name = take_word(line), number = take_word(line);
            const auto count = parse_integer<std::uint64_t>(number);
            if (!count || name.size() != 2 || (name[0] != '+' && name[0] != '-') ||
                (name[1] != 'X' && name[1] != 'Y'))
                image_.fail(shown(whole) +
                            " where its size should stand, such as '-Y 480 +X 640'. Fetch it again");
            to.count = *count;
            to.backwards = (name[0] == '-') == (name[1] == 'X');  // y counts from the bottom
            return name[1];
        };
        const char first = direction(down_), second = direction(across_);
        if (first == second) image_.fail("has a size in " + std::string(1, first) + " alone. Fetch it again");
        is_sideways_ = first == 'X';
    }

    std::uint8_t byte() {
        if (left_.empty()) image_.fail("ends in its pixels. It was cut off: fetch it again");
        const auto value = static_cast<std::uint8_t>(left_.front());
        left_.remove_prefix(1);
        return value;
    }
    void read_line(std::vector<HdrPixel>& line, std::uint64_t number) {
        HdrPixel first{byte(), byte(), byte(), byte()};
        const std::size_t size = line.size();
        const bool in_planes = size >= 8 && size < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!in_planes) return read_flat(line, first);
        if (static_cast<std::size_t>(first[2]) * 256 + first[3] != size)
            image_.fail("line " + std::to_string(number) +
                        " of its pixels has a length of its own. Fetch it again");
        for (std::size_t plane = 0; plane < 4; ++plane) read_plane(line, plane);
    }
    /// One byte of all pixels, in runs (more than 128: so many of one value, less 128) and literal bytes.
    void read_plane(std::vector<HdrPixel>& line, std::size_t plane) {
        for (std::size_t i = 0; i < line.size();) {
            const std::size_t code = byte(), count = code > 128 ? code - 128 : code;
            if (count == 0 || count > line.size() - i)
                image_.fail("has a run of " + std::to_string(count) + " pixels where " +
                            std::to_string(line.size() - i) + " are left in the line. Fetch it again");
            const bool is_run = code > 128;
            const std::uint8_t value = is_run ? byte() : std::uint8_t(0);
            for (std::size_t k = 0; k < count; ++k) line[i++][plane] = is_run ? value : byte();
        }
    }
    /// Whole pixels. One of (1, 1, 1, n) repeats the pixel before it n times; several in a row are the digits
    /// of one number, the lowest first.
    void read_flat(std::vector<HdrPixel>& line, HdrPixel pixel) {
        std::size_t i = 0;
        int shift = 0;
        while (true) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                const std::uint64_t count = shift < 32 ? std::uint64_t(pixel[3]) << shift : line.size() + 1;
                if (i == 0 || count > line.size() - i)
                    image_.fail("repeats a pixel beyond its line. Fetch it again");
                std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(i), count, line[i - 1]);
                i += static_cast<std::size_t>(count);
                shift += 8;
            } else {
                line[i++] = pixel;
                shift = 0;
            }
            if (i == line.size()) return;
            pixel = {byte(), byte(), byte(), byte()};
        }
    }
    void store(const HdrPixel& pixel, float* to) const {
        const double unit = pixel[3] == 0 ? 0 : std::ldexp(per_exposure_, pixel[3] - 136);
        for (std::size_t k = 0; k < 3; ++k) to[k] = usable(rounded<float>(pixel[k] * unit));
    }

    const ImageBytes& image_;
    std::string_view left_;
    double per_exposure_ = 1;
    Direction down_, across_;   // from line to line, and along a line
    bool is_sideways_ = false;  // lines are columns
};

}  // namespace

bool is_hdr(std::string_view bytes) {
    return bytes.starts_with("#?");
}

Pixels decode_hdr(const ImageBytes& image) {
    return HdrReader(image).read();
}

}  // namespace hedgerow::detail
