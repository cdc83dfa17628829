/// Helpers for tests of binary and wide BVHs.
#pragma once

#include <hedgerow/scenes/meshes.h>
#include <hedgerow/scenes/sets.h>

#include "backwards.h"
#include "contract.h"

namespace hedgerow::trees {

inline BvhOptions options_of(BvhBuilder builder, int reinsertion = 0) {
    BvhOptions options;
    options.builder = builder;
    options.reinsertion = reinsertion;
    return options;
}
/// Calls f(options) for every builder of binary trees, with and without reinsertion.
template <class F>
void with_each_builder(F f) {
    for (const auto builder : bvh_builders)
        for (const int reinsertion : {0, 2}) {
            SCOPED_TRACE(testing::Message() << "builder " << int(builder) << ", reinsertion " << reinsertion);
            f(options_of(builder, reinsertion));
        }
}

/// Calls f(options) for every builder and width of wide trees.
template <class F>
void with_each_wide_builder(F f) {
    for (const auto builder : wide_builders)
        for (const int width : wide_widths) {
            SCOPED_TRACE(testing::Message() << "wide, builder " << int(builder) << ", width " << width);
            WideOptions options;
            options.builder = builder, options.width = width, options.reinsertion = 2;
            f(options);
        }
}

/// Long and thin triangles of very different lengths.
inline TriangleMesh<float> needles(std::size_t n) {
    TriangleMesh<float> mesh;
    for (std::size_t i = 0; i < n; ++i) {
        Random random(31, i);
        const Vec3d from(random.uniform(), random.uniform(), random.uniform());
        const double longest = 0.3 * std::pow(random.uniform(), 3);
        const auto first = static_cast<std::uint32_t>(3 * i);
        for (const Vec3d& v :
             {from, from + random.direction<3>() * longest, from + random.direction<3>() * 0.003})
            mesh.vertices.emplace_back(v);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

template <class S>
bool same_below(const S& a, const S& b, NodeRef x, NodeRef y) {
    if (x.first != y.first || x.count != y.count) return false;
    if (x.leaf() || x.empty()) return true;
    for (int i = 0; i < S::width; ++i) {
        if (!same_below(a, b, a.child(x, i), b.child(y, i))) return false;
        if (!a.child(x, i).empty() && a.volumes(x)[i] != b.volumes(y)[i]) return false;
    }
    return true;
}
template <class I>
void expect_same_tree(const I& a, const I& b) {
    EXPECT_TRUE(std::ranges::equal(a.structure().items(), b.structure().items()));
    EXPECT_EQ(a.structure().depth(), b.structure().depth());
    EXPECT_TRUE(same_below(a.structure(), b.structure(), a.structure().root(), b.structure().root()));
}

}  // namespace hedgerow::trees
