/// glTF 2.0 scenes (`.gltf`, `.glb`): every instance of every mesh, in the scene's coordinates. This reader
/// replaces Assimp, which damaged files can crash (docs/design/014-gltf.md).
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include <hedgerow/base/error.h>
#include <hedgerow/geometry/transform.h>
#include <hedgerow/io/load_options.h>

#include "gltf_accessor.h"
#include "gltf_file.h"
#include "memory.h"
#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

using Json = GltfFile::Json;

/// The map that applies b first and then a. Singular matrices are allowed here, but not in a Transform.
Affine<3> after(const Affine<3>& a, const Affine<3>& b) {
    Affine<3> both;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            both.linear[i] = both.linear[i] + b.linear[j] * a.linear[i][static_cast<int>(j)];
    both.shift = a.point(b.shift);
    return both;
}

bool mirrors(const Affine<3>& m) {
    return dot(cross(m.linear[0], m.linear[1]), m.linear[2]) < 0;
}

/// The map translation · rotation · scale. The rotation q is a unit quaternion (x, y, z, w).
Affine<3> from_parts(const std::vector<double>& shift, const std::vector<double>& q,
                     const std::vector<double>& scale) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const auto twice = [](double a, double b) { return 2 * product(a, b); };
    Affine<3> m;
    m.linear[0] = {1 - (twice(y, y) + twice(z, z)), twice(x, y) - twice(z, w), twice(x, z) + twice(y, w)};
    m.linear[1] = {twice(x, y) + twice(z, w), 1 - (twice(x, x) + twice(z, z)), twice(y, z) - twice(x, w)};
    m.linear[2] = {twice(x, z) - twice(y, w), twice(y, z) + twice(x, w), 1 - (twice(x, x) + twice(y, y))};
    for (auto& row : m.linear)
        for (int k = 0; k < 3; ++k) row[k] *= scale[static_cast<std::size_t>(k)];
    m.shift = {shift[0], shift[1], shift[2]};
    return m;
}

Affine<3> transform_of(const GltfFile& file, const Json& node) {
    if (const auto m = file.numbers(node, "matrix", 16)) {  // stored column by column
        Affine<3> map;
        for (std::size_t row = 0; row < 3; ++row) map.linear[row] = {(*m)[row], (*m)[row + 4], (*m)[row + 8]};
        map.shift = {(*m)[12], (*m)[13], (*m)[14]};
        return map;
    }
    using Numbers = std::vector<double>;
    return from_parts(file.numbers(node, "translation", 3).value_or(Numbers{0, 0, 0}),
                      file.numbers(node, "rotation", 4).value_or(Numbers{0, 0, 0, 1}),
                      file.numbers(node, "scale", 3).value_or(Numbers{1, 1, 1}));
}

/// A mesh, and the map that a node applies to it.
struct Placed {
    std::uint64_t mesh;
    Affine<3> to_scene;
};

/// The nodes of a scene that have a mesh. A node comes before its children, and children are in their order.
/// A node that is reached twice is an error: nodes of glTF are strict trees, so no walk runs in circles.
class NodeWalk {
public:
    explicit NodeWalk(const GltfFile& file) : file_(file), seen_(file.count("nodes")) {}

    std::vector<Placed> placed() {
        const Affine<3> identity = from_parts({0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1});
        push(roots(), identity);
        std::vector<Placed> meshes;
        while (!open_.empty()) {
            const auto [number, to_scene] = open_.back();
            open_.pop_back();
            const Json& node = file_.object("nodes", number);
            if (seen_[static_cast<std::size_t>(number)])
                file_.fail("node " + std::to_string(number) + " is reached twice, but nodes are trees");
            seen_[static_cast<std::size_t>(number)] = true;
            const Affine<3> m = after(to_scene, transform_of(file_, node));
            if (const auto mesh = file_.number(node, "mesh")) meshes.push_back({*mesh, m});
            push(file_.ordinals(node, "children"), m);
        }
        return meshes;
    }

private:
    struct Open {
        std::uint64_t node;
        Affine<3> to_scene;
    };

