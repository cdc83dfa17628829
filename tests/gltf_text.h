/// Makes glTF files from their parts, and a table of files with the triangles that they have.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/geometry/vec.h>

#include "io_support.h"

namespace hedgerow::testing_gltf {

/// The bytes of numbers in a buffer.
template <class U>
std::string packed(std::initializer_list<U> numbers) {
    std::string bytes;
    for (const U x : numbers) testing_io::append(bytes, x);
    return bytes;
}

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

/// A file of one scene, with one mesh of one primitive and one buffer. Each member holds JSON, or a list of
/// JSON values without its brackets.
struct Gltf {
    std::string roots = "0", nodes = R"({"mesh":0})";
    std::string primitive = R"("attributes":{"POSITION":0})";  // the primitive's members
    std::string views, accessors;
    std::string more;                // members of the root, each after a comma
    std::string buffer;              // bytes
    std::optional<std::string> uri;  // of the buffer; without one, a data URI has it
    int view_count = 0;

    /// Appends bytes to the buffer, and a view of them. `members` are further members of the view, each after
    /// a comma.
    Gltf& view(const std::string& bytes, const std::string& members = "") {
        views += std::string(view_count++ == 0 ? "" : ",") + R"({"buffer":0,"byteOffset":)" +
                 std::to_string(buffer.size()) + R"(,"byteLength":)" + std::to_string(bytes.size()) +
                 members + "}";
        buffer += bytes;
        return *this;
    }
    Gltf& accessor(const std::string& type, int component, const std::string& count,
                   const std::string& members = "") {
        accessors += std::string(accessors.empty() ? "" : ",") + R"({"type":")" + type +
                     R"(","componentType":)" + std::to_string(component) + R"(,"count":)" + count + members +
                     "}";
        return *this;
    }
    /// An accessor with a view of its own.
    Gltf& array(const std::string& bytes, const std::string& type, int component, std::size_t count,
                const std::string& members = "", const std::string& view_members = "") {
        const std::string number = std::to_string(view_count);
        return view(bytes, view_members)
            .accessor(type, component, std::to_string(count), R"(,"bufferView":)" + number + members);
    }
    Gltf& indices(const std::string& bytes, int component, std::size_t count,
                  const std::string& members = "") {
        primitive += R"(,"indices":1)";
        return array(bytes, "SCALAR", component, count, members);
    }

    /// A `.gltf` file.
    std::string text() const {
        return json(R"(,"uri":")" + uri.value_or("data:application/octet-stream;base64," + base64(buffer)) +
                    "\"");
    }
    /// A `.glb` file with the buffer in it.
    std::string container() const {
        std::string chunk = json(""), body = buffer;
        chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
        body.resize((body.size() + 3) / 4 * 4, '\0');
        const auto word = [](std::size_t x) {
            return packed<std::uint32_t>({static_cast<std::uint32_t>(x)});
        };
        return "glTF" + word(2) + word(28 + chunk.size() + body.size()) +  //
               word(chunk.size()) + "JSON" + chunk + word(body.size()) + std::string("BIN\0", 4) + body;
    }

private:
    std::string json(const std::string& members_of_buffer) const {
        return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
               R"(],"meshes":[{"primitives":[{)" + primitive + R"(}]}],"buffers":[{"byteLength":)" +
               std::to_string(buffer.size()) + members_of_buffer + R"(}],"bufferViews":[)" + views +
               R"(],"accessors":[)" + accessors + "]" + more + "}";
    }
};

constexpr int i1 = 5120, u1 = 5121, i2 = 5122, u2 = 5123, u4 = 5125, f4 = 5126;  // component types

/// A triangle with corners at (0, 0, 0), (1, 0, 0) and (0, 1, 0). The accessor's `count` of corners may be
/// wrong.
inline Gltf triangle(const std::string& count = "3") {
    return Gltf()
        .view(packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}))
        .accessor("VEC3", f4, count, R"(,"bufferView":0)");
}

using ThreeCorners = std::array<Vec3d, 3>;

struct GltfCase {
    std::string name;
    Gltf file;
    std::vector<ThreeCorners> triangles;
};

