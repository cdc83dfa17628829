/// OpenEXR images as pixels, a line at a time.
#include "pixels.h"

#ifndef HEDGEROW_HAS_EXR
#define HEDGEROW_HAS_EXR 1
#endif

#if HEDGEROW_HAS_EXR
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "little.h"
#include "text.h"
#endif

namespace hedgerow::detail {

bool is_exr(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

#if HEDGEROW_HAS_EXR
namespace {

/// The inclusive corners of a window, which are far apart in a damaged file.
struct ExrWindow {
    std::int64_t left = 0, top = 0, right = -1, bottom = -1;

    std::uint64_t width() const { return right < left ? 0 : static_cast<std::uint64_t>(right - left + 1); }
    std::uint64_t height() const { return bottom < top ? 0 : static_cast<std::uint64_t>(bottom - top + 1); }
};

/// Checks what an image promises in its header before OpenEXR takes memory for it: the windows, and the size
/// of its tiles. The header is a list of attributes: name, type, size and value ("OpenEXR File Layout",
/// openexr.com/en/latest/OpenEXRFileLayout.html).
class ExrHeaderCheck {
public:
    explicit ExrHeaderCheck(const ImageBytes& image) : image_(image), left_(image.bytes) {}

    void run() {
        const std::uint32_t version = little<std::uint32_t>(take(8).data() + 4);
        if ((version & 0x1800) != 0)
            image_.fail("is an EXR image of several parts or with deep pixels. Write it as one flat part");
        for (std::string_view name = text(); !name.empty(); name = text()) {
            text();  // the type
            const std::string_view value = take(little<std::uint32_t>(take(4).data()));
            if ((name == "dataWindow" || name == "displayWindow") && value.size() == 16) check_window(value);
            if (name == "tiles" && value.size() >= 8)
                check_promised(image_, little<std::uint32_t>(value.data()),
                               little<std::uint32_t>(value.data() + 4), most_bytes_a_pixel);
        }
    }

private:
    static constexpr std::uint64_t most_bytes_a_pixel = 16;

    void check_window(std::string_view value) const {
        const auto number = [&](std::size_t i) -> std::int64_t {
            return little<std::int32_t>(value.data() + 4 * i);
        };
        const ExrWindow window{number(0), number(1), number(2), number(3)};
        check_promised(image_, window.width(), window.height(), most_bytes_a_pixel);
    }
    std::string_view take(std::size_t size) {
        if (size > left_.size()) image_.fail("ends in its header. It was cut off: fetch it again");
        const std::string_view taken = left_.substr(0, size);
        left_.remove_prefix(size);
        return taken;
    }
    std::string_view text() {
        const auto end = left_.find('\0');
        if (end == left_.npos) image_.fail("ends in its header. It was cut off: fetch it again");
        return take(end + 1).substr(0, end);
    }

    const ImageBytes& image_;
    std::string_view left_;
};

/// Lets OpenEXR read from memory.
class ExrStream : public Imf::IStream {
public:
    explicit ExrStream(const ImageBytes& image) : IStream(""), bytes_(image.bytes) {}
    bool read(char* to, int count) override {
        const auto size = static_cast<std::size_t>(count);
        if (count < 0 || at_ > bytes_.size() || size > bytes_.size() - at_)
            throw Iex::InputExc("it ends early");
        std::memcpy(to, bytes_.data() + at_, size);
        at_ += size;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t place) override { at_ = place; }

private:
    std::string_view bytes_;
    std::uint64_t at_ = 0;
};

/// The names of the channels that make a pixel: (Y) or (R, G, B), and A.
std::vector<std::string> wanted_channels(const ImageBytes& image, const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    if (channels.findChannel("R") != nullptr || channels.findChannel("G") != nullptr ||
        channels.findChannel("B") != nullptr)
        names = {"R", "G", "B"};
    else if (channels.findChannel("Y") != nullptr)
        names = {"Y"};
    if (names.empty()) {
        std::string there;
        for (auto i = channels.begin(); i != channels.end() && there.size() < 80; ++i)
            there += std::string(there.empty() ? "" : ", ") + shown(i.name());
        image.fail("has the channels " + there + ", but neither R, G and B nor Y. Write it with these");
    }
    if (channels.findChannel("A") != nullptr) names.emplace_back("A");
    for (const std::string& name : names) {
        const Imf::Channel* const channel = channels.findChannel(name);
        if (channel != nullptr && (channel->xSampling != 1 || channel->ySampling != 1))
            image.fail("has a channel " + name + " of fewer samples than pixels. Write it with all");
    }
    return names;
}

/// Samples as the library has them: finite, and colours not multiplied by the opacity.
void store_exr(const float* pixel, int channels, float* to) {
    const float alpha = channels % 2 == 0 ? usable(pixel[channels - 1]) : 1;
    for (int k = 0; k < channels; ++k) {
        const bool is_colour = channels % 2 != 0 || k < channels - 1;
        to[k] = usable(is_colour && alpha > 0 ? pixel[k] / alpha : pixel[k]);
    }
}

Pixels read_exr(const ImageBytes& image) {
    ExrStream stream(image);
    Imf::InputFile file(stream, 0);  // 0: no threads of its own
    const auto names = wanted_channels(image, file.header().channels());
    const auto &data = file.header().dataWindow(), &display = file.header().displayWindow();
    const auto size = [](int low, int high) {
        return static_cast<std::uint64_t>(std::int64_t(high) - low + 1);
    };
    const auto channels = static_cast<int>(names.size());
    Pixels pixels = make_pixels<float>(image, size(display.min.x, display.max.x),
                                       size(display.min.y, display.max.y), channels);
    auto& samples = std::get<std::vector<float>>(pixels.samples);

    // Describe one line of the data window, which all lines are read to.
    const std::uint64_t data_width = size(data.min.x, data.max.x);
    check_promised(image, data_width, 1, sizeof(float) * names.size());
    std::vector<float> line(static_cast<std::size_t>(data_width) * names.size());
    Imf::FrameBuffer buffer;
    const std::size_t step = sizeof(float) * names.size();
    for (std::size_t k = 0; k < names.size(); ++k) {
        // OpenEXR wants the address that the column 0 would have, wherever the window begins.
        char* const column_0 =
            reinterpret_cast<char*>(line.data() + k) - data.min.x * static_cast<std::ptrdiff_t>(step);
        buffer.insert(names[k], Imf::Slice(Imf::FLOAT, column_0, step, 0));
    }
    file.setFrameBuffer(buffer);
    // Copy what the display window shows of each line.
    const int left = std::max(data.min.x, display.min.x), right = std::min(data.max.x, display.max.x);
    for (int y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y); ++y) {
        file.readPixels(y);
        const std::size_t row =
            static_cast<std::size_t>(size(display.min.y, y) - 1) * static_cast<std::size_t>(pixels.width);
        for (int x = left; x <= right; ++x) {
            const auto from = static_cast<std::size_t>(size(data.min.x, x) - 1) * names.size();
            const auto to = (row + static_cast<std::size_t>(size(display.min.x, x) - 1)) * names.size();
            store_exr(&line[from], channels, &samples[to]);
        }
    }
    return pixels;
}

}  // namespace

Pixels decode_exr(const ImageBytes& image) {
    ExrHeaderCheck(image).run();
    try {
        return read_exr(image);
    } catch (const Iex::BaseExc& error) {
        image.fail(std::string("is not a sound EXR image (") + error.what() + "). Fetch or write it again");
    }
}
#else
Pixels decode_exr(const ImageBytes& image) {
    image.fail("this build has no OpenEXR: build with HEDGEROW_EXR=ON, or convert the image");
}
#endif

}  // namespace hedgerow::detail
