/// hedgerow info: what is in a scene, and what is wrong with it.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/io/index_file.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

template <class P>
ordered_json extent_of(const P& set) {
    Box<typename P::Scalar, P::dimension> box;
    for (std::size_t i = 0; i < set.size(); ++i) box.expand(view_of(set).bounds(i));
    ordered_json low, high;
    for (int k = 0; k < P::dimension; ++k) low.push_back(box.low[k]), high.push_back(box.high[k]);
    return {{"low", low}, {"high", high}};
}

/// How many edges have one triangle, and how many more than two.
struct EdgeFaults {
    std::size_t open = 0, crowded = 0;

    /// O(n log n): equal edges stand side by side once sorted.
    explicit EdgeFaults(const std::vector<TriangleIndices>& triangles) {
        std::vector<std::uint64_t> edges;
        edges.reserve(3 * triangles.size());
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
                edges.push_back(std::uint64_t(a) << 32 | b);
            }
        std::sort(edges.begin(), edges.end());
        for (std::size_t i = 0, end; i < edges.size(); i = end) {
            for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
            open += end - i == 1, crowded += end - i > 2;
        }
    }
};

template <class T>
ordered_json facts(const TriangleMesh<T>& mesh) {
    std::vector<bool> used(mesh.vertices.size());
    std::size_t flat = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        for (const auto corner : mesh.triangles[i]) used[corner] = true;
        flat += length2(Vec3d(mesh.view().normal(i))) == 0;
    }
    const EdgeFaults edges(mesh.triangles);
    return {{"kind", "triangles"},
            {"triangles", mesh.size()},
            {"vertices", mesh.vertices.size()},
            {"zero_area_triangles", flat},
            {"unused_vertices", std::count(used.begin(), used.end(), false)},
            {"open_edges", edges.open},
            {"non_manifold_edges", edges.crowded},
            {"closed", edges.open == 0 && edges.crowded == 0}};
}
template <class T, int D>
ordered_json facts(const SphereSet<T, D>& s) {
    return {{"kind", "spheres"}, {"spheres", s.size()}, {"dimension", D}};
}
template <class T, int D>
ordered_json facts(const PointCloud<T, D>& s) {
    auto sorted = s.points;
    const auto before = [](const auto& a, const auto& b) {
        return std::lexicographical_compare(a.data, a.data + D, b.data, b.data + D);
    };
    std::sort(sorted.begin(), sorted.end(), before);
    const auto distinct = std::unique(sorted.begin(), sorted.end()) - sorted.begin();
    return {{"kind", "points"},
            {"points", s.size()},
            {"dimension", D},
            {"coincident_points", s.size() - static_cast<std::size_t>(distinct)}};
}
template <class T>
ordered_json facts(const SegmentSet<T>& s) {
    return {{"kind", "segments"}, {"segments", s.size()}, {"dimension", 2}};
}

/// Of a saved index, beside its mesh.
ordered_json facts_of_index(const std::string& path) {
    constexpr const char* builders[] = {"fast", "medium", "high"};
    const IndexFileInfo file = index_file_info(path);
    return {{"format_version", file.version},
            {"precision", file.scalar},
            {"face_ids", file.faces},
            {"builder", builders[static_cast<int>(file.options.builder)]},
            {"width", file.options.width},
            {"max_leaf_size", file.options.max_leaf_size},
            {"nodes", file.nodes},
            {"leaves", file.leaves},
            {"depth", file.depth},
            {"index_bytes", file.index_bytes},
            {"file_bytes", file.file_bytes}};
}

}  // namespace

Run add_info(CLI::App& verb) {
    auto c = std::make_shared<Common>();
    add_common(verb, *c, false);
    return [c] {
        return in_precision(*c, [&]<class T>(T) {
            ordered_json all = std::visit(
                [](const auto& set) {
                    auto j = facts(set);
                    j.update(extent_of(set));
                    return j;
                },
                load<T>(*c));
            if (names_index_file(c->scene)) all.update(facts_of_index(c->scene));
            if (c->json) {
                fmt::print("{}\n", all.dump(2));
            } else {
                for (const auto& [key, value] : all.items()) fmt::print("{:22} {}\n", key, value.dump());
            }
            return 0;
        });
    };
}

}  // namespace hedgerow::cli
