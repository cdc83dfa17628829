/// The `.npy` format: a magic word, a Python dictionary, then the elements.
#include <algorithm>

#include "memory.h"
#include "npy_format.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

/// Parses {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }. Records have a list of fields for
/// their type: [('x', '<f4'), ('id', '<u4')].
class HeaderParser {
public:
    HeaderParser(const ByteSource& file, std::string_view text) : file_(file), rest_(text) {}

    NpyHeader parse() {
        bool has_type = false, has_order = false, has_shape = false;
        expect('{');
        while (!accept('}')) {
            const std::string_view key = string();
            expect(':');
            if (key == "descr")
                read_type(), has_type = true;
            else if (key == "fortran_order")
                header_.fortran = boolean(), has_order = true;
            else if (key == "shape")
                read_shape(), has_shape = true;
            else
                fail("has the unknown key " + shown(key));
            if (!accept(',') && !looking_at('}')) fail("lacks a comma");
        }
        if (!has_type || !has_order || !has_shape) fail("lacks one of 'descr', 'fortran_order' and 'shape'");
        return header_;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("the array's header " + what + ". Write the file again with numpy.save");
    }
    bool looking_at(char c) {
        while (!rest_.empty() && is_space(static_cast<unsigned char>(rest_.front()))) rest_.remove_prefix(1);
        return rest_.starts_with(c);
    }
    bool accept(char c) {
        if (!looking_at(c)) return false;
        rest_.remove_prefix(1);
        return true;
    }
    void expect(char c) {
        if (!accept(c)) fail(std::string("lacks a '") + c + "'");
    }
    std::string_view string() {
        const char quote = looking_at('"') ? '"' : '\'';
        expect(quote);
        const std::size_t end = rest_.find(quote);
        if (end == rest_.npos) fail("has a string without an end");
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text;
    }
    bool boolean() {
        looking_at(' ');  // skips white space
        for (const bool value : {false, true}) {
            const std::string_view word = value ? "True" : "False";
            if (!rest_.starts_with(word)) continue;
            rest_.remove_prefix(word.size());
            return value;
        }
        fail("says neither True nor False for 'fortran_order'");
    }
    void read_type() {
        if (!looking_at('[')) {
            header_.type = number_type();
            return;
        }
        expect('[');
        while (!accept(']')) {
            expect('(');
            const std::string name(string());
            expect(',');
            const NpyType type = number_type();
            accept(',');
            if (!accept(')')) fail("has records whose fields are more than numbers");
            header_.fields.push_back({name, type, header_.type.item});
            header_.type.item += type.item;
            if (!accept(',') && !looking_at(']')) fail("has records without commas");
        }
        if (header_.fields.empty()) fail("has records without fields");
    }
    NpyType number_type() {
        const std::string_view name = string();
        constexpr std::string_view known[] = {"b1", "i1", "i2", "i4", "i8", "u1",
                                              "u2", "u4", "u8", "f4", "f8"};
        std::string_view kind = name;
        if (!kind.empty() && std::string_view("<>|=").find(kind[0]) != kind.npos) kind.remove_prefix(1);
        if (std::find(std::begin(known), std::end(known), kind) == std::end(known))
            fail("says type " + shown(name) + "; known are b1 i1 i2 i4 i8 u1 u2 u4 u8 f4 f8");
        return {std::string(kind), static_cast<std::size_t>(kind[1] - '0'),
                name[0] == '>' ? std::endian::big : std::endian::little};
    }
    void read_shape() {
        expect('(');
        while (!accept(')')) {
            looking_at(' ');
            const std::size_t digits = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
            const auto n = parse_integer<std::size_t>(rest_.substr(0, digits));
            if (!n) fail("has a shape that is no list of sizes");
            if (header_.shape.size() == most_axes)
                fail("has more than " + std::to_string(most_axes) + " axes");
            rest_.remove_prefix(digits);
            header_.shape.push_back(*n);
            if (!accept(',') && !looking_at(')')) fail("has a shape without commas");
        }
    }

    const ByteSource& file_;
    std::string_view rest_;
    NpyHeader header_;
};