    void push(const std::vector<std::uint64_t>& nodes, const Affine<3>& to_scene) {
        if (open_.size() + nodes.size() > seen_.size()) file_.fail("more nodes are named than there are");
        std::transform(nodes.rbegin(), nodes.rend(), std::back_inserter(open_), [&](std::uint64_t n) {
            return Open{n, to_scene};
        });
    }
    /// The nodes of the default scene, or of the first scene if there is no default. Without scenes, the
    /// nodes that have no parent.
    std::vector<std::uint64_t> roots() const {
        if (file_.count("scenes") > 0)
            return file_.ordinals(file_.object("scenes", file_.scene().value_or(0)), "nodes");
        std::vector<bool> child(seen_.size());
        for (std::size_t i = 0; i < seen_.size(); ++i)
            for (const std::uint64_t n : file_.ordinals(file_.object("nodes", i), "children"))
                if (n < child.size()) child[static_cast<std::size_t>(n)] = true;
        std::vector<std::uint64_t> all;
        for (std::size_t i = 0; i < child.size(); ++i)
            if (!child[i]) all.push_back(i);
        return all;
    }

    const GltfFile& file_;
    std::vector<bool> seen_;
    std::vector<Open> open_;
};

/// How the indices of a primitive make triangles. The values are glTF's.
enum class Mode : std::uint64_t { triangles = 4, strip = 5, fan = 6 };

std::uint64_t triangle_count(Mode mode, std::uint64_t corners) {
    return mode == Mode::triangles ? corners / 3 : corners < 3 ? 0 : corners - 2;
}

/// The corners of triangle i, as ordinals among the primitive's indices.
std::array<std::uint64_t, 3> corners_of(Mode mode, std::uint64_t i) {
    if (mode == Mode::triangles) return {3 * i, 3 * i + 1, 3 * i + 2};
    if (mode == Mode::fan) return {0, i + 1, i + 2};
    return i % 2 == 0 ? std::array{i, i + 1, i + 2} : std::array{i + 1, i, i + 2};
}

/// A primitive of triangles.
struct Part {
    Mode mode;
    const GltfAccessor* positions;
    const GltfAccessor* indices;  // null: the positions are the corners, in their order
    std::uint64_t triangles;
};

/// The parts of a mesh that have triangles, and the number of these triangles.
struct Mesh {
    std::vector<Part> parts;
    std::uint64_t triangles = 0;
};

template <class T>
class GltfReader {
public:
    GltfReader(ByteSource& source, const std::filesystem::path& path)
        : source_(source), file_(source, path) {}

    TriangleMesh<T> read() {
        const std::vector<Placed> instances = NodeWalk(file_).placed();
        expect_room(instances);
        for (const Placed& p : instances)
            for (const Part& part : mesh_of(p.mesh).parts) add_part(part, p.to_scene);
        TriangleMesh<T> mesh;
        mesh.vertices = welder_.take();
        faces_.move_to(mesh);
        return mesh;
    }

private:
    /// Counts the triangles of all instances before any is made, because a few bytes can name a mesh many
    /// times. Each mesh is read from the JSON once.
    void expect_room(const std::vector<Placed>& instances) {
        std::uint64_t triangles = 0;
        for (const Placed& p : instances) {
            source_.expect_not_cancelled();
            triangles += mesh_of(p.mesh).triangles;
            check_room(source_, triangles, "triangles, all instances written out");
        }
        expect_memory(file_.name(),
                      "its " + std::to_string(triangles) + " triangles, all instances written out,",
                      triangles * sizeof(TriangleIndices));
    }
    const Mesh& mesh_of(std::uint64_t number) {
        const auto [found, is_new] = meshes_.try_emplace(number);
        if (is_new) found->second = read_mesh(number);
        return found->second;
    }
    const GltfAccessor& accessor_of(std::uint64_t number, int components) {
        return accessors_.try_emplace({number, components}, file_, number, components).first->second;
    }

