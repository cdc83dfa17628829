/// The container, the JSON and the buffers of glTF 2.0 (Khronos Group 2021, ISO/IEC 12113).
#include "gltf_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <hedgerow/base/error.h>

#include "gltf_draco.h"
#include "gltf_uri.h"
#include "json_text.h"
#include "memory.h"
#include "text_source.h"

namespace hedgerow::detail {

namespace {

/// Reads the rest of a file.
std::string read_all(ByteSource& file) {
    std::string bytes;
    while (!file.at_end()) {
        const std::string_view ahead = file.ahead();
        if (bytes.size() + ahead.size() > bytes.capacity() && bytes.size() >= (std::size_t(1) << 26))
            expect_memory(file.name(), "more than " + std::to_string(bytes.size()) + " bytes",
                          2 * bytes.capacity());
        bytes.append(ahead);
        file.skip(ahead.size());
    }
    return bytes;
}

/// The first `most` bytes of a file, or all of it if it is shorter. The file is never decompressed.
std::string first_bytes(const std::filesystem::path& path, std::uint64_t most) {
    check_readable(path);
    const std::uint64_t size = std::min<std::uint64_t>(std::filesystem::file_size(path), most);
    expect_memory(path.string(), "its bytes", size);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

/// Whether an extension changes only how a scene looks or moves, and not where its triangles are.
bool leaves_geometry_alone(const std::string& extension) {
    constexpr std::string_view beginnings[] = {"KHR_materials_",      "KHR_texture_", "EXT_texture_",
                                               "MSFT_texture_",       "KHR_lights_",  "EXT_lights_",
                                               "KHR_animation_",      "KHR_xmp",      "KHR_techniques_",
                                               "KHR_node_visibility", "MSFT_packing_"};
    return extension == "KHR_mesh_quantization" ||  // the accessors read it
           (extension == "KHR_draco_mesh_compression" && draco_supported()) ||
           std::any_of(std::begin(beginnings), std::end(beginnings),
                       [&](std::string_view b) { return extension.starts_with(b); });
}

const nlohmann::json empty_array = nlohmann::json::array();

}  // namespace

GltfFile::GltfFile(ByteSource& file, std::filesystem::path path)
    : source_(file), path_(std::move(path)), name_(path_.string()) {
    open_text(file);
    container_ = read_all(file);
    const bool is_container = container_.starts_with("glTF");
    const std::string_view text =
        is_container ? without_mark(json_of_container()) : std::string_view(container_);
    root_ = parse_json(text, name_);
    if (!is_container) container_ = std::string();
    expect_known();
    buffers_.resize(count("buffers"));
}

std::string_view GltfFile::json_of_container() {
    const std::string_view bytes = container_;
    // Check the container's header: magic word, version, length.
    if (bytes.size() < 20) fail("ends in its header of 20 bytes");
    const auto word = [&](std::size_t at) { return little<std::uint32_t>(&bytes[at]); };
    const std::uint32_t version = word(4), length = word(8);
    if (version != 2) fail("is a container of version " + std::to_string(version) + ", but only 2 is read");
    if (length > bytes.size())
        fail("should be " + std::to_string(length) + " bytes long, but has " + std::to_string(bytes.size()) +
             ": it was cut off");
    // Find the first chunk of JSON and the first binary one.
    std::optional<std::string_view> json;
    for (std::size_t at = 12; at + 8 <= length;) {
        const std::size_t size = word(at);
        if (size > bytes.size() - at - 8)
            fail("has a chunk of " + std::to_string(size) + " bytes at byte " + std::to_string(at) +
                 ", which is longer than the file");
        const std::string_view type = bytes.substr(at + 4, 4), body = bytes.substr(at + 8, size);
        if (type == "JSON" && !json) json = body;
        if (type == std::string_view("BIN\0", 4) && !binary_) binary_ = body;
        at += 8 + size;
    }
    if (!json) fail("has no chunk of JSON");
    return *json;
}

void GltfFile::expect_known() {
    if (!root_.is_object()) fail("is JSON, but no glTF: there is no object at its root");
    const auto asset = root_.find("asset");
    if (asset == root_.end() || !asset->is_object() || !asset->contains("version") ||
        !(*asset)["version"].is_string())
        fail("has no asset.version, so it is no glTF 2.0");
    const std::string version = (*asset)["version"];
    if (!version.starts_with("2.")) fail("is glTF " + shown(version) + ", but only 2.0 is read");
    for (const Json& extension : array("extensionsRequired"))
        if (!extension.is_string() || !leaves_geometry_alone(extension))
            fail("requires the extension " + shown(extension.is_string() ? std::string(extension) : "?") +
                 ", which is not read. Export it without (uncompressed, instances as nodes)");
}

const GltfFile::Json& GltfFile::array(const char* key) const {
    const auto found = root_.find(key);
    if (found == root_.end()) return empty_array;
    if (!found->is_array()) fail(std::string("'") + key + "' is no array");
    return *found;
}

const GltfFile::Json& GltfFile::object(const char* key, std::uint64_t i) const {
    const Json& all = array(key);
    if (i >= all.size())
        fail(std::string("something names number ") + std::to_string(i) + " of its " + key +
             ", but there are only " + std::to_string(all.size()));
    const Json& found = all[static_cast<std::size_t>(i)];
    if (!found.is_object())
        fail(std::string("number ") + std::to_string(i) + " of its " + key + " is no object");
    return found;
}

std::optional<std::uint64_t> GltfFile::number(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    return whole(*found, key);
}

std::vector<std::uint64_t> GltfFile::ordinals(const Json& object, const char* key) const {
    std::vector<std::uint64_t> all;
    const auto found = object.find(key);
    if (found == object.end()) return all;
    if (!found->is_array()) fail(std::string("'") + key + "' is no array");
    for (const Json& n : *found) all.push_back(whole(n, key));
    return all;
}

std::uint64_t GltfFile::whole(const Json& value, const char* key) const {
    if (value.is_number_unsigned()) return value.get<std::uint64_t>();
    const double x = value.is_number_float() ? value.get<double>() : -1;  // 3.0, as some exporters write
    if (!(x >= 0) || x > 0x1p53 || x != std::floor(x))
        fail(std::string("'") + key + "' holds what is no whole number");
    return static_cast<std::uint64_t>(x);
}

std::uint64_t GltfFile::needed_number(const Json& object, const char* key) const {
    const auto found = number(object, key);
    if (!found) fail(std::string("'") + key + "' is missing");
    return *found;
}

std::optional<std::vector<double>> GltfFile::numbers(const Json& object, const char* key,
                                                     std::size_t count) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    if (!found->is_array() || found->size() != count)
        fail(std::string("'") + key + "' is no array of " + std::to_string(count) + " numbers");
    std::vector<double> values;
    for (const Json& x : *found) {
        if (!x.is_number() || !std::isfinite(x.get<double>()))
            fail(std::string("'") + key + "' holds what is no number");
        values.push_back(x.get<double>());
    }
    return values;
}

double GltfFile::real_or(const Json& object, const char* key, double otherwise) const {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_number() || !std::isfinite(found->get<double>()))
        fail(std::string("'") + key + "' is no number");
    return found->get<double>();
}

