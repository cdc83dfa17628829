/// glTF 2.0, section 3.6.2: accessors, sparse ones too, and KHR_mesh_quantization's types.
#include "gltf_accessor.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "mesh_parts.h"

namespace hedgerow::detail {

namespace {

/// The most elements of an accessor without a buffer view. They are zeros, which cost a file nothing; no
/// scene has use for more.
constexpr std::uint64_t most_zeros = std::uint64_t(1) << 22;
constexpr std::uint64_t longest_stride = 1u << 16;

}  // namespace

GltfNumbers::Type number_type(const GltfFile& file, const GltfFile::Json& where) {
    const std::uint64_t type = file.needed_number(where, "componentType");
    if ((type < 5120 || type > 5123) && type != 5125 && type != 5126)
        file.fail("componentType " + std::to_string(type) + " is not known");
    return static_cast<GltfNumbers::Type>(type);
}

double GltfNumbers::value(std::uint64_t i, int component) const {
    const char* at = bytes.data() + i * stride + static_cast<std::uint64_t>(component) * size_of_number();
    return with_number(type, [&]<class N>(N) {
        const double x = static_cast<double>(little<N>(at));
        if (std::is_same_v<N, float> || !normalized) return x;
        return std::max(x / static_cast<double>(std::numeric_limits<N>::max()), -1.0);
    });
}

bool GltfNumbers::are_ordinals() const {
    return !normalized && (type == Type::u1 || type == Type::u2 || type == Type::u4);
}

std::uint64_t GltfNumbers::size_of_number() const {
    if (type == Type::i1 || type == Type::u1) return 1;
    return type == Type::i2 || type == Type::u2 ? 2 : 4;
}

GltfAccessor::GltfAccessor(GltfFile& file, std::uint64_t number, int components) : components_(components) {
    const auto& accessor = file.object("accessors", number);
    const auto type = accessor.find("type");
    constexpr const char* names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const char* const wanted = names[components - 1];
    const std::string place = "accessor " + std::to_string(number);
    if (type == accessor.end() || *type != wanted) file.fail(place + " is not of type " + wanted);
    size_ = file.needed_number(accessor, "count");
    if (size_ >= most_ordinals) file.fail(place + " has more than 4294967295 elements");
    base_ = numbers(file, accessor, number_type(file, accessor), size_, components);
    if (base_.bytes.empty()) base_.bytes = file.given(number);
    if (const auto found = accessor.find("normalized"); found != accessor.end())
        base_.normalized = found->is_boolean() && found->get<bool>();
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end()) {
        if (!sparse->is_object()) file.fail("'sparse' of " + place + " is no object");
        read_sparse(file, *sparse, components);
    }
    if (base_.bytes.empty() && size_ > most_zeros)
        file.fail(place + " has " + std::to_string(size_) + " elements and no buffer view that holds them");
}

GltfNumbers GltfAccessor::numbers(GltfFile& file, const GltfFile::Json& where, GltfNumbers::Type type,
                                  std::uint64_t count, int components) const {
    GltfNumbers found;
    found.type = type;
    const std::uint64_t element = found.size_of_number() * static_cast<std::uint64_t>(components);
    found.stride = element;
    const auto view = file.number(where, "bufferView");
    if (!view || count == 0) return found;
    if (const std::uint64_t stride = file.stride(*view); stride != 0) found.stride = stride;
    if (found.stride < element || found.stride > longest_stride)
        file.fail("buffer view " + std::to_string(*view) + " has elements of " + std::to_string(element) +
                  " bytes and a stride of " + std::to_string(found.stride));
    found.bytes =
        file.bytes(*view, file.number_or(where, "byteOffset", 0), (count - 1) * found.stride + element);
    return found;
}

void GltfAccessor::read_sparse(GltfFile& file, const GltfFile::Json& sparse, int components) {
    replaced_ = file.needed_number(sparse, "count");
    const auto places = sparse.find("indices"), values = sparse.find("values");
    if (places == sparse.end() || values == sparse.end() || !places->is_object() || !values->is_object() ||
        replaced_ > size_)
        file.fail("a sparse accessor lacks its indices or values, or has more than it has elements");
    places_ = numbers(file, *places, number_type(file, *places), replaced_, 1);
    values_ = numbers(file, *values, base_.type, replaced_, components);
    values_.normalized = base_.normalized;
    if (!places_.are_ordinals())
        file.fail("the indices of a sparse accessor are of a type that indices cannot have");
    if (replaced_ > 0 && (places_.bytes.empty() || values_.bytes.empty()))
        file.fail("a sparse accessor has no buffer view for its indices or values");
    for (std::uint64_t i = 0; i < replaced_; ++i) {
        if (i % 65536 == 0) file.expect_not_cancelled();
        const double place = places_.value(i, 0);
        if (!(place >= 0 && place < static_cast<double>(size_)) ||
            (i > 0 && place <= places_.value(i - 1, 0)))
            file.fail("the indices of a sparse accessor do not ascend within its elements");
    }
}

double GltfAccessor::value(std::uint64_t i, int component) const {
    if (replaced_ > 0) {
        std::uint64_t low = 0, high = replaced_;
        while (low < high) {  // find the first place that is not before i
            const std::uint64_t middle = (low + high) / 2;
            if (places_.value(middle, 0) < static_cast<double>(i))
                low = middle + 1;
            else
                high = middle;
        }
        if (low < replaced_ && places_.value(low, 0) == static_cast<double>(i))
            return values_.value(low, component);
    }
    return base_.bytes.empty() ? 0 : base_.value(i, component);
}

}  // namespace hedgerow::detail
