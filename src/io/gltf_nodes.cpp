#include "gltf_nodes.h"

#include <algorithm>
#include <iterator>

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

class NodeWalk {
public:
    explicit NodeWalk(const GltfFile& file) : file_(file), seen_(file.count("nodes")) {}

    std::vector<GltfPlacedNode> placed() {
        const Affine<3> identity = from_parts({0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1});
        push(roots(), identity);
        std::vector<GltfPlacedNode> found;
        while (!open_.empty()) {
            const auto [number, to_scene] = open_.back();
            open_.pop_back();
            const Json& node = file_.object("nodes", number);
            if (seen_[static_cast<std::size_t>(number)])
                file_.fail("node " + std::to_string(number) + " is reached twice, but nodes are trees");
            seen_[static_cast<std::size_t>(number)] = true;
            const Affine<3> m = after(to_scene, transform_of(file_, node));
            if (node.contains("mesh") || node.contains("camera") || node.contains("extensions"))
                found.push_back({&node, m});
            push(file_.ordinals(node, "children"), m);
        }
        return found;
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

}  // namespace

bool mirrors(const Affine<3>& map) {
    return dot(cross(map.linear[0], map.linear[1]), map.linear[2]) < 0;
}

std::vector<GltfPlacedNode> placed_nodes(const GltfFile& file) {
    return NodeWalk(file).placed();
}

}  // namespace hedgerow::detail
