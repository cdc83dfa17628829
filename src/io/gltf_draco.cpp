/// Khronos's extension KHR_draco_mesh_compression through Google's library.
#include "gltf_draco.h"

#ifndef HEDGEROW_HAS_DRACO
#define HEDGEROW_HAS_DRACO 0
#endif

#if HEDGEROW_HAS_DRACO
#include <draco/compression/decode.h>

#include <string>
#include <utility>

#include "gltf_accessor.h"
#include "little.h"
#endif

namespace hedgerow::detail {

#if HEDGEROW_HAS_DRACO
namespace {

using Json = GltfFile::Json;

[[noreturn]] void fail_draco(const GltfFile& file, const std::string& what) {
    file.fail("a primitive compressed by Draco (KHR_draco_mesh_compression) " + what);
}

template <class N>
void append_little(std::string& bytes, N x) {
    const auto raw = little_bytes(x);
    bytes.append(raw.begin(), raw.end());
}

void expect_count(const GltfFile& file, const Json& accessor, std::uint64_t count) {
    if (const std::uint64_t said = file.needed_number(accessor, "count"); said != count)
        fail_draco(file, "has " + std::to_string(count) + " elements, and its accessor says " +
                             std::to_string(said));
}

void give_indices(GltfFile& file, const draco::Mesh& mesh, std::uint64_t number) {
    const Json& accessor = file.object("accessors", number);
    expect_count(file, accessor, std::uint64_t(3) * mesh.num_faces());
    std::string bytes;
    with_number(number_type(file, accessor), [&]<class N>(N) {
        for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
            for (const auto& corner : mesh.face(draco::FaceIndex(i)))
                append_little(bytes, static_cast<N>(corner.value()));
    });
    file.give(number, std::move(bytes));
}

void give_attribute(GltfFile& file, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                    std::uint64_t number) {
    const Json& accessor = file.object("accessors", number);
    expect_count(file, accessor, mesh.num_points());
    const std::string type = file.text(accessor, "type");
    const int components = type == "SCALAR"                              ? 1
                           : type.size() == 4 && type.starts_with("VEC") ? type[3] - '0'
                                                                         : 0;
    if (components != attribute.num_components() || components < 1 || components > 4)
        fail_draco(file, "has an attribute that is not of the type " + type + " of its accessor");
    std::string bytes;
    with_number(number_type(file, accessor), [&]<class N>(N) {
        for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
            N numbers[4] = {};
            if (!attribute.ConvertValue<N>(attribute.mapped_index(draco::PointIndex(i)),
                                           static_cast<std::int8_t>(components), numbers))
                fail_draco(file, "has a value that its accessor cannot hold");
            for (int k = 0; k < components; ++k) append_little(bytes, numbers[k]);
        }
    });
    file.give(number, std::move(bytes));
}

}  // namespace

bool draco_supported() {
    return true;
}

void decompress(GltfFile& file, const Json& primitive, const Json& extension) {
    const std::uint64_t view = file.needed_number(extension, "bufferView");
    const std::string_view bytes =
        file.bytes(view, 0, file.needed_number(file.object("bufferViews", view), "byteLength"));
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) fail_draco(file, "cannot be decoded: " + decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    const auto ids = extension.find("attributes");
    const auto attributes = primitive.find("attributes");
    if (ids == extension.end() || !ids->is_object() || attributes == primitive.end() ||
        !attributes->is_object())
        fail_draco(file, "has no 'attributes'");
    for (const auto& [name, value] : ids->items()) {
        const auto number = file.number(*attributes, name.c_str());
        const auto id = file.needed_number(*ids, name.c_str());
        const auto* const attribute =
            id <= 0xFFFFFFFFu ? mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id)) : nullptr;
        if (!number || attribute == nullptr) fail_draco(file, "lacks its attribute " + name);
        give_attribute(file, mesh, *attribute, *number);
    }
    if (const auto indices = file.number(primitive, "indices")) give_indices(file, mesh, *indices);
}
#else
bool draco_supported() {
    return false;
}

void decompress(GltfFile& file, const GltfFile::Json&, const GltfFile::Json&) {
    file.fail(
        "a primitive is compressed by Draco (KHR_draco_mesh_compression), which this build cannot read: "
        "build "
        "with libdraco-dev, or decompress the file, with gltf-transform");
}
#endif

}  // namespace hedgerow::detail