std::string GltfFile::text(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return {};
    if (!found->is_string()) fail(std::string("'") + key + "' is no text");
    return found->get<std::string>();
}

bool GltfFile::flag(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return false;
    if (!found->is_boolean()) fail(std::string("'") + key + "' is neither true nor false");
    return found->get<bool>();
}

const GltfFile::Json* GltfFile::member(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return nullptr;
    if (!found->is_object()) fail(std::string("'") + key + "' is no object");
    return &*found;
}

const GltfFile::Json* GltfFile::extension(const Json& object, const char* name) const {
    const Json* const all = member(object, "extensions");
    return all == nullptr ? nullptr : member(*all, name);
}

std::vector<std::string> GltfFile::texts(const char* key) const {
    std::vector<std::string> all;
    for (const Json& text : array(key)) {
        if (!text.is_string()) fail(std::string("'") + key + "' holds what is no text");
        all.push_back(text.get<std::string>());
    }
    return all;
}

std::string GltfFile::image_name(std::uint64_t i) const {
    const Json& description = object("images", i);
    if (const auto view = number(description, "bufferView")) return "buffer view " + std::to_string(*view);
    const std::string uri = text(description, "uri");
    return uri.empty() || is_data_uri(uri) ? "image " + std::to_string(i) : uri;
}

