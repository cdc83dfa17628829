/// Parts that mesh readers share: faces become triangles, and corners become vertices.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <hedgerow/primitives/triangle_mesh.h>

#include "byte_source.h"
#include "memory.h"
#include "triangulate.h"

namespace hedgerow::detail {

/// Ordinals of vertices and faces are less than 2^32 − 1, so that an index can name them.
inline constexpr std::uint64_t most_ordinals = 0xFFFFFFFFu;

/// Throws InputError if no ordinal is left for one more thing after `count` of them.
inline void check_room(const ByteSource& file, std::uint64_t count, const char* what) {
    if (count >= most_ordinals)
        file.fail(std::string("has more than 4294967295 ") + what + ". Split it into several files");
}

/// Throws InputError if a file cannot hold the `count` things that it declares, each of at least `file_bytes`
/// bytes in the file, or if the memory cannot hold them, each in `memory_bytes`. Things that take little
/// memory are not checked here. They are read as far as they go, and the message then names the place where
/// they end.
inline void check_declared(const ByteSource& file, std::uint64_t count, std::uint64_t file_bytes,
                           std::uint64_t memory_bytes, const char* what) {
    check_room(file, count, what);
    if (count * memory_bytes <= (std::uint64_t(1) << 20)) return;
    const std::uint64_t left = file.most_left() + 1;  // 1: the last line may have no end
    if (file_bytes > 0 && count > left / file_bytes)
        file.fail("promises " + std::to_string(count) + " " + what + ", which take at least " +
                  std::to_string(file_bytes) + " bytes each, but at most " + std::to_string(left - 1) +
                  " bytes follow. It was cut off, or the count is wrong: fetch it again");
    expect_memory(file.name(), "its " + std::to_string(count) + " " + what, count * memory_bytes);
}

/// Appends to an array that grows as a file is read. Throws InputError before the array outgrows the memory
/// that is left. Without this, a system that overcommits would kill the process later, without a message.
template <class U>
void append(const ByteSource& file, std::vector<U>& array, const U& value) {
    constexpr std::size_t unasked = (std::size_t(1) << 26) / sizeof(U);  // 64 MiB need no check
    if (array.size() == array.capacity() && array.size() >= unasked) {
        const std::size_t grown = array.size() + array.size() / 2;
        expect_memory(file.name(), "more than the " + std::to_string(array.size()) + " entries read so far",
                      grown * sizeof(U));
        array.reserve(grown);
    }
    array.push_back(value);
}

/// The faces of a file as triangles. Polygons are stored as fans until all vertices are known, and are then
/// triangulated (triangulate.h). Face ordinals are stored only if a face is not a triangle.
///
/// Corners may have further ordinals, of normals for example. There are up to `most_lists` lists of them;
/// `nothing` is the ordinal of a corner without one. A list whose corners have none takes no memory.
class FaceList {
public:
    static constexpr std::size_t most_lists = 3;
    static constexpr std::uint32_t nothing = 0xFFFFFFFFu;

    explicit FaceList(const ByteSource& file) : file_(file) {}

    std::uint64_t face_count() const { return next_; }
    std::size_t triangle_count() const { return triangles_.size(); }

