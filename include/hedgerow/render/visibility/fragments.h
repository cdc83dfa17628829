/// Lists of fragments: for each sample of a picture all triangles that cover it, front to back.
///
/// Carpenter, "The A-buffer, an Antialiased Hidden Surface Method", SIGGRAPH 1984: a list of fragments for
/// each pixel, so that transparent triangles may be drawn in any order. A sample here is a point, so
/// fragments need no masks of coverage. The lists are the hits that `all_hits` finds for the rays of the
/// samples, bit for bit: the same test decides, and the same order of (t, element).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hedgerow/base/bare_vector.h>
#include <hedgerow/queries/first_hits.h>
#include <hedgerow/render/visibility/rasterise.h>

namespace hedgerow {

struct FragmentOptions {
    /// Bytes for the fragments that are in memory at once, each of the size of a Hit (28 in float). The
    /// picture is cut into bands of rows whose fragments fit.
    std::size_t budget = std::size_t(64) << 20;
    Threads threads = {};
};
struct FragmentCounts {
    RasterCounts raster;          ///< of all passes
    std::uint64_t fragments = 0;  ///< in all lists
    std::uint64_t bands = 0;
    std::uint32_t longest = 0;  ///< the length of the longest list
};

/// The lists of some rows of a picture.
template <class T>
class FragmentBand {
public:
    FragmentBand(int top, int bottom, int width, const std::size_t* begins, const Hit<T>* hits)
        : top_(top), bottom_(bottom), width_(width), begins_(begins), hits_(hits) {}

    /// The first and the last row.
    int top() const { return top_; }
    int bottom() const { return bottom_; }
    /// The fragments of a sample in these rows, sorted by (t, element).
    std::span<const Hit<T>> at(int x, int y) const {
        const std::size_t i = static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x);
        return {hits_ + begins_[i], begins_[i + 1] - begins_[i]};
    }

private:
    int top_, bottom_, width_;
    const std::size_t* begins_;
    const Hit<T>* hits_;
};

/// Lists the fragments of pictures with the same samples.
template <class T>
class FragmentLists {
public:
    explicit FragmentLists(const PictureSamples<T>& samples) : samples_(samples), rasteriser_(samples) {}

    /// Calls take(band) with the lists of each band of rows (FragmentBand), from the top of the picture down.
    /// The triangles are drawn once to count the fragments of every sample, and then once for each band.
    /// Memory is that of the rasteriser's rays and boxes, 4 bytes a sample, and for a band 8 bytes a sample
    /// and its fragments. Throws InputError if the fragments of one row exceed the budget, before any band is
    /// taken.
    template <class Triangles, class Take>
    FragmentCounts list(const Triangles& triangles, Take take, const FragmentOptions& options = {}) {
        Executor& executor = options.threads.over(samples_.size());
        FragmentCounts counts;
        if (samples_.size() == 0) return counts;
        lengths_.assign(samples_.size(), 0);
        counts.raster +=
            rasteriser_.for_each_fragment(triangles, 0, samples_.height() - 1, executor,
                                          [&](std::size_t sample, const Hit<T>&) { ++lengths_[sample]; });
        const std::vector<std::uint64_t> rows = fragments_by_row(options);
        for (const std::uint32_t length : lengths_) counts.longest = std::max(counts.longest, length);
        for (int top = 0, bottom; top < samples_.height(); top = bottom + 1, ++counts.bands) {
            // Take rows as long as their fragments fit.
            std::uint64_t sum = rows[static_cast<std::size_t>(top)];
            for (bottom = top; bottom + 1 < samples_.height(); ++bottom) {
                const std::uint64_t more = rows[static_cast<std::size_t>(bottom) + 1];
                if ((sum + more) * sizeof(Hit<T>) > options.budget) break;
                sum += more;
            }
            counts.fragments += sum;
            counts.raster += fill(triangles, top, bottom, sum, executor);
            take(FragmentBand<T>(top, bottom, samples_.width(), begins_.data(), hits_.data()));
        }
        return counts;
    }

private:
    /// The number of fragments in each row. Throws if there are too many in one.
    std::vector<std::uint64_t> fragments_by_row(const FragmentOptions& options) const {
        std::vector<std::uint64_t> rows(static_cast<std::size_t>(samples_.height()));
        for (std::size_t y = 0; y < rows.size(); ++y) {
            for (int x = 0; x < samples_.width(); ++x)
                rows[y] += lengths_[samples_.number(x, static_cast<int>(y))];
            if (const std::uint64_t bytes = rows[y] * sizeof(Hit<T>); bytes > options.budget)
                throw InputError("row " + std::to_string(y) + " of the picture has " +
                                 std::to_string(rows[y]) + " fragments, which take " + std::to_string(bytes) +
                                 " bytes: more than the budget of " + std::to_string(options.budget) +
                                 ". Give a larger budget, or draw a narrower picture");
        }
        return rows;
    }
    /// Fills the lists of some rows, which have `count` fragments.
    template <class Triangles>
    RasterCounts fill(const Triangles& triangles, int top, int bottom, std::uint64_t count,
                      Executor& executor) {
        const std::size_t first = samples_.number(0, top), samples = samples_.number(0, bottom + 1) - first;
        // The places of the lists, one behind the other.
        begins_.resize(samples + 1);
        begins_[0] = 0;
        for (std::size_t i = 0; i < samples; ++i) begins_[i + 1] = begins_[i] + lengths_[first + i];
        if (hits_.capacity() < count) hits_ = {};  // no two arrays at a time
        hits_.resize(count);
        // Write the fragments, each list from its end: its length counts what is left of it.
        const RasterCounts counts = rasteriser_.for_each_fragment(
            triangles, top, bottom, executor, [&](std::size_t sample, const Hit<T>& hit) {
                hits_[begins_[sample - first] + --lengths_[sample]] = hit;
            });
        executor.for_each_piece(samples, 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                std::sort(hits_.data() + begins_[i], hits_.data() + begins_[i + 1],
                          hit_before<Hit<T>, Hit<T>>);
        });
        return counts;
    }

    const PictureSamples<T> samples_;
    Rasteriser<T> rasteriser_;
    std::vector<std::uint32_t> lengths_;  // of the lists of all samples
    // Of the band: where each list begins, and all lists.
    std::vector<std::size_t> begins_;
    BareVector<Hit<T>> hits_;
};

}  // namespace hedgerow