    Mesh read_mesh(std::uint64_t number) {
        const Json& object = file_.object("meshes", number);
        const std::string name = "mesh " + std::to_string(number);
        const auto primitives = object.find("primitives");
        if (primitives == object.end() || !primitives->is_array()) file_.fail(name + " has no 'primitives'");
        Mesh mesh;
        for (const Json& primitive : *primitives) {
            // Check the primitive and find its positions.
            if (!primitive.is_object()) file_.fail("a primitive of " + name + " is no object");
            const std::uint64_t mode = file_.number_or(primitive, "mode", 4);
            if (mode > 6)
                file_.fail("a primitive has mode " + std::to_string(mode) + ", but modes are 0 to 6");
            const auto attributes = primitive.find("attributes");
            if (attributes == primitive.end() || !attributes->is_object())
                file_.fail("a primitive of " + name + " has no 'attributes'");
            const auto positions = file_.number(*attributes, "POSITION");
            if (mode < 4 || !positions) continue;  // points or lines, or nothing to draw
            // Keep the parts that have triangles.
            const Part part = read_part(primitive, static_cast<Mode>(mode), accessor_of(*positions, 3));
            if (part.triangles == 0) continue;
            mesh.parts.push_back(part);
            mesh.triangles += part.triangles;
        }
        return mesh;
    }
    Part read_part(const Json& primitive, Mode mode, const GltfAccessor& positions) {
        const auto number = file_.number(primitive, "indices");
        const GltfAccessor* const indices = number ? &accessor_of(*number, 1) : nullptr;
        if (indices != nullptr && !indices->has_ordinals())
            file_.fail("the indices of a primitive are of a type that indices cannot have");
        const std::uint64_t corners = (indices != nullptr ? *indices : positions).size();
        if (mode == Mode::triangles && corners % 3 != 0)
            file_.fail("a primitive of triangles has " + std::to_string(corners) +
                       " corners, which is no multiple of 3");
        return {mode, &positions, indices, triangle_count(mode, corners)};
    }

    void add_part(const Part& part, const Affine<3>& to_scene) {
        const bool mirrored = mirrors(to_scene);  // a mirror turns fronts into backs, so turn them again
        for (std::uint64_t i = 0; i < part.triangles; ++i) {
            if (i % 65536 == 0) source_.expect_not_cancelled();
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint64_t corner = corners_of(part.mode, i)[k];
                const auto named = part.indices != nullptr
                                       ? static_cast<std::uint64_t>(part.indices->value(corner, 0))
                                       : corner;
                triangle[k] = vertex(*part.positions, named, to_scene);
            }
            if (mirrored) std::swap(triangle[0], triangle[2]);
            faces_.add(triangle);
        }
    }
    std::uint32_t vertex(const GltfAccessor& positions, std::uint64_t i, const Affine<3>& to_scene) {
        if (i >= positions.size())
            file_.fail("face " + std::to_string(faces_.face_count()) + " names vertex " + std::to_string(i) +
                       ", but its mesh has only " + std::to_string(positions.size()));
        check_room(source_, welder_.size(), "vertices");
        const Vec3d p = to_scene.point(positions.point(i));
        return welder_.vertex({rounded<T>(p[0]), rounded<T>(p[1]), rounded<T>(p[2])});
    }

    ByteSource& source_;
    GltfFile file_;
    std::map<std::uint64_t, Mesh> meshes_;
    std::map<std::pair<std::uint64_t, int>, GltfAccessor> accessors_;  // by number and components
    Welder<T> welder_{source_};
    FaceList faces_{source_};
};

}  // namespace

template <class T>
TriangleMesh<T> read_gltf(ByteSource& file, const std::filesystem::path& path) {
    return GltfReader<T>(file, path).read();
}

template TriangleMesh<float> read_gltf(ByteSource&, const std::filesystem::path&);
template TriangleMesh<double> read_gltf(ByteSource&, const std::filesystem::path&);

}  // namespace hedgerow::detail
