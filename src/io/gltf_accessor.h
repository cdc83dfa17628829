/// Reads the elements of a glTF accessor from where they are in its buffer.
#pragma once

#include <cstdint>
#include <string_view>

#include <hedgerow/geometry/vec.h>

#include "gltf_file.h"

namespace hedgerow::detail {

/// Numbers in a buffer, with their type and the bytes from one element to the next.
struct GltfNumbers {
    enum class Type { i1 = 5120, u1 = 5121, i2 = 5122, u2 = 5123, u4 = 5125, f4 = 5126 };

    std::string_view bytes;
    std::uint64_t stride = 0;
    Type type = Type::f4;
    bool normalized = false;

    /// Number `component` of element `i`, both in range.
    double value(std::uint64_t i, int component) const;
    std::uint64_t size_of_number() const;
    /// Whether the numbers can be indices: unsigned integers that are not normalized.
    bool are_ordinals() const;
};

/// The type of the numbers of an accessor, or of the indices of a sparse one. Throws InputError for an
/// unknown one.
GltfNumbers::Type number_type(const GltfFile& file, const GltfFile::Json& where);

/// Calls f(N()) with the C++ type of numbers of a type, and returns its result.
template <class F>
auto with_number(GltfNumbers::Type type, F f) {
    switch (type) {
        case GltfNumbers::Type::i1:  // NOLINT(bugprone-branch-clone): each calls another f
            return f(std::int8_t());
        case GltfNumbers::Type::u1:
            return f(std::uint8_t());
        case GltfNumbers::Type::i2:
            return f(std::int16_t());
        case GltfNumbers::Type::u2:
            return f(std::uint16_t());
        case GltfNumbers::Type::u4:
            return f(std::uint32_t());
        case GltfNumbers::Type::f4:
            break;
    }
    return f(float());
}

/// The elements of an accessor. The constructor checks all bounds, so `value` reads without checks. It finds
/// elements that a sparse accessor replaces by a binary search.
class GltfAccessor {
public:
    /// Elements of `components` numbers: 1 (SCALAR) to 4 (VEC4). Throws InputError for another type, for
    /// elements outside of their buffer, and for a stride that is less than an element.
    GltfAccessor(GltfFile& file, std::uint64_t number, int components);

    std::uint64_t size() const { return size_; }
    int components() const { return components_; }
    bool has_ordinals() const { return base_.are_ordinals(); }
    double value(std::uint64_t i, int component) const;
    Vec3d point(std::uint64_t i) const { return {value(i, 0), value(i, 1), value(i, 2)}; }

private:
    GltfNumbers numbers(GltfFile& file, const GltfFile::Json& where, GltfNumbers::Type type,
                        std::uint64_t count, int components) const;
    void read_sparse(GltfFile& file, const GltfFile::Json& sparse, int components);

    std::uint64_t size_ = 0;
    int components_ = 0;
    GltfNumbers base_;             // without bytes: all zero
    std::uint64_t replaced_ = 0;   // number of elements that are replaced
    GltfNumbers places_, values_;  // the replaced elements' places and new values
};

}  // namespace hedgerow::detail
