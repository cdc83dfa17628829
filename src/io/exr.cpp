/// EXR through OpenEXR, a scan line at a time.
#include <hedgerow/io/exr.h>

#include <hedgerow/base/error.h>

#ifndef HEDGEROW_HAS_EXR
#define HEDGEROW_HAS_EXR 1
#endif

#if HEDGEROW_HAS_EXR
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cctype>
#include <cstring>
#include <set>

#include "check_notes.h"
#include "image_size.h"
#include "output_file.h"
#endif

namespace hedgerow {

#if HEDGEROW_HAS_EXR
namespace {

void check(const std::filesystem::path& path, const Layers& layers) {
    if (layers.channels.empty())
        throw InputError(path.string() + ": an image without channels cannot be saved. Give it some");
    std::set<std::string> names;
    for (const auto& [name, values] : layers.channels) {
        if (name.empty() || name.size() > 255 || name.find('\0') != std::string::npos)
            throw InputError(path.string() + ": the name of channel " + std::to_string(names.size() + 1) +
                             " is empty, longer than 255 bytes or has a zero byte. Give it another");
        if (!names.insert(name).second)
            throw InputError(path.string() + ": two channels are named \"" + name +
                             "\". Give each a name of its own");
        const std::size_t count = std::visit([](const auto& v) { return v.size(); }, values);
        detail::expect_pixels(path, layers.width, layers.height, count, "values of " + name);
    }
}

/// Lets OpenEXR write to an OutputFile.
class Stream : public Imf::OStream {
public:
    explicit Stream(detail::OutputFile& file) : OStream(""), file_(file) {}
    void write(const char* bytes, int count) override {
        file_.write({bytes, static_cast<std::size_t>(count)});
    }
    std::uint64_t tellp() override { return file_.tell(); }
    void seekp(std::uint64_t place) override { file_.seek(place); }

private:
    detail::OutputFile& file_;
};

/// One row of every channel, refilled for each scan line.
class Row {
public:
    explicit Row(const Layers& layers) : layers_(layers), width_(static_cast<std::size_t>(layers.width)) {
        bytes_.resize(layers.channels.size() * width_ * value_size);
    }
    static Imf::PixelType type_of(const Channel& channel) {
        return std::holds_alternative<Strided<float>>(channel.values) ? Imf::FLOAT : Imf::UINT;
    }
    /// Describes the row to OpenEXR. The step between scan lines is 0, so every scan line is read from this
    /// row.
    Imf::FrameBuffer buffer() {
        Imf::FrameBuffer buffer;
        char* first = bytes_.data();
        for (const Channel& channel : layers_.channels) {
            buffer.insert(channel.name, Imf::Slice(type_of(channel), first, value_size, 0));
            first += width_ * value_size;
        }
        return buffer;
    }
    void fill(int y) {
        char* to = bytes_.data();
        const std::size_t begin = static_cast<std::size_t>(y) * width_;
        const auto copy = [&](const auto& values) {
            for (std::size_t i = begin; i < begin + width_; ++i, to += value_size) {
                const auto value = values[i];
                std::memcpy(to, &value, value_size);
            }
        };
        for (const Channel& channel : layers_.channels) std::visit(copy, channel.values);
    }

private:
    static constexpr std::size_t value_size = 4;

    const Layers& layers_;
    std::size_t width_;
    std::vector<char> bytes_;
};

/// The header, without channels.
Imf::Header header_of(const std::filesystem::path& path, const Layers& layers, const Notes& notes) {
    Imf::Header header(layers.width, layers.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Note& note : notes) {
        std::string name = note.word;
        for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (header.find(name) != header.end())
            throw InputError(path.string() + ": the word \"" + note.word +
                             "\" of a note is used twice, or is one of OpenEXR's own. Choose another");
        header.insert(name, Imf::StringAttribute(note.text));
    }
    return header;
}

void write(detail::OutputFile& file, Imf::Header header, const Layers& layers) {
    for (const Channel& channel : layers.channels)
        header.channels().insert(channel.name, Imf::Channel(Row::type_of(channel)));
    Stream stream(file);
    Imf::OutputFile image(stream, header);
    Row row(layers);
    const auto width = static_cast<std::uint64_t>(layers.width);
    file.expect(width * static_cast<std::uint64_t>(layers.height));
    image.setFrameBuffer(row.buffer());
    for (int y = 0; y < layers.height; ++y) {
        row.fill(y);
        image.writePixels();
        file.advance(width);
    }
}

}  // namespace

void save_exr(const std::filesystem::path& path, const Layers& layers, const Progress& progress,
              const Notes& notes) {
    check(path, layers);
    detail::check_notes(path, notes);
    const Imf::Header header = header_of(path, layers, notes);
    detail::OutputFile file(path, progress);
    try {
        write(file, header, layers);
    } catch (const Iex::BaseExc& error) {
        throw OutputError(path.string() + ": cannot be written (" + error.what() +
                          "). Check the folder, its permissions and the space left");
    }
    file.commit();
}

bool exr_supported() {
    return true;
}
#else
void save_exr(const std::filesystem::path& path, const Layers&, const Progress&, const Notes&) {
    throw InputError(path.string() +
                     ": this build has no OpenEXR: build with HEDGEROW_EXR=ON, or save a PNG");
}

bool exr_supported() {
    return false;
}
#endif

}  // namespace hedgerow
