/// Rasterising triangles that come a part at a time: a picture of more than fits in memory.
#pragma once

#include <algorithm>
#include <vector>

#include <hedgerow/io/triangle_stream.h>
#include <hedgerow/render/shading/surfaces.h>
#include <hedgerow/render/visibility/rasterise.h>

namespace hedgerow {

/// Finds what is visible of a stream, and keeps the triangles that are: those that shading asks for. A set of
/// samples takes two passes over the stream: one that draws, and one that fetches what is seen. The element
/// of a hit is the number of its triangle. Takes the rasteriser's memory, a part of the stream, and for each
/// sample its hit and at most one triangle. Borrows the stream.
template <std::floating_point T>
class RasterisingStream final : public WholePictures<T>, public Surfaces<T> {
public:
    explicit RasterisingStream(TriangleStream<T>& stream) : stream_(stream) {}

    void prepare(const PictureSamples<T>& samples, Executor& executor, PictureCosts& costs) override {
        const std::span<Hit<T>> hits = this->hits_of(samples);
        Rasteriser<T> rasteriser(samples);
        RasterOptions options;
        rasteriser.draw(TriangleMeshView<T>(), hits, {.threads = executor});  // clears the hits
        options.onto = true;
        stream_.for_each_part([&](const TriangleMesh<T>& part, std::uint32_t first) {
            options.first_element = first;
            costs.drawn += rasteriser.draw(part.view(), hits, options);
        });
        fetch(hits);
    }
    /// The box of all triangles, by a pass over the stream.
    Box<T, 3> bounds() const override {
        Box<T, 3> box;
        stream_.for_each_part([&](const TriangleMesh<T>& part, std::uint32_t) {
            for (const auto& p : part.vertices) box.expand(p);
        });
        return box;
    }
    Vec<T, 3> normal(const Ray<T, 3>& ray, const Hit<T>& hit) const override {
        return SurfacesOf(seen_).normal(ray, among_seen(hit));
    }
    Box<T, 3> bounds(const Hit<T>& hit) const override { return SurfacesOf(seen_).bounds(among_seen(hit)); }

private:
    /// The hit with its place among the triangles that are seen as its element.
    Hit<T> among_seen(Hit<T> hit) const {
        hit.element = static_cast<std::uint32_t>(
            std::lower_bound(elements_.begin(), elements_.end(), hit.element) - elements_.begin());
        return hit;
    }
    /// Keeps the triangles that are hit.
    void fetch(std::span<const Hit<T>> hits) {
        elements_.clear();
        for (const Hit<T>& hit : hits)
            if (hit && (elements_.empty() || elements_.back() != hit.element))
                elements_.push_back(hit.element);
        std::sort(elements_.begin(), elements_.end());
        elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
        seen_.vertices.clear(), seen_.triangles.clear();
        seen_.vertices.reserve(3 * elements_.size()), seen_.triangles.reserve(elements_.size());
        stream_.for_each_part([&](const TriangleMesh<T>& part, std::uint32_t first) {
            for (std::size_t k = seen_.size(); k < elements_.size() && elements_[k] - first < part.size();
                 ++k) {
                const auto corner = static_cast<std::uint32_t>(3 * k);
                const auto begin =
                    part.vertices.begin() + static_cast<std::ptrdiff_t>(3) * (elements_[k] - first);
                seen_.vertices.insert(seen_.vertices.end(), begin, begin + 3);
                seen_.triangles.push_back({corner, corner + 1, corner + 2});
            }
        });
    }

    TriangleStream<T>& stream_;
    std::vector<std::uint32_t> elements_;  // of the triangles that are seen, ascending
    TriangleMesh<T> seen_;                 // these, in this order
};

}  // namespace hedgerow
