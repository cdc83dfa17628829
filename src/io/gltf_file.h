/// The parts of a glTF 2.0 file: checked access to its JSON and to the bytes of its buffers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "byte_source.h"
#include "little.h"

namespace hedgerow::detail {

/// A file whose every access is checked: a part that is missing, of the wrong type or out of range is an
/// InputError that names the file and the place. Buffers are read when they are first used, and only from the
/// file itself, from data URIs, and from files in the scene's folder.
class GltfFile {
public:
    using Json = nlohmann::json;

    /// Reads `.gltf` text or a `.glb` container; the first bytes decide which. Throws InputError if the
    /// version is not 2 or if a required extension may change the geometry. `file` must outlive this object.
    GltfFile(ByteSource& file, std::filesystem::path path);

    const std::string& name() const { return name_; }
    /// The array `key` of the root; empty if it is missing.
    const Json& array(const char* key) const;
    /// Element `i` of the array `key` of the root, which must be an object.
    const Json& object(const char* key, std::uint64_t i) const;
    std::size_t count(const char* key) const { return array(key).size(); }
    /// The member `key` of an object: a whole number that is not negative. Nothing if there is no such
    /// member.
    std::optional<std::uint64_t> number(const Json& object, const char* key) const;
    std::uint64_t number_or(const Json& object, const char* key, std::uint64_t otherwise) const {
        return number(object, key).value_or(otherwise);
    }
    std::uint64_t needed_number(const Json& object, const char* key) const;
    /// The member `key`: an array of whole numbers that are not negative. Empty if there is no such member.
    std::vector<std::uint64_t> ordinals(const Json& object, const char* key) const;
    /// The member `key`: `count` finite numbers. Nothing if there is no such member.
    std::optional<std::vector<double>> numbers(const Json& object, const char* key, std::size_t count) const;
    /// The member `key`: a finite number; `otherwise` if there is none.
    double real_or(const Json& object, const char* key, double otherwise) const;
    /// The member `key`: a text; empty if there is none.
    std::string text(const Json& object, const char* key) const;
    /// The member `key`: true or false; false if there is none.
    bool flag(const Json& object, const char* key) const;
    /// The member `key`: an object; null if there is none.
    const Json* member(const Json& object, const char* key) const;
    /// An extension of an object; null if it has none of this name.
    const Json* extension(const Json& object, const char* name) const;
    const Json& root() const { return root_; }
    /// The texts of the array `key` of the root, such as "extensionsUsed".
    std::vector<std::string> texts(const char* key) const;
    /// What identifies the bytes of an image: its file, its buffer view, or, of a data URI, its ordinal.
    std::string image_name(std::uint64_t i) const;
    /// The bytes of an image, which is a data URI, a file in the scene's folder, or a buffer view. `own`
    /// holds them where the file does not.
    std::string_view image(std::uint64_t i, std::string& own);
    /// `size` bytes of a buffer view, from `offset` on. They are valid as long as this object lives.
    std::string_view bytes(std::uint64_t view, std::uint64_t offset, std::uint64_t size);
    /// Bytes from one element of a buffer view to the next; 0 if the elements are adjacent.
    std::uint64_t stride(std::uint64_t view) const;
    /// The elements of an accessor that no buffer has, one after the other: those that `give` brought, else
    /// empty.
    std::string_view given(std::uint64_t accessor) const {
        const auto found = given_.find(accessor);
        return found == given_.end() ? std::string_view() : found->second;
    }
    void give(std::uint64_t accessor, std::string elements) { given_[accessor] = std::move(elements); }
    std::optional<std::uint64_t> scene() const { return number(root_, "scene"); }

    void expect_not_cancelled() const { source_.expect_not_cancelled(); }
    /// Throws InputError "NAME: WHAT. Repair the file, or export it again".
    [[noreturn]] void fail(const std::string& what) const;

private:
    struct Buffer {
        bool read = false;
        std::string own;         // the bytes, if they are not in the container
        std::string_view bytes;  // as many as the JSON declares
    };

    std::string_view json_of_container();
    void expect_known();
    /// The value of a member `key` as a whole number.
    std::uint64_t whole(const Json& value, const char* key) const;
    std::string_view buffer(std::uint64_t i);
    std::string_view find_bytes(std::uint64_t i, const Json& description, std::string& own) const;

    const ByteSource& source_;
    std::filesystem::path path_;
    std::string name_;
    std::string container_;                   // all of a .glb; empty for .gltf
    std::optional<std::string_view> binary_;  // the container's binary chunk
    Json root_;
    std::vector<Buffer> buffers_;
    std::map<std::uint64_t, std::string> given_;
};

}  // namespace hedgerow::detail
