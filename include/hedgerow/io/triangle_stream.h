/// Triangles that come a part at a time, in bounded memory: of a file, or as a function makes them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include <hedgerow/io/load_options.h>
#include <hedgerow/parallel/progress.h>
#include <hedgerow/primitives/triangle_mesh.h>

namespace hedgerow {

/// Triangles in an order that is always the same, at most 2^32 − 2 of them. Each has corners of its own:
/// corner c of triangle i of a part is vertex 3·i + c.
template <class T>
class TriangleStream {
public:
    /// Triangles of a part, at most.
    static constexpr std::size_t part_size = std::size_t(1) << 16;

    virtual ~TriangleStream() = default;
    /// Goes back to the first triangle.
    virtual void rewind() = 0;
    /// Replaces what the mesh holds by the next part; it is empty after the last. Throws InputError for
    /// faults of a file, and Cancelled.
    virtual void next(TriangleMesh<T>& part) = 0;
    /// What the loader of a file tells of what has been read since the first triangle. Each warning is given
    /// once.
    virtual LoadReport report() { return {}; }

    /// Calls f(part, first) for all parts from the first triangle on; `first` is the number of the part's
    /// first triangle.
    template <class F>
    void for_each_part(F f) {
        rewind();
        TriangleMesh<T> part;
        std::uint32_t first = 0;
        for (next(part); part.size() > 0; next(part)) {
            f(std::as_const(part), first);
            first += static_cast<std::uint32_t>(part.size());
        }
    }
};

/// Triangles that a function makes: triangle i is make(i), for i below `count`.
template <class T>
class MadeTriangles final : public TriangleStream<T> {
public:
    MadeTriangles(std::uint32_t count, std::function<Triangle<T, 3>(std::uint32_t)> make)
        : count_(count), make_(std::move(make)) {}
    void rewind() override { at_ = 0; }
    void next(TriangleMesh<T>& part) override {
        part.vertices.clear(), part.triangles.clear(), part.faces.clear();
        const std::size_t size = std::min<std::size_t>(this->part_size, count_ - at_);
        for (std::uint32_t i = 0; i < size; ++i) {
            const auto t = make_(at_ + i);
            part.vertices.insert(part.vertices.end(), {t.a, t.b, t.c});
            part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        at_ += static_cast<std::uint32_t>(size);
    }

private:
    std::uint32_t count_, at_ = 0;
    std::function<Triangle<T, 3>(std::uint32_t)> make_;
};

/// Whether the triangles of a file can be streamed: `.stl` and `.stl.gz`, by the extension.
bool can_stream(const std::filesystem::path& path);
/// The triangles of such a file, in its order. `progress` counts the bytes of each pass over it. Opens the
/// file. The stream takes 4 MiB. Throws InputError, naming the file, the place, the fault and a remedy, for
/// every fault of the file: here, or when `next` comes upon it. A facet of other than three corners is one,
/// and so is a coordinate that validate_mesh refuses. T is float or double.
template <class T>
std::unique_ptr<TriangleStream<T>> stream_triangles(const std::filesystem::path& path,
                                                    const Progress& progress = {});

}  // namespace hedgerow
