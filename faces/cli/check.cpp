#include "check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <hedgerow/ask/pairs.h>
#include <hedgerow/base/error.h>
#include <hedgerow/primitives/boundary.h>

namespace hedgerow::cli {

namespace {

using nlohmann::ordered_json;

/// The number of examples that the table shows of a kind of fault.
constexpr std::size_t shown = 4;

/// The edge of a hole, by its ends.
template <class T>
using Edge = std::array<Vec<T, 3>, 2>;

template <class T>
ordered_json list_of(const Vec<T, 3>& p) {
    return {shortest(p[0]), shortest(p[1]), shortest(p[2])};
}
template <class T>
std::string text_of(const Vec<T, 3>& p) {
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]);
}

/// A closed walk along the edges of a hole.
struct Loop {
    std::size_t edges = 0;
    double length = 0;
    Box3d box;
};

/// Divides edges into loops that visit no vertex twice. Every vertex must have an even number of edges, as
/// those have that belong to an odd number of triangles. O(n log n).
template <class T>
std::vector<Loop> loops_of(const std::vector<Edge<T>>& edges) {
    // Number the vertices by position.
    std::vector<Vec<T, 3>> vertices;
    for (const auto& e : edges) vertices.insert(vertices.end(), e.begin(), e.end());
    const auto before = [](const auto& a, const auto& b) { return detail::comes_before(a, b); };
    std::sort(vertices.begin(), vertices.end(), before);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto number_of = [&](const Vec<T, 3>& p) {
        return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), p, before) -
                                        vertices.begin());
    };
    // List the edges of each vertex.
    std::vector<std::array<std::size_t, 2>> ends;
    std::vector<std::vector<std::size_t>> edges_at(vertices.size());
    for (const auto& e : edges) {
        ends.push_back({number_of(e[0]), number_of(e[1])});
        for (const std::size_t v : ends.back()) edges_at[v].push_back(ends.size() - 1);
    }
    // Walk on unused edges. A vertex that the walk reaches again closes a loop, which is cut off.
    std::vector<Loop> loops;
    std::vector<bool> used(edges.size()), on_path(vertices.size());
    for (std::size_t start = 0; start < edges.size(); ++start) {
        if (used[start]) continue;
        std::vector<std::size_t> path = {ends[start][0]};
        on_path[path[0]] = true;
        while (!path.empty()) {
            const std::size_t here = path.back();
            auto& left = edges_at[here];
            while (!left.empty() && used[left.back()]) left.pop_back();
            if (left.empty()) {
                on_path[here] = false;
                path.pop_back();
                continue;
            }
            used[left.back()] = true;
            const auto [a, b] = ends[left.back()];
            const std::size_t next = a == here ? b : a;
            if (!on_path[next]) {
                path.push_back(next);
                on_path[next] = true;
                continue;
            }
            Loop loop;
            for (std::size_t from = next, v = path.back();; v = path.back()) {
                const Vec3d p(vertices[v]);
                ++loop.edges, loop.box.expand(p), loop.length += length(p - Vec3d(vertices[from]));
                from = v;
                if (v == next) break;
                on_path[v] = false;
                path.pop_back();
            }
            loops.push_back(loop);
        }
    }
    return loops;
}

/// The parts of a mesh that hang together by edges, and how many of them are closed and turned inside out.
struct Parts {
    std::size_t all = 0, closed = 0, inward = 0;
    PrimitiveId first_inward = no_primitive;
};
template <class T>
Parts parts_of(const TriangleMeshView<T>& mesh, Executor& executor) {
    // Join the triangles at each edge, and remember those at edges that are open or turned.
    std::vector<PrimitiveId> parent(mesh.size());
    std::iota(parent.begin(), parent.end(), PrimitiveId(0));
    const auto root_of = [&](PrimitiveId i) {
        for (; parent[i] != i; i = parent[i]) parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<PrimitiveId> at_faults;
    for_each_edge(mesh, executor, [&](const auto& sides) {
        if (sides[0].points[0] == sides[0].points[1]) return;
        std::int64_t along = 0;
        for (const auto& side : sides) {
            along += side.direction;
            const auto a = root_of(sides[0].element), b = root_of(side.element);
            parent[std::max(a, b)] = std::min(a, b);
        }
        if (along != 0) at_faults.push_back(sides[0].element);
    });
    std::vector<bool> faulty(mesh.size());
    for (const PrimitiveId i : at_faults) faulty[root_of(i)] = true;
    // Sum up the volume of each part, seen from a vertex of its first triangle.
    std::vector<double> volume(mesh.size()), size(mesh.size());
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const PrimitiveId root = root_of(static_cast<PrimitiveId>(i));
        const Vec3d origin(mesh.corners(root)[0]);
        const auto t = mesh.triangle(i);
        const double term = dot(Vec3d(t.a) - origin, cross(Vec3d(t.b) - origin, Vec3d(t.c) - origin));
        volume[root] += term, size[root] += std::abs(term);
    }
    Parts parts;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (parent[i] != i) continue;
        ++parts.all;
        if (faulty[i]) continue;
        ++parts.closed;
        if (!(volume[i] < -1e-9 * size[i])) continue;  // beyond what roundings make of a part without volume
        if (parts.inward++ == 0) parts.first_inward = static_cast<PrimitiveId>(i);
    }
    return parts;
}

