/// Files of glTF and GLB.
#pragma once

#include <string>
#include <vector>

#include "../gltf_text.h"
#include "file.h"

#ifndef HEDGEROW_HAS_DRACO
#define HEDGEROW_HAS_DRACO 0
#endif

namespace hedgerow::testing_corpus {

inline void add_gltf(std::vector<CorpusFile>& all) {
    using namespace testing_gltf;
    add_text(all, {"a.gltf", triangle().text() + "\n", one});
    const auto add = [&](const Gltf& file, const std::vector<ThreeCorners>& triangles,
                         const std::vector<Vec3d>& points = {}) {
        all.push_back({"a.gltf", file.text(), triangles, points});
        all.push_back({"a.glb", file.container(), triangles, points});
    };
    add(triangle(), one);
    const std::string four = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5});
    const auto of_mode = [&](int mode) {
        Gltf file = Gltf().array(four, "VEC3", f4, 4);
        file.primitive += R"(,"mode":)" + std::to_string(mode);
        return file;
    };
    add(of_mode(5), two);
    add(of_mode(4).indices(packed<std::uint8_t>({0, 1, 2, 2, 1, 3}), u1, 6), two);
    add(of_mode(0), {}, {a, b, c, d});
    add(of_mode(0).indices(packed<std::uint16_t>({3, 0, 3}), u2, 3), {}, {d, a, d});
    Gltf moved = of_mode(0);
    moved.nodes = R"({"mesh":0,"translation":[1,0,0]})";
    add(moved, {}, {Vec3d(1, 0, 0), Vec3d(2, 0, 0), Vec3d(1, 1, 0), Vec3d(2, 1, 0.5)});
#if HEDGEROW_HAS_DRACO
    // Two triangles as Google's encoder writes them, in their order.
    std::string draco =
        "DRACO" + packed<std::uint8_t>({2, 2, 1, 0, 0, 0, 2, 4, 1, 0, 1, 2, 2, 1, 3, 1, 1, 0, 9, 3, 0, 0, 0});
    draco += four;
    Gltf compressed = Gltf().view(draco).accessor("VEC3", f4, "4").accessor("SCALAR", u2, "6");
    compressed.primitive +=
        R"(,"indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
    compressed.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
    add(compressed, two);
#endif
    // Accessors without a buffer view are zeros.
    Gltf with_zeros = triangle();
    with_zeros.primitive = R"("attributes":{"POSITION":0,"TEXCOORD_0":1})";
    with_zeros.accessor("VEC2", f4, "3");
    add(with_zeros, one);
    Gltf zeros = Gltf().view("").accessor("VEC3", f4, "3");
    add(zeros, {{a, a, a}});
    Gltf sparse = Gltf().view(packed<std::uint8_t>({1, 2})).view(packed<float>({1, 0, 0, 0, 1, 0}));
    sparse.accessor(
        "VEC3", f4, "3",
        R"(,"sparse":{"count":2,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":1}})");
    add(sparse, one);
}

}  // namespace hedgerow::testing_corpus