std::string_view GltfFile::image(std::uint64_t i, std::string& own) {
    const Json& description = object("images", i);
    if (const auto view = number(description, "bufferView"))
        return bytes(*view, 0, needed_number(object("bufferViews", *view), "byteLength"));
    const std::string uri = text(description, "uri");
    if (uri.empty()) fail("image " + std::to_string(i) + " has neither a 'uri' nor a buffer view");
    if (is_data_uri(uri)) return own = bytes_of_data_uri(uri, name_);
    return own = first_bytes(file_of_uri(uri, path_, name_, "image"), std::uint64_t(1) << 40);
}

std::string_view GltfFile::bytes(std::uint64_t view, std::uint64_t offset, std::uint64_t size) {
    const Json& v = object("bufferViews", view);
    const std::string_view whole = buffer(needed_number(v, "buffer"));
    const std::uint64_t begin = number_or(v, "byteOffset", 0), length = needed_number(v, "byteLength");
    const std::string place = "buffer view " + std::to_string(view);
    if (begin > whole.size() || length > whole.size() - begin)
        fail(place + " is of " + std::to_string(length) + " bytes from byte " + std::to_string(begin) +
             " on, but its buffer has " + std::to_string(whole.size()));
    if (offset > length || size > length - offset)
        fail("an accessor needs " + std::to_string(size) + " bytes from byte " + std::to_string(offset) +
             " of " + place + " on, which has " + std::to_string(length));
    return whole.substr(static_cast<std::size_t>(begin + offset), static_cast<std::size_t>(size));
}

std::uint64_t GltfFile::stride(std::uint64_t view) const {
    return number_or(object("bufferViews", view), "byteStride", 0);
}

std::string_view GltfFile::buffer(std::uint64_t i) {
    const Json& description = object("buffers", i);
    Buffer& held = buffers_[static_cast<std::size_t>(i)];
    if (held.read) return held.bytes;
    const std::uint64_t size = needed_number(description, "byteLength");
    const std::string_view all = find_bytes(i, description, held.own);
    if (all.size() < size)
        fail("buffer " + std::to_string(i) + " should have " + std::to_string(size) + " bytes, but has " +
             std::to_string(all.size()) + ": it was cut off");
    held.bytes = all.substr(0, static_cast<std::size_t>(size));  // without padding
    held.read = true;
    return held.bytes;
}

std::string_view GltfFile::find_bytes(std::uint64_t i, const Json& description, std::string& own) const {
    const auto uri = description.find("uri");
    if (uri == description.end()) {
        if (i != 0 || !binary_)
            fail("buffer " + std::to_string(i) + " has no 'uri' and no chunk of a container");
        return *binary_;
    }
    if (!uri->is_string()) fail("the 'uri' of buffer " + std::to_string(i) + " is no text");
    const auto& text = uri->get_ref<const std::string&>();
    if (is_data_uri(text)) return own = bytes_of_data_uri(text, name_);
    const auto file = file_of_uri(text, path_, name_);
    const std::uint64_t size = needed_number(description, "byteLength");
    try {
        return own = first_bytes(file, size);
    } catch (const InputError& error) {
        throw InputError(name_ + ": its buffer " + shown(text) + " cannot be read: " + error.what());
    }
}

void GltfFile::fail(const std::string& what) const {
    throw InputError(name_ + ": " + what + ". Repair the file, or export it again");
}

}  // namespace hedgerow::detail
