/// PLY headers, line by line.
#include "ply_header.h"

#include <array>
#include <utility>

#include "text_source.h"

namespace hedgerow::detail {

namespace {

constexpr std::pair<std::string_view, PlyType> type_names[] = {
    {"char", PlyType::i1},   {"int8", PlyType::i1},   {"uchar", PlyType::u1},  {"uint8", PlyType::u1},
    {"short", PlyType::i2},  {"int16", PlyType::i2},  {"ushort", PlyType::u2}, {"uint16", PlyType::u2},
    {"int", PlyType::i4},    {"int32", PlyType::i4},  {"uint", PlyType::u4},   {"uint32", PlyType::u4},
    {"int64", PlyType::i8},  {"uint64", PlyType::u8}, {"float", PlyType::f4},  {"float32", PlyType::f4},
    {"double", PlyType::f8}, {"float64", PlyType::f8}};

/// Reads the lines of one header.
class HeaderReader {
public:
    explicit HeaderReader(ByteSource& file) : file_(file), lines_(file) {}

    PlyHeader read() {
        std::string line;
        if (!file_.ahead().starts_with("ply"))
            file_.fail("does not begin with 'ply', so it is no PLY file. Check the extension");
        bool has_format = false;
        for (next(line); next(line);) {
            rest_ = line;
            const std::string_view word = take_word(rest_);
            if (word == "end_header") {
                if (!has_format) fail("has no line 'format'");
                return std::move(header_);
            }
            if (word == "format")
                read_format(), has_format = true;
            else if (word == "element")
                read_element();
            else if (word == "property")
                read_property();
            else if (word == "comment")
                read_comment();
            else if (word != "obj_info" && !word.empty())
                fail("cannot be understood: " + shown(line));
        }
        fail("is missing: the header has no 'end_header'");
    }

private:
    static constexpr std::uint64_t most_lines = 65536;

    bool next(std::string& line) {
        if (++header_.lines > most_lines)
            file_.fail("the header has more than " + std::to_string(most_lines) +
                       " lines. Is this a PLY file?");
        return lines_.next(line);
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(header_.lines) + " of the header " + what +
                   ". Was the file cut off or altered?");
    }
    void read_format() {
        const std::string_view name = take_word(rest_), version = take_word(rest_);
        if (name == "ascii")
            header_.encoding = PlyEncoding::ascii;
        else if (name == "binary_little_endian")
            header_.encoding = PlyEncoding::little;
        else if (name == "binary_big_endian")
            header_.encoding = PlyEncoding::big;
        else
            fail("says format " + shown(name) +
                 "; known are ascii, binary_little_endian and binary_big_endian");
        if (version != "1.0") fail("says version " + shown(version) + "; only 1.0 is known");
    }
    void read_comment() {
        if (take_word(rest_) == "TextureFile") header_.textures.emplace_back(trimmed(rest_));
    }
    void read_element() {
        PlyElement element;
        element.name = take_word(rest_);
        const std::string_view number = take_word(rest_);
        const auto count = parse_integer<std::uint64_t>(number);
        if (!count) fail("says that there are " + shown(number) + " of " + shown(element.name));
        if (header_.find(element.name) != nullptr) fail("declares " + shown(element.name) + " again");
        element.count = *count;
        header_.elements.push_back(std::move(element));
    }
    void read_property() {
        if (header_.elements.empty()) fail("has a property before any element");
        PlyProperty property;
        std::string_view word = take_word(rest_);
        if (word == "list") {
            property.count = type(take_word(rest_));
            if (*property.count >= PlyType::f4) fail("counts a list with a floating-point number");
            word = take_word(rest_);
        }
        property.type = type(word);
        property.name = take_word(rest_);
        if (property.name.empty()) fail("names no property");
        header_.elements.back().properties.push_back(std::move(property));
    }
    PlyType type(std::string_view name) const {
        for (const auto& [known, type] : type_names)
            if (name == known) return type;
        fail("has a property of unknown type " + shown(name));
    }

    ByteSource& file_;
    LineSource lines_;
    PlyHeader header_;
    std::string_view rest_;
};

}  // namespace

const PlyElement* PlyHeader::find(std::string_view name) const {
    for (const PlyElement& e : elements)
        if (e.name == name) return &e;
    return nullptr;
}

bool PlyHeader::is_cloud() const {
    const auto* const faces = find("face");
    const auto* const vertices = find("vertex");
    const bool points = vertices != nullptr && vertices->count > 0;
    return points && (faces == nullptr || faces->count == 0) && find("tristrips") == nullptr;
}

PlyHeader read_ply_header(ByteSource& file) {
    return HeaderReader(file).read();
}

}  // namespace hedgerow::detail
