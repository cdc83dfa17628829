/// The parts of a glTF 2.0 file: its JSON, the bytes of its buffers, and checked ways into both.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "byte_source.h"

namespace hedgerow::detail {

/// The number in `sizeof(U)` bytes, in the order that all of glTF has.
template <class U>
U little(const char* bytes) {
    unsigned char raw[sizeof(U)];
    std::memcpy(raw, bytes, sizeof(U));
    if constexpr (std::endian::native != std::endian::little) std::reverse(raw, raw + sizeof(U));
    U value;
    std::memcpy(&value, raw, sizeof(U));
    return value;
}

/// A file whose every access is checked: what is missing, of the wrong type or out of range is an InputError
/// that names the file and the place. Buffers are read when they are first asked for, and only from the
/// file itself, from data URIs, and from files in the scene's folder.
class GltfFile {
public:
    using Json = nlohmann::json;

    /// Reads `.gltf` text or a `.glb` container, told apart by their first bytes, and holds it against what
    /// can be read: version 2, no extension that is required and changes the geometry. `file` has to live as
    /// long as this.
    GltfFile(ByteSource& file, std::filesystem::path path);

    const std::string& name() const { return name_; }
    /// The array `key` of the root; empty where it is missing.
    const Json& array(const char* key) const;
    /// Element `i` of the array `key` of the root, which must be an object.
    const Json& object(const char* key, std::uint64_t i) const;
    std::size_t count(const char* key) const { return array(key).size(); }
    /// A member of an object: a whole number that is not negative. Nothing where there is no such member.
    std::optional<std::uint64_t> number(const Json& object, const char* key) const;
    std::uint64_t number_or(const Json& object, const char* key, std::uint64_t otherwise) const {
        return number(object, key).value_or(otherwise);
    }
    std::uint64_t needed_number(const Json& object, const char* key) const;
    /// An array of whole numbers that are not negative; empty where there is no such member.
    std::vector<std::uint64_t> ordinals(const Json& object, const char* key) const;
    /// `count` finite numbers; nothing where there is no such member.
    std::optional<std::vector<double>> numbers(const Json& object, const char* key, std::size_t count) const;
    /// `size` bytes of a buffer view, from `offset` on. They lie there as long as the file is held.
    std::string_view bytes(std::uint64_t view, std::uint64_t offset, std::uint64_t size);
    /// Distance between the elements of a buffer view; 0: they lie side by side.
    std::uint64_t stride(std::uint64_t view) const;
    std::optional<std::uint64_t> scene() const { return number(root_, "scene"); }

    void expect_not_cancelled() const { source_.expect_not_cancelled(); }
    /// Throws InputError "NAME: WHAT. Repair the file, or export it again".
    [[noreturn]] void fail(const std::string& what) const;

private:
    struct Buffer {
        bool read = false;
        std::string own;         // what does not lie in the container
        std::string_view bytes;  // as many as the JSON says
    };

    std::string_view json_of_container();
    void expect_known();
    /// A value of the member `key`.
    std::uint64_t whole(const Json& value, const char* key) const;
    std::string_view buffer(std::uint64_t i);
    std::string_view find_bytes(std::uint64_t i, const Json& description, std::string& own) const;

    const ByteSource& source_;
    std::filesystem::path path_;
    std::string name_;
    std::string container_;                   // all of a .glb; empty for .gltf
    std::optional<std::string_view> binary_;  // the chunk of a container
    Json root_;
    std::vector<Buffer> buffers_;
};

}  // namespace hedgerow::detail
