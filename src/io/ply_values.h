/// The values behind the header of a PLY file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "byte_source.h"
#include "ply_header.h"
#include "text_source.h"

namespace hedgerow::detail {

/// Reads the values after a header one by one, each as T or as an integer.
template <class T>
class PlyValues {
public:
    PlyValues(ByteSource& file, const PlyHeader& header)
        : file_(file), words_(file, header.lines + 1), encoding_(header.encoding) {}

    /// Sets the element and the ordinal of the entry that error messages name.
    void enter(const PlyElement& element) { element_ = &element; }
    void enter(std::uint64_t ordinal) { ordinal_ = ordinal; }

    ByteSource& file() const { return file_; }
    /// The least bytes that an entry of the element takes in the file. Lists may be empty; a word has at
    /// least one letter and a space after it.
    std::uint64_t least_bytes(const PlyElement& element) const {
        std::uint64_t bytes = 0;
        for (const PlyProperty& p : element.properties)
            bytes += encoding_ == PlyEncoding::ascii ? 2 : size_of(p.count.value_or(p.type));
        return bytes;
    }

    /// A coordinate, whose rounding the file notes.
    T coordinate(PlyType type) {
        double& rounding = file_.rounding();
        if (encoding_ == PlyEncoding::ascii)
            return number_word([&](std::string_view w) { return parse_coordinate<T>(w, rounding); });
        if (type == PlyType::f4) return static_cast<T>(raw<float>());
        return decode<T>(type,
                         [&](auto x) { return detail::coordinate<T>(static_cast<double>(x), rounding); });
    }
    /// Another number.
    T real(PlyType type) {
        if (encoding_ == PlyEncoding::ascii)
            return number_word([](std::string_view w) { return parse_real<T>(w); });
        if (type == PlyType::f4) return static_cast<T>(raw<float>());  // the usual type
        return decode<T>(type, [](auto x) {
            if constexpr (std::is_same_v<decltype(x), double>)
                return rounded<T>(x);
            else
                return static_cast<T>(x);
        });
    }
    std::int64_t integer(PlyType type) {
        if (encoding_ == PlyEncoding::ascii) return integer_word();
        if (type == PlyType::i4) return raw<std::int32_t>();  // the usual types
        if (type == PlyType::u1) return raw<std::uint8_t>();
        // The header's checks refuse floating-point types. A 64-bit number beyond int64 becomes negative, and
        // callers refuse that.
        return decode<std::int64_t>(type, [](auto x) {
            if constexpr (std::is_floating_point_v<decltype(x)>)
                return std::int64_t(-1);
            else
                return static_cast<std::int64_t>(x);
        });
    }
    void skip(PlyType type, std::uint64_t count) {
        if (encoding_ == PlyEncoding::ascii)
            for (; count > 0; --count) word();
        else if (!file_.skip(count * size_of(type)))
            fail_truncated();
    }
    std::uint64_t list_size(PlyType type) {
        const std::int64_t n = integer(type);
        if (n < 0 || n > 0xFFFFFFFF) fail("a list of " + std::to_string(n) + " values");
        return static_cast<std::uint64_t>(n);
    }
    /// Warns of what follows the last element.
    void tell_surplus() {
        const bool has_more = encoding_ == PlyEncoding::ascii ? !words_.next().empty() : !file_.at_end();
        if (has_more) file_.warn("something follows the elements that its header counts. It is not read");
    }
    [[noreturn]] void fail(const std::string& what) {
        const std::string message = what + " (" + place() + "). Repair the file";
        if (encoding_ == PlyEncoding::ascii) words_.fail(message);
        file_.fail_here(message);
    }

private:
    static std::uint64_t size_of(PlyType type) {
        constexpr std::uint64_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
        return sizes[static_cast<int>(type)];
    }
    std::string_view word() {
        const std::string_view w = words_.next();
        if (w.empty()) fail_truncated();
        return w;
    }
    template <class Parse>
    T number_word(Parse parse) {
        const std::string_view w = word();
        if (const auto x = parse(w)) return *x;
        fail(shown(w) + " is not a number");
    }
    std::int64_t integer_word() {
        const std::string_view w = word();
        if (const auto i = parse_integer<std::int64_t>(w)) return *i;
        fail(shown(w) + " is not a whole number");
    }
    template <class R, class F>
    R decode(PlyType type, F f) {
        switch (type) {
            case PlyType::i1:
                return f(raw<std::int8_t>());
            case PlyType::u1:
                return f(raw<std::uint8_t>());
            case PlyType::i2:
                return f(raw<std::int16_t>());
            case PlyType::u2:
                return f(raw<std::uint16_t>());
            case PlyType::i4:
                return f(raw<std::int32_t>());
            case PlyType::u4:
                return f(raw<std::uint32_t>());
            case PlyType::i8:
                return f(raw<std::int64_t>());
            case PlyType::u8:
                return f(raw<std::uint64_t>());
            case PlyType::f4:
                return f(raw<float>());
            case PlyType::f8:
                break;
        }
        return f(raw<double>());
    }
    template <class U>
    U raw() {
        U v;
        const std::endian order = encoding_ == PlyEncoding::little ? std::endian::little : std::endian::big;
        if (!file_.value(v, order)) fail_truncated();
        return v;
    }
    std::string place() const {
        return "element '" + element_->name + "', number " + std::to_string(ordinal_);
    }
    [[noreturn]] void fail_truncated() {
        file_.fail_here("the file ends in " + place() + " of the " + std::to_string(element_->count) +
                        " that its header promises. It was cut off, or the header is wrong: fetch it again");
    }

    ByteSource& file_;
    WordSource words_;
    PlyEncoding encoding_;
    const PlyElement* element_ = nullptr;
    std::uint64_t ordinal_ = 0;
};

}  // namespace hedgerow::detail