    /// Adds a face by its vertices.
    void add(std::span<const std::uint32_t> corners) {
        if (corners.size() != 3 && !numbered_) number_faces();
        for (std::size_t i = 2; i < corners.size(); ++i) {
            append(file_, triangles_, TriangleIndices{corners[0], corners[i - 1], corners[i]});
            if (numbered_) append(file_, faces_, static_cast<std::uint32_t>(next_));
        }
        ++next_;
    }
    /// Adds a face by its vertices and lists of as many further ordinals each.
    void add(std::span<const std::uint32_t> corners, std::span<const std::vector<std::uint32_t>> others) {
        for (std::size_t k = 0; k < others.size(); ++k) add_others(others_[k], others[k]);
        add(corners);
    }
    /// Triangulates the polygons and moves all triangles into a mesh, which has its vertices already.
    template <class T>
    void move_to(TriangleMesh<T>& mesh) {
        for (std::size_t begin = 0, end; begin < faces_.size(); begin = end) {
            for (end = begin + 1; end < faces_.size() && faces_[end] == faces_[begin];) ++end;
            if (end - begin < 2) continue;
            file_.expect_not_cancelled();
            const auto part = [&](std::vector<TriangleIndices>& all) {
                return std::span(all).subspan(begin, end - begin);
            };
            std::array<std::span<TriangleIndices>, most_lists> alike;
            std::size_t lists = 0;
            for (auto& other : others_)
                if (!other.empty()) alike[lists++] = part(other);
            fill_polygon<T>(file_, part(triangles_), mesh.vertices, std::span(alike).first(lists));
        }
        mesh.triangles = std::move(triangles_);
        mesh.faces = std::move(faces_);
    }
    /// The further ordinals of the triangles' corners, once `move_to` is done. Empty if no corner has one.
    std::vector<TriangleIndices> take_others(std::size_t list) { return std::move(others_[list]); }

private:
    /// Numbers the triangles before the first face that is none.
    void number_faces() {
        expect_memory(file_.name(), "the face numbers of its triangles",
                      triangles_.size() * sizeof(faces_[0]));
        faces_.resize(triangles_.size());
        std::iota(faces_.begin(), faces_.end(), 0u);
        numbered_ = true;
    }
    /// Adds the fan of a face to a list of further ordinals, before its triangles are added.
    void add_others(std::vector<TriangleIndices>& list, const std::vector<std::uint32_t>& corners) {
        const bool has_none =
            std::all_of(corners.begin(), corners.end(), [](std::uint32_t c) { return c == nothing; });
        if (list.empty() && has_none) return;
        while (list.size() < triangles_.size())
            append(file_, list, TriangleIndices{nothing, nothing, nothing});
        for (std::size_t i = 2; i < corners.size(); ++i)
            append(file_, list, TriangleIndices{corners[0], corners[i - 1], corners[i]});
    }

    const ByteSource& file_;
    std::vector<TriangleIndices> triangles_;
    std::array<std::vector<TriangleIndices>, most_lists> others_;
    std::vector<std::uint32_t> faces_;
    std::uint64_t next_ = 0;
    bool numbered_ = false;
};

/// Makes one value of all values with the same bits (−0 equals 0). A V is made of numbers of type T alone. An
/// open-addressing hash table, at most half full.
template <class V, class T>
class ValueWelder {
public:
    explicit ValueWelder(const ByteSource& file) : file_(file) {}

    /// The ordinal of a value.
    std::uint32_t vertex(const V& corner) {
        if (2 * (vertices_.size() + 1) > slots_.size()) grow();
        const Key key = key_of(corner);
        for (std::size_t s = hash(key) & (slots_.size() - 1);; s = (s + 1) & (slots_.size() - 1)) {
            if (slots_[s] == 0) {
                append(file_, vertices_, corner);
                slots_[s] = static_cast<std::uint32_t>(vertices_.size());
                return slots_[s] - 1;
            }
            if (key_of(vertices_[slots_[s] - 1]) == key) return slots_[s] - 1;
        }
    }
    std::size_t size() const { return vertices_.size(); }
    std::vector<V> take() { return std::move(vertices_); }

private:
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    using Key = std::array<Bits, sizeof(V) / sizeof(T)>;

    static Key key_of(const V& value) {
        Key key = std::bit_cast<Key>(value);
        for (Bits& b : key)
            if (std::bit_cast<T>(b) == 0) b = 0;
        return key;
    }
    static std::size_t hash(const Key& key) {
        std::uint64_t h = 0;
        for (const Bits b : key) {  // the finisher of SplitMix64 (Steele, Lea and Flood 2014)
            h += b + 0x9E3779B97F4A7C15u;
            h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
            h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
            h ^= h >> 31;
        }
        return static_cast<std::size_t>(h);
    }
    void grow() {
        const std::size_t grown = slots_.empty() ? 1024 : 2 * slots_.size();
        if (grown > (std::size_t(1) << 24))
            expect_memory(file_.name(), "its more than " + std::to_string(vertices_.size()) + " vertices",
                          grown * sizeof(slots_[0]));
        slots_ = std::vector<std::uint32_t>();  // freed first: it is rebuilt from the vertices
        slots_.resize(grown);
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            std::size_t s = hash(key_of(vertices_[i])) & (slots_.size() - 1);
            while (slots_[s] != 0) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = static_cast<std::uint32_t>(i + 1);
        }
    }

    const ByteSource& file_;
    std::vector<V> vertices_;
    std::vector<std::uint32_t> slots_;  // 1 + the vertex; 0: free
};

/// Makes one vertex of all corners at the same place.
template <class T>
using Welder = ValueWelder<Vec<T, 3>, T>;

}  // namespace hedgerow::detail