std::vector<std::byte> read_elements(ByteSource& file, std::size_t size) {
    std::vector<std::byte> bytes;
    bytes.reserve(size);
    while (bytes.size() < size) {
        const std::size_t begin = bytes.size(), n = std::min(size - begin, std::size_t(1) << 20);
        bytes.resize(begin + n);
        if (file.read(bytes.data() + begin, n) != n)
            file.fail_here("the file ends, but the array should have " + std::to_string(size) +
                           " bytes of elements. It was cut off: fetch it again");
    }
    return bytes;
}

/// Copies elements from Fortran order (first index fastest) to C order (last index fastest).
std::vector<std::byte> transposed(const ByteSource& file, const std::vector<std::byte>& from,
                                  const NpyHeader& header) {
    const std::size_t axes = header.shape.size(), item = header.type.item;
    std::vector<std::byte> to(from.size());
    std::vector<std::size_t> index(axes), stride(axes);
    for (std::size_t a = 0, s = item; a < axes; s *= header.shape[a++]) stride[a] = s;
    // Count indices in C order, and follow the element's place in Fortran order.
    std::size_t at = 0;
    for (std::size_t i = 0; i < to.size(); i += item) {
        if (i % (item << 16) == 0) file.expect_not_cancelled();
        std::memcpy(&to[i], &from[at], item);
        for (std::size_t a = axes; a-- > 0;) {
            at += stride[a];
            if (++index[a] < header.shape[a]) break;
            at -= stride[a] * header.shape[a];
            index[a] = 0;
        }
    }
    return to;
}

}  // namespace

NpyHeader read_npy_header(ByteSource& file) {
    char magic[8] = {};
    if (file.read(magic, 8) != 8 || std::string_view(magic, 6) != "\x93NUMPY")
        file.fail("is not a NumPy array. Write it with numpy.save");
    // Read the header's length: 2 bytes in version 1, 4 bytes in versions 2 and 3.
    std::uint32_t length = 0;
    std::uint16_t short_length = 0;
    bool read = false;
    if (magic[6] == 1) {
        read = file.value(short_length, std::endian::little);
        length = short_length;
    } else if (magic[6] == 2 || magic[6] == 3) {
        read = file.value(length, std::endian::little);
    } else {
        file.fail("is version " + std::to_string(magic[6]) + " of the format; known are 1 to 3");
    }
    // Read the header's text.
    if (length > (1u << 20))
        file.fail("the array's header says that it is " + std::to_string(length) + " bytes long");
    std::string text(length, ' ');
    if (!read || file.read(text.data(), length) != length)
        file.fail("the file ends in the array's header. It was cut off: fetch it again");
    return HeaderParser(file, text).parse();
}

std::size_t expect_npy_elements(const ByteSource& file, const NpyHeader& header) {
    std::size_t size = header.type.item;
    if (std::find(header.shape.begin(), header.shape.end(), 0u) != header.shape.end()) size = 0;
    for (const std::size_t n : header.shape) {
        if (size > 0 && size > (std::numeric_limits<std::size_t>::max() >> 1) / n)
            file.fail("the array's shape is larger than any memory. Was the header altered?");
        size *= n;
    }
    if (size > file.most_left())
        file.fail_here("the array should have " + std::to_string(size) +
                       " bytes of elements, but the file ends after at most " +
                       std::to_string(file.most_left()) + ". It was cut off: fetch it again");
    return size;
}

std::vector<std::size_t> read_npy_shape(ByteSource& file) {
    return read_npy_header(file).shape;
}

NpyArray read_npy(ByteSource& file) {
    const NpyHeader header = read_npy_header(file);
    if (!header.fields.empty())
        file.fail(
            "the array's header describes records; only plain numbers are read. Save one field of them, or a "
            "plain array, with numpy.save");
    NpyArray array;
    array.dtype = header.type.dtype;
    array.shape = header.shape;
    const std::size_t size = expect_npy_elements(file, header), item = header.type.item;
    expect_memory(file.name(), "its elements", header.fortran && header.shape.size() > 1 ? 2 * size : size);
    array.bytes = read_elements(file, size);
    if (header.type.order != std::endian::native && item > 1)
        for (std::size_t i = 0; i < array.bytes.size(); i += item)
            std::reverse(&array.bytes[i], &array.bytes[i] + item);
    if (header.fortran && header.shape.size() > 1) array.bytes = transposed(file, array.bytes, header);
    return array;
}

}  // namespace hedgerow::detail