/// The pairs (first, again) of triangles with the same three corners, in any order. O(n).
template <class T>
std::vector<ElementPair> duplicates_of(const TriangleMeshView<T>& mesh, Executor& executor) {
    std::vector<ElementPair> found;
    const auto corners = [&](PrimitiveId element, std::uint32_t) {
        detail::Part<T, 3, 3> part{mesh.corners(element), 1};
        std::sort(part.points.begin(), part.points.end(),
                  [](const auto& a, const auto& b) { return detail::comes_before(a, b); });
        return part;
    };
    detail::for_each_place(mesh.size(), 1, executor, corners, [&](const auto& alike) {
        PrimitiveId first = alike[0].element;
        for (const auto& part : alike) first = std::min(first, part.element);
        for (const auto& part : alike)
            if (part.element != first) found.push_back({first, part.element});
    });
    std::sort(found.begin(), found.end());
    return found;
}

/// Runs `look` on an executor that shows what it looks for.
template <class F>
auto watched(const Common& c, const std::string& what, F look) {
    ProgressLine line("looking for " + what, c.quiet);
    line.say("");
    WatchedExecutor executor(default_executor(), line.progress());
    executor.expect(0);
    return look(executor);
}

}  // namespace

template <class T>
MeshFaults faults_of(const Common& c, const TriangleMesh<T>& mesh) {
    const TriangleMeshView<T> view = mesh.view();
    MeshFaults faults;
    const auto id = [&](PrimitiveId i) { return reported_id(view, i, 0); };
    const auto add = [&](const char* key, const char* kind, std::size_t count, std::string where) {
        faults.lines.push_back({kind, count, count > 0 ? std::move(where) : std::string()});
        faults.facts[key] = count;
    };
    const auto first_of = [&](const std::vector<PrimitiveId>& ids) {
        std::vector<std::uint32_t> first;
        for (std::size_t i = 0; i < std::min(shown, ids.size()); ++i) first.push_back(id(ids[i]));
        return first;
    };
    const auto first_pairs = [&](const std::vector<ElementPair>& pairs) {
        std::vector<std::array<std::uint32_t, 2>> first;
        for (std::size_t i = 0; i < std::min(shown, pairs.size()); ++i)
            first.push_back({id(pairs[i].a), id(pairs[i].b)});
        return first;
    };
    const auto written = [](const auto& examples, std::size_t count) {
        std::string text;
        for (const auto& e : examples) {
            if (!text.empty()) text += ", ";
            if constexpr (requires { e[1]; })
                text += fmt::format("{} and {}", e[0], e[1]);
            else
                text += fmt::format("{}", e);
        }
        return text + (count > examples.size() ? ", ..." : "");
    };

    // Edges: those that belong to an odd number of triangles surround holes.
    const auto boundary =
        watched(c, "open edges", [&](Executor& executor) { return boundary_of(view, executor); });
    std::vector<Edge<T>> odd;
    std::optional<Edge<T>> turned;
    for (const auto& e : boundary.open) {
        if (e.times % 2 != 0) odd.push_back(e.corners);
        if (e.times > 1 && !turned) turned = e.corners;
    }
    const std::vector<Loop> loops = loops_of(odd);
    std::string holes;
    ordered_json longest_loop;
    if (!loops.empty()) {
        const Loop& longest = *std::max_element(
            loops.begin(), loops.end(), [](const Loop& a, const Loop& b) { return a.length < b.length; });
        holes = fmt::format("{} loop{}; the longest: {} edges, {:.4g} long, around {}", loops.size(),
                            loops.size() == 1 ? "" : "s", longest.edges, longest.length,
                            text_of(longest.box.center()));
        longest_loop = {
            {"edges", longest.edges}, {"length", longest.length}, {"around", list_of(longest.box.center())}};
    }
    add("open_edges", "open edges", odd.size(), holes);
    faults.facts["holes"] = loops.size();
    faults.facts["longest_hole"] = longest_loop;
    add("turned_edges", "edges run along one way", boundary.turned,
        turned ? fmt::format("the first from {} to {}", text_of((*turned)[0]), text_of((*turned)[1]))
               : std::string());
    if (turned) faults.facts["first_turned_edge"] = {list_of((*turned)[0]), list_of((*turned)[1])};

    const Parts parts =
        watched(c, "parts inside out", [&](Executor& executor) { return parts_of(view, executor); });
    faults.facts["parts"] = parts.all;
    faults.facts["closed_parts"] = parts.closed;
    add("inward_parts", "parts turned inward", parts.inward,
        parts.inward > 0 ? fmt::format("of {} closed; inside out, or a cavity: that of triangle {}",
                                       parts.closed, id(parts.first_inward))
                         : std::string());

    // Triangles without area, and twice.
    std::vector<PrimitiveId> flat;
    for (std::size_t i = 0; i < mesh.size(); ++i)
        if (length2(Vec3d(view.normal(i))) == 0) flat.push_back(static_cast<PrimitiveId>(i));
    const auto first_flat = first_of(flat);
    add("zero_area_triangles", "triangles without area", flat.size(), written(first_flat, flat.size()));
    if (!flat.empty()) faults.facts["first_zero_area_triangles"] = first_flat;
    const auto twice =
        watched(c, "duplicates", [&](Executor& executor) { return duplicates_of(view, executor); });
    const auto first_twice = first_pairs(twice);
    add("duplicated_triangles", "duplicated triangles", twice.size(), written(first_twice, twice.size()));
    if (!twice.empty()) faults.facts["first_duplicates"] = first_twice;

    // Vertices.
    std::vector<bool> used(mesh.vertices.size());
    for (const auto& t : mesh.triangles)
        for (const auto v : t) used[v] = true;
    std::size_t unused = 0, not_finite = 0, first_unused = 0, first_not_finite = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (!used[v] && unused++ == 0) first_unused = v;
        if (!finite(mesh.vertices[v]) && not_finite++ == 0) first_not_finite = v;
    }
    add("unused_vertices", "unused vertices", unused, fmt::format("the first: {}", first_unused));
    add("vertices_not_finite", "vertices not finite", not_finite,
        fmt::format("the first: {}", first_not_finite));

    // Intersections.
    const auto index =
        watched(c, "neighbours", [&](Executor& executor) { return build<WideBvh>(view, {}, executor); });
    std::vector<ElementPair> pairs;
    watched(c, "self-intersections",
            [&](Executor& executor) { return self_intersections(index, pairs, {.threads = executor}); });
    const auto first_crossing = first_pairs(pairs);
    add("self_intersections", "self-intersections", pairs.size(), written(first_crossing, pairs.size()));
    if (!pairs.empty()) faults.facts["first_self_intersections"] = first_crossing;
    return faults;
}
template MeshFaults faults_of(const Common&, const TriangleMesh<float>&);
template MeshFaults faults_of(const Common&, const TriangleMesh<double>&);

void print_faults(const MeshFaults& faults) {
    std::size_t kinds = 0;
    for (const auto& line : faults.lines) {
        fmt::print("{}\n", line.where.empty()
                               ? fmt::format("{:24} {}", line.kind, line.count)
                               : fmt::format("{:24} {:<9} {}", line.kind, line.count, line.where));
        kinds += line.count > 0;
    }
    fmt::print("{}\n", kinds == 0 ? std::string("no faults")
                                  : fmt::format("{} kind{} of faults", kinds, kinds == 1 ? "" : "s"));
}

}  // namespace hedgerow::cli
