/// Surfaces around points: the field, its surface by blocks, and one mesh of all blocks.
#include <hedgerow/fluid/surface_of.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/rounding.h>
#include <hedgerow/parallel/blocks.h>
#include <hedgerow/parallel/ieee_executor.h>

#include "fairing.h"
#include "marching_tetrahedra.h"

namespace hedgerow {

namespace {

/// Throws UsageError if an option is out of its range, and returns the options with all defaults filled in.
PointSurfaceOptions complete(PointSurfaceOptions options) {
    const auto refuse = [](const char* option, double value, const std::string& remedy) {
        std::ostringstream text;
        text << "a surface around points has the " << option << ' ' << value << ": give " << remedy;
        throw UsageError(text.str());
    };
    const double spacing = options.spacing;
    // Shorter spacings would make subnormal cells, and longer ones infinite coordinates.
    if (!(spacing >= 0x1p-900 && spacing <= largest_coordinate<double>))
        refuse("spacing", spacing, "the distance between neighbouring points, a length above 0");
    if (options.radius == 0) options.radius = 2.5 * spacing;
    if (!(options.radius >= spacing && options.radius <= 16 * spacing))
        refuse("radius", options.radius, "0 for 2.5 spacings, or a length from 1 to 16 spacings");
    if (options.cell == 0) options.cell = spacing / 2;
    if (!(options.cell >= options.radius / 64 && options.cell <= options.radius / 2))
        refuse("cell", options.cell, "0 for half a spacing, or a length from radius / 64 to radius / 2");
    if (!(options.level > 0 && options.level < 1)) refuse("level", options.level, "a number between 0 and 1");
    if (options.smoothing < 0) refuse("smoothing", options.smoothing, "how often to smooth, 0 or more");
    return options;
}

/// The field at a single point whose surface is a ball of volume spacing³.
double field_of_drop(const PointSurfaceOptions& options) {
    const double radius = options.spacing / options.radius * std::cbrt(3 / (4 * std::numbers::pi));
    return options.level / std::pow(1 - radius * radius, 3);
}

/// The surface of a field, found by runs of blocks, with vertices in cells.
class Surfacing {
public:
    Surfacing(const detail::ColourField& field, double level, Executor& executor)
        : blocks_(field.blocks()), runs_{blocks_.size(), 32}, parts_(runs_.number()) {
        runs_.each(executor, [&](std::size_t run, std::size_t begin, std::size_t end) {
            detail::BlockValues values;
            std::size_t points = 0;
            for (std::size_t b = begin; b < end; ++b) {
                field.sample(blocks_[b], values);
                detail::march(values, static_cast<float>(level), blocks_[b], parts_[run]);
                points += field.points_in(blocks_[b]);
            }
            executor.advance(points);
        });
        // Count the vertices and triangles before each run.
        before_.push_back({0, 0});
        for (const auto& part : parts_)
            before_.push_back(
                {before_.back()[0] + part.vertices.size(), before_.back()[1] + part.triangles.size()});
        if (before_.back()[0] > 0xFFFFFFFFu)
            throw InputError("the surface around the points has " + std::to_string(before_.back()[0]) +
                             " vertices, and a mesh holds at most 2^32 - 1: give a longer cell");
        join(executor);
    }

    std::vector<Vec3d> vertices;
    std::vector<TriangleIndices> triangles;

private:
    /// Puts the vertices and triangles of all blocks into one mesh.
    void join(Executor& executor) {
        vertices.resize(before_.back()[0]), triangles.resize(before_.back()[1]);
        runs_.each(executor, [&](std::size_t run, std::size_t begin, std::size_t end) {
            const auto& part = parts_[run];
            std::copy(part.vertices.begin(), part.vertices.end(),
                      vertices.begin() + static_cast<std::ptrdiff_t>(before_[run][0]));
            std::size_t t = 0;
            for (std::size_t b = begin; b < end; ++b) {
                if (t == part.ends[b - begin][1]) continue;
                const Numbers numbers(*this, b);
                for (; t < part.ends[b - begin][1]; ++t)
                    for (std::size_t k = 0; k < 3; ++k)
                        triangles[before_[run][1] + t][k] = numbers.of(part.triangles[t][k]);
            }
        });
        parts_ = {}, blocks_ = {};
    }

