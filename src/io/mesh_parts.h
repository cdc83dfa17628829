/// What mesh readers fill: faces that become triangles, and corners that become vertices.
#pragma once

#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <hedgerow/primitives/triangle_mesh.h>

#include "byte_source.h"

namespace hedgerow::detail {

/// Polygons become fans. Ordinals are kept from the first face on that is no triangle.
class FaceList {
public:
    std::uint64_t face_count() const { return next_; }

    void add(std::span<const std::uint32_t> corners) {
        if (corners.size() != 3 && !numbered_) {
            faces_.resize(triangles_.size());
            std::iota(faces_.begin(), faces_.end(), 0u);
            numbered_ = true;
        }
        for (std::size_t i = 2; i < corners.size(); ++i) {
            triangles_.push_back({corners[0], corners[i - 1], corners[i]});
            if (numbered_) faces_.push_back(static_cast<std::uint32_t>(next_));
        }
        ++next_;
    }
    template <class T>
    void move_to(TriangleMesh<T>& mesh) {
        mesh.triangles = std::move(triangles_);
        mesh.faces = std::move(faces_);
    }

private:
    std::vector<TriangleIndices> triangles_;
    std::vector<std::uint32_t> faces_;
    std::uint64_t next_ = 0;
    bool numbered_ = false;
};

/// Vertices and faces that are 2^32 − 1 or more cannot be named by an index.
inline constexpr std::uint64_t most_ordinals = 0xFFFFFFFFu;

inline void check_room(const ByteSource& file, std::uint64_t count, const char* what) {
    if (count >= most_ordinals)
        file.fail(std::string("has more than 4294967295 ") + what + ". Split it into several files");
}

/// One vertex for all corners with the same bits, −0 being 0. An open-addressing hash table, at most half
/// full.
template <class T>
class Welder {
public:
    std::uint32_t vertex(const Vec<T, 3>& corner) {
        if (2 * (vertices_.size() + 1) > slots_.size()) grow();
        const Key key = key_of(corner);
        for (std::size_t s = hash(key) & (slots_.size() - 1);; s = (s + 1) & (slots_.size() - 1)) {
            if (slots_[s] == 0) {
                vertices_.push_back(corner);
                slots_[s] = static_cast<std::uint32_t>(vertices_.size());
                return slots_[s] - 1;
            }
            if (key_of(vertices_[slots_[s] - 1]) == key) return slots_[s] - 1;
        }
    }
    std::size_t size() const { return vertices_.size(); }
    std::vector<Vec<T, 3>> take() { return std::move(vertices_); }

private:
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    using Key = std::array<Bits, 3>;

    static Key key_of(const Vec<T, 3>& p) {
        const auto bits = [](T x) { return x == 0 ? Bits(0) : std::bit_cast<Bits>(x); };
        return {bits(p[0]), bits(p[1]), bits(p[2])};
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
        slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), 0);
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            std::size_t s = hash(key_of(vertices_[i])) & (slots_.size() - 1);
            while (slots_[s] != 0) s = (s + 1) & (slots_.size() - 1);
            slots_[s] = static_cast<std::uint32_t>(i + 1);
        }
    }

    std::vector<Vec<T, 3>> vertices_;
    std::vector<std::uint32_t> slots_;  // 1 + the vertex; 0: free
};

}  // namespace hedgerow::detail
