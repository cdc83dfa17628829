#include <hedgerow/io/triangle_stream.h>

#include <cmath>

#include <hedgerow/base/error.h>

#include "load_report.h"
#include "readers.h"
#include "stl_facets.h"

namespace hedgerow {

namespace {

template <class T>
class StlStream final : public TriangleStream<T> {
public:
    StlStream(const std::filesystem::path& path, const Progress& progress)
        : path_(path), progress_(progress) {
        StlStream::rewind();
    }
    void rewind() override {
        facets_.reset();
        file_ = std::make_unique<detail::ByteSource>(path_, progress_);
        facets_.emplace(*file_);
        facet_ = 0, box_ = {};
    }
    void next(TriangleMesh<T>& part) override {
        part.vertices.clear(), part.triangles.clear(), part.faces.clear();
        for (std::uint32_t i = 0; i < this->part_size && facets_->next(corners_); ++i, ++facet_) {
            check();
            for (const Vec<T, 3>& p : corners_) box_.expand(Vec3d(p));
            part.vertices.insert(part.vertices.end(), corners_.begin(), corners_.end());
            part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        if (part.size() == 0 && facet_ == 0)
            file_->fail("holds neither faces nor points. Is it the right file?");
    }
    LoadReport report() override { return detail::report_of(*file_, box_, 3 * facet_); }

private:
    void check() const {
        detail::check_room(*file_, facet_ + 1, "triangles");
        const std::string facet = "facet " + std::to_string(facet_);
        if (corners_.size() != 3)
            file_->fail(facet + " has " + std::to_string(corners_.size()) +
                        " corners, and only triangles can be streamed. Load the whole file instead");
        for (const Vec<T, 3>& p : corners_)
            for (int k = 0; k < 3; ++k)
                if (!(std::abs(p[k]) <= largest_coordinate<T>))  // NaN too
                    file_->fail(facet + " has the coordinate " + detail::shortest_text(p[k]) +
                                ", which is not within " + (std::is_same_v<T, float> ? "±2^60" : "±2^480") +
                                ". Repair the file");
    }

    std::filesystem::path path_;
    Progress progress_;
    std::unique_ptr<detail::ByteSource> file_;
    std::optional<detail::StlFacets<T>> facets_;
    std::vector<Vec<T, 3>> corners_;
    std::uint64_t facet_ = 0;
    Box3d box_;  // of the facets that have been read
};

}  // namespace

bool can_stream(const std::filesystem::path& path) {
    return detail::format_of(path) == ".stl";
}
template <class T>
std::unique_ptr<TriangleStream<T>> stream_triangles(const std::filesystem::path& path,
                                                    const Progress& progress) {
    if (!can_stream(path))
        throw InputError(path.string() +
                         ": only .stl and .stl.gz can be streamed. Load the whole file instead");
    detail::check_readable(path);
    return std::make_unique<StlStream<T>>(path, progress);
}
template std::unique_ptr<TriangleStream<float>> stream_triangles(const std::filesystem::path&,
                                                                 const Progress&);
template std::unique_ptr<TriangleStream<double>> stream_triangles(const std::filesystem::path&,
                                                                  const Progress&);

}  // namespace hedgerow