    /// The edges with a vertex that a block owns, ascending, and the number of the first of these vertices.
    struct Owned {
        const detail::EdgeCode *begin = nullptr, *end = nullptr;
        std::size_t first = 0;
    };
    Owned owned_by(std::size_t block) const {
        const std::size_t run = block / runs_.size, local = block % runs_.size;
        const auto& part = parts_[run];
        const std::size_t begin = local == 0 ? 0 : part.ends[local - 1][0], end = part.ends[local][0];
        return {part.edges.data() + begin, part.edges.data() + end, before_[run][0] + begin};
    }

    /// The numbers of vertices by the names that one block has for their edges.
    class Numbers {
    public:
        Numbers(const Surfacing& all, std::size_t block) {
            const detail::BlockPlace& here = all.blocks_[block];
            for (int next = 0; next < 8; ++next) {
                const detail::BlockPlace place{here.z + (next >> 2), here.y + (next >> 1 & 1),
                                               here.x + (next & 1)};
                const auto at = std::lower_bound(all.blocks_.begin() + static_cast<std::ptrdiff_t>(block),
                                                 all.blocks_.end(), place);
                if (at != all.blocks_.end() && *at == place)
                    blocks_[static_cast<std::size_t>(next)] =
                        all.owned_by(static_cast<std::size_t>(at - all.blocks_.begin()));
            }
        }
        std::uint32_t of(detail::EdgeCode edge) const {
            const Owned& owned = blocks_[edge >> detail::code_bits];
            const auto code = static_cast<detail::EdgeCode>(edge & ((1 << detail::code_bits) - 1));
            const auto* const at = std::lower_bound(owned.begin, owned.end, code);
            return static_cast<std::uint32_t>(owned.first + static_cast<std::size_t>(at - owned.begin));
        }

    private:
        std::array<Owned, 8> blocks_;
    };

    std::vector<detail::BlockPlace> blocks_;
    Blocks runs_;
    std::vector<detail::SurfaceParts> parts_;
    std::vector<std::array<std::size_t, 2>> before_;
};

template <class T>
PointSurface<T> make_surface(const Strided<Vec<T, 3>>& points, const PointSurfaceOptions& options,
                             Executor& executor) {
    PointSurface<T> surface;
    if (points.size() > 0xFFFFFFFFu)
        throw InputError("a surface is made around at most 2^32 - 1 points, and " +
                         std::to_string(points.size()) + " were given");
    executor.expect((options.drops ? 2 : 1) * points.size());
    detail::ColourField field(points, options.cell, options.radius, options.spacing, executor);
    if (options.drops) field.raise_drops(field_of_drop(options), executor);
    Surfacing found(field, options.level, executor);
    {
        detail::Fairing fairing(found.vertices, found.triangles, executor);
        fairing.smooth(options.smoothing);
        surface.normals = fairing.normals();
    }
    surface.mesh.vertices.resize(found.vertices.size());
    for (std::size_t v = 0; v < found.vertices.size(); ++v)
        surface.mesh.vertices[v] = Vec<T, 3>(found.vertices[v] * options.cell);
    surface.mesh.triangles = std::move(found.triangles);
    return surface;
}

}  // namespace

namespace detail {

template <std::floating_point T>
PointSurface<T> surface_around(const Strided<Vec<T, 3>>& points, const PointSurfaceOptions& options,
                               Threads threads) {
    return in_ieee_mode([&] {
        IeeeExecutor executor(threads.over(points.size()));
        return make_surface(points, complete(options), executor);
    });
}

template PointSurface<float> surface_around(const Strided<Vec<float, 3>>&, const PointSurfaceOptions&,
                                            Threads);
template PointSurface<double> surface_around(const Strided<Vec<double, 3>>&, const PointSurfaceOptions&,
                                             Threads);

}  // namespace detail

}  // namespace hedgerow
