/// The elements of a glTF accessor, where they lie.
#pragma once

#include <cstdint>
#include <string_view>

#include <hedgerow/geometry/vec.h>

#include "gltf_file.h"

namespace hedgerow::detail {

/// Numbers in a buffer: their type and how far apart the elements are.
struct GltfNumbers {
    enum class Type { i1 = 5120, u1 = 5121, i2 = 5122, u2 = 5123, u4 = 5125, f4 = 5126 };

    std::string_view bytes;
    std::uint64_t stride = 0;
    Type type = Type::f4;
    bool normalized = false;

    /// Number `component` of element `i`, both in range.
    double value(std::uint64_t i, int component) const;
    std::uint64_t size_of_number() const;
    /// Whether they may be used as indices: whole, without a sign, and as they are.
    bool are_ordinals() const;
};

/// Bounds are checked once, when it is made: `at` reads what is there. Elements that a sparse accessor
/// replaces are found by a binary search.
class GltfAccessor {
public:
    /// Elements of `components` numbers: 1 (SCALAR) or 3 (VEC3). Throws InputError for another type, for
    /// what lies outside of its buffer, and for strides of less than an element.
    GltfAccessor(GltfFile& file, std::uint64_t number, int components);

    std::uint64_t size() const { return size_; }
    bool has_ordinals() const { return base_.are_ordinals(); }
    double value(std::uint64_t i, int component) const;
    Vec3d point(std::uint64_t i) const { return {value(i, 0), value(i, 1), value(i, 2)}; }

private:
    GltfNumbers numbers(GltfFile& file, const GltfFile::Json& where, GltfNumbers::Type type,
                        std::uint64_t count, int components) const;
    void read_sparse(GltfFile& file, const GltfFile::Json& sparse, int components);

    std::uint64_t size_ = 0;
    GltfNumbers base_;             // without bytes: all zero
    std::uint64_t replaced_ = 0;   // number of elements that are replaced
    GltfNumbers places_, values_;  // of those
};

}  // namespace hedgerow::detail