/// Files of every kind that is read.
inline std::vector<GltfCase> gltf_cases() {
    const Vec3d a(1, 2, 3), b(4, 2, 3), c(1, 7, 3), d(6, 8, 3), e(5, 9, 4);
    const std::string abc = packed<float>({1, 2, 3, 4, 2, 3, 1, 7, 3});
    const std::string five = abc + packed<float>({6, 8, 3, 5, 9, 4});
    const std::string backwards = packed<std::uint16_t>({4, 3, 2, 1, 0});
    const auto corners = [&] { return Gltf().array(abc, "VEC3", f4, 3); };
    const auto of_mode = [&](int mode) {
        Gltf file = Gltf().array(five, "VEC3", f4, 5);
        file.primitive += R"(,"mode":)" + std::to_string(mode);
        return file;
    };
    const auto indexed = [&](int mode) { return of_mode(mode).indices(backwards, u2, 5); };
    const auto on_nodes = [](Gltf file, const std::string& nodes) {
        file.nodes = nodes;
        return file;
    };
    const auto flipped = [](ThreeCorners t) {  // by a scale of −1 along x, with its front kept
        for (Vec3d& p : t) p[0] = -p[0];
        return ThreeCorners{t[2], t[1], t[0]};
    };
    const std::string mirror = R"({"mesh":0,"scale":[-1,1,1]})";
    const std::vector<ThreeCorners> one{{a, b, c}}, strip{{a, b, c}, {c, b, d}, {c, d, e}},
        fan{{a, b, c}, {a, c, d}, {a, d, e}}, strip_back{{e, d, c}, {c, d, b}, {c, b, a}},
        fan_back{{e, d, c}, {e, c, b}, {e, b, a}};

    // Triangles, strips and fans, with and without indices and mirrors.
    std::vector<GltfCase> all{
        {"triangles", corners(), one},
        {"strip", of_mode(5), strip},
        {"fan", of_mode(6), fan},
        {"indexed strip", indexed(5), strip_back},
        {"indexed fan", indexed(6), fan_back},
        {"mirrored strip",
         on_nodes(of_mode(5), mirror),
         {flipped(strip[0]), flipped(strip[1]), flipped(strip[2])}},
        {"mirrored indexed fan",
         on_nodes(indexed(6), mirror),
         {flipped(fan_back[0]), flipped(fan_back[1]), flipped(fan_back[2])}},
        {"two instances, one mirrored",
         on_nodes(corners(), R"({"children":[1,2.0]},{"mesh":0},)" + mirror),
         {one[0], flipped(one[0])}},
    };

    // Scaled by (2, 3, 4), turned by 120° about (1, 1, 1), which takes x to y to z to x, and moved.
    const std::vector<ThreeCorners> turned{{Vec3d(22, 2, 6), Vec3d(22, 8, 6), Vec3d(22, 2, 21)}};
    const std::string parent = R"({"translation":[10,0,0],"children":[1]},)";
    all.push_back({"rotation and scale in a moved node",
                   on_nodes(corners(), parent + R"({"mesh":0,"rotation":[0.5,0.5,0.5,0.5],"scale":[2,3,4]})"),
                   turned});
    all.push_back(
        {"matrix", on_nodes(corners(), R"({"mesh":0,"matrix":[0,2,0,0,0,0,3,0,4,0,0,0,10,0,0,1]})"), turned});

    // Numbers of every type, as they are and normalized.
    const auto numbers = [&]<class U>(const std::string& name, int type, U most, U least) {
        const std::string bytes = packed<U>({0, 0, 0, most, 0, 0, 0, least, U(least / 2)});
        const double low = least, half = U(least / 2);
        all.push_back({"not normalized " + name,
                       Gltf().array(bytes, "VEC3", type, 3),
                       {{Vec3d(0, 0, 0), Vec3d(most, 0, 0), Vec3d(0, low, half)}}});
        if (type == f4 || type == u4) return;
        const double whole = most;
        all.push_back(
            {"normalized " + name,
             Gltf().array(bytes, "VEC3", type, 3, R"(,"normalized":true)"),
             {{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, std::max(low / whole, -1.0), half / whole)}}});
    };
    numbers("i1", i1, std::int8_t(127), std::int8_t(-128));
    numbers("u1", u1, std::uint8_t(255), std::uint8_t(51));
    numbers("i2", i2, std::int16_t(32767), std::int16_t(-32768));
    numbers("u2", u2, std::uint16_t(65535), std::uint16_t(13107));
    numbers("u4", u4, std::uint32_t(4294967295u), std::uint32_t(77777777));
    numbers("f4", f4, 0.5f, -0.25f);

    // Indices of the other types.
    const std::vector<ThreeCorners> around{{b, c, a}};
    all.push_back({"u1 indices", corners().indices(packed<std::uint8_t>({1, 2, 0}), u1, 3), around});
    all.push_back({"u4 indices", corners().indices(packed<std::uint32_t>({1, 2, 0}), u4, 3), around});

    // A stride with an offset, sparse accessors and a buffer in a file of its own.
    const std::string stripes =
        packed<float>({-1, 1, 2, 3, -1, -1, 4, 2, 3, -1, -1, 1, 7, 3, -1});  // each between other numbers
    all.push_back(
        {"stride and offset",
         Gltf().view("abcd").array(stripes, "VEC3", f4, 3, R"(,"byteOffset":4)", R"(,"byteStride":20)"),
         one});

    const auto replaced = [](const std::string& count) {
        return R"(,"sparse":{"count":)" + count + R"(,"indices":{"bufferView":1,"componentType":5121},)" +
               R"("values":{"bufferView":2}})";
    };
    Gltf over_view = Gltf().array(abc, "VEC3", f4, 3, replaced("1"));
    over_view.view(packed<std::uint8_t>({1})).view(packed<float>({6, 8, 3}));
    all.push_back({"sparse over a view", over_view, {{a, d, c}}});
    Gltf over_zeros = Gltf().view("").accessor("VEC3", f4, "3", replaced("2"));
    over_zeros.view(packed<std::uint8_t>({0, 2})).view(packed<float>({6, 8, 3, 5, 9, 4}));
    all.push_back({"sparse over zeros", over_zeros, {{d, Vec3d(0, 0, 0), e}}});

    Gltf outside = corners();
    outside.uri = "corners%20of.bin";
    all.push_back({"external buffer", outside, one});
    return all;
}

/// Writes the buffer of a file that refers to it by a URI.
inline void write_buffer(const testing_io::TempFolder& folder, const Gltf& gltf) {
    if (gltf.uri) folder.file("corners of.bin", gltf.buffer);
}

}  // namespace hedgerow::testing_gltf
