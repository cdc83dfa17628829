/// Writes a mesh or points as text of every format, in a style.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "styles.h"

namespace hedgerow::hunter {

/// What a file means: triangles by their corners, or points.
using Corners = std::array<Vec3d, 3>;
struct Geometry {
    std::vector<Corners> triangles;
    std::vector<Vec3d> points;

    friend bool operator==(const Geometry&, const Geometry&) = default;
};
/// A mesh, or points if there are no faces.
struct Elements {
    std::vector<Vec3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;

    Geometry geometry() const {
        if (faces.empty()) return {{}, vertices};
        Geometry all;
        for (const auto& [i, j, k] : faces) all.triangles.push_back({vertices[i], vertices[j], vertices[k]});
        return all;
    }
};

inline std::string obj(const Elements& elements, const Style& style) {
    Text text(style);
    const auto put = [&](std::vector<std::string> all) {
        text.between("#");
        static constexpr const char* others[] = {
            "o a\\",      "g b c\\", "usemtl C:\\paint\\", "mtllib C:\\",   "s off", "vn 0 0 1",
            "vt 0 \\\n1", "l 1 1",   "shadow_obj \\",      "curv 0 1 \\\n1"};
        if (text.choice(names, 6) == 1) text.line(others[text.choice(names, std::size(others))]);
        for (std::size_t i = 1; i < all.size(); ++i)
            if (text.choice(joins, 5) == 1) all[i] = "\\\n" + all[i];
        text.line(text.row(all) + text.note("#"));
    };
    const auto put_faces = [&] {
        for (const auto& face : elements.faces) {
            std::vector<std::string> all{"f"};
            for (const std::uint32_t v : face) {
                const bool is_relative = !text.has(order) && text.choice(words, 3) == 1;
                const auto count = static_cast<std::int64_t>(elements.vertices.size());
                all.push_back(std::to_string(is_relative ? v - count : v + 1) +
                              std::array{"", "/1", "//1", "/1/1"}[text.choice(words, 4)]);
            }
            put(all);
        }
    };
    if (text.has(order)) put_faces();
    for (const Vec3d& p : elements.vertices) {
        std::vector<std::string> all = numbers_of(text, p);
        all.insert(all.begin(), "v");
        if (text.choice(words, 4) == 1) all.emplace_back("1");
        put(all);
    }
    if (!text.has(order)) put_faces();
    return text.written();
}

inline std::string off(const Elements& elements, const Style& style) {
    Text text(style);
    const std::string vertices = std::to_string(elements.vertices.size()),
                      faces = std::to_string(elements.faces.size());
    text.between("#");
    switch (text.choice(words, 5)) {
        case 0:
            text.line("OFF" + text.note("#"));
            text.line(text.row({vertices, faces, "0"}) + text.note("#"));
            break;
        case 1:
            text.line(text.row({"OFF", vertices, faces, "0"}));
            break;
        case 2:
            text.line(text.row({vertices, faces, "7"}));
            break;
        case 3:
            for (const std::string& word : {std::string("off"), vertices, faces, std::string("0")})
                text.line(word);
            break;
        default:
            text.line("OFF"), text.line(text.row({vertices, faces}));
    }
    // Several vertices may share a line.
    std::vector<std::string> all;
    const std::uint64_t a_line = 1 + text.choice(joins, 4);
    for (std::size_t i = 0; i < elements.vertices.size(); ++i) {
        const auto some = numbers_of(text, elements.vertices[i]);
        all.insert(all.end(), some.begin(), some.end());
        if ((i + 1) % a_line != 0 && i + 1 < elements.vertices.size()) continue;
        text.between("#");
        text.line(text.row(all) + text.note("#"));
        all.clear();
    }
    for (const auto& face : elements.faces) {
        text.between("#");
        all = {"3"};
        for (const std::uint32_t v : face)
            all.push_back((text.choice(joins, 5) == 1 ? "\n" : "") + std::to_string(v));
        if (text.choice(names, 3) == 1) all.insert(all.end(), {"255", "0", "0"});
        text.line(text.row(all) + text.note("#"));
    }
    return text.written();
}

/// Binary, if there is an order of bytes.
inline std::string ply(const Elements& elements, const Style& style, std::optional<std::endian> bytes) {
    Style of_header = style;
    if (bytes) of_header[last_end] = 0;
    Text text(of_header);
    const bool is_points = elements.faces.empty();
    const auto header_between = [&] {
        static constexpr const char* others[] = {"comment C:\\models\\", "comment element face 9",
                                                 "obj_info 1", "comment"};
        if (text.choice(comments, 4) == 1) text.line(others[text.choice(comments, std::size(others))]);
    };
    text.line("ply");
    header_between();
    text.line(std::string("format ") +
              (!bytes                          ? "ascii"
               : *bytes == std::endian::little ? "binary_little_endian"
                                               : "binary_big_endian") +
              " 1.0");
    // A colour before or behind the coordinates: a byte of 10, which also ends lines.
    const bool has_colour = text.has(names), is_colour_first = text.choice(names, 2) == 1;
    const auto beside_colour = [&](auto put_coordinates, auto put_colour) {
        if (is_colour_first) put_colour();
        put_coordinates();
        if (has_colour && !is_colour_first) put_colour();
    };
    const auto declare_vertices = [&] {
        text.line("element vertex " + std::to_string(elements.vertices.size()));
        const bool is_other = text.choice(words, 2) == 1;
        const auto coordinates = [&] {
            for (const char axis : {'x', 'y', 'z'}) {
                header_between();
                text.line(std::string("property ") + (is_other ? "float64 " : "double ") + axis);
            }
        };
        beside_colour(coordinates, [&] { text.line("property uchar red"); });
    };
    const auto declare_faces = [&] {
        text.line("element face " + std::to_string(elements.faces.size()));
        text.line(std::array{"property list uchar int vertex_indices",
                             "property list uint8 int32 vertex_index",
                             "property list uchar uint vertex_indices"}[text.choice(words, 3)]);
    };
    if (text.has(order) && !is_points) declare_faces();
    declare_vertices();
    if (!text.has(order) && !is_points) declare_faces();
    text.line("end_header");
    std::string body;
    const auto put = [&](const std::vector<std::string>& all) {
        text.between("");
        std::vector<std::string> broken = all;
        for (std::size_t i = 1; i < all.size(); ++i)
            if (text.choice(joins, 5) == 1) broken[i] = "\n" + all[i];
        text.line(text.row(broken));
    };
    const auto append = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (*bytes != std::endian::native) std::reverse(raw, raw + sizeof raw);
        body.append(raw, sizeof raw);
    };
    const auto put_vertices = [&] {
        for (const Vec3d& p : elements.vertices) {
            std::vector<std::string> all;
            const auto coordinates = [&] {
                for (int k = 0; k < 3; ++k)
                    if (bytes)
                        append(p[k]);
                    else
                        all.push_back(text.number(p[k]));
            };
            const auto colour = [&] {
                if (bytes)
                    append(std::uint8_t(10));
                else
                    all.emplace_back("10");
            };
            beside_colour(coordinates, colour);
            if (!bytes) put(all);
        }
    };
    const auto put_faces = [&] {
        for (const auto& [i, j, k] : elements.faces) {
            if (bytes)
                append(std::uint8_t(3)), append(i), append(j), append(k);
            else
                put({"3", std::to_string(i), std::to_string(j), std::to_string(k)});
        }
    };
    if (text.has(order)) put_faces();
    put_vertices();
    if (!text.has(order)) put_faces();
    return text.written() + body;
}

inline std::string stl(const Elements& elements, const Style& style) {
    Text text(style);
    const auto spelled = [&](std::string word) {
        if (text.choice(words, 3) == 1)
            for (char& letter : word) letter = static_cast<char>(std::toupper(letter));
        return word;
    };
    const auto put = [&](std::vector<std::string> all) {
        text.between("");
        all[0] = spelled(all[0]);
        if (text.choice(names, 4) == 1 && all[0] != "end") all.emplace_back("note");
        text.line(text.row(all));
    };
    const auto end = [&](const std::string& what) {
        put(text.choice(words, 4) == 1 ? std::vector<std::string>{"end", what}
                                       : std::vector<std::string>{"end" + what});
    };
    put({"solid", "a"});
    for (std::size_t i = 0; i < elements.faces.size(); ++i) {
        if (i > 0 && text.choice(order, 3) == 1) end("solid"), put({"solid", "b"});
        put({"facet", "normal", "0", "0", "1"});
        put({"outer", "loop"});
        for (const std::uint32_t v : elements.faces[i]) {
            std::vector<std::string> all = numbers_of(text, elements.vertices[v]);
            all.insert(all.begin(), "vertex");
            put(all);
        }
        end("loop"), end("facet");
    }
    end("solid");
    return text.written();
}

/// Rows of numbers: of `.csv` with a separator, of `.xyz` without.
inline std::string rows(const Elements& elements, const Style& style, bool is_csv) {
    Text text(style);
    const std::string separator = is_csv ? std::array{",", ";", "\t", " "}[text.choice(words, 4)]
                                         : std::string(text.choice(words, 2) == 1 ? "\t" : "");
    const bool has_commas = separator == ";" && text.has(words) && style[words] % 2 == 0;
    const bool is_counted = !is_csv && text.has(names), is_turned = is_csv && text.has(order);
    if (is_counted) text.line(std::to_string(elements.vertices.size()));
    if (is_counted && style[names] % 2 == 0) text.line("made by a program");
    text.between("#");
    if (is_turned)
        text.line(text.row({"id", "Z", "\"x\"", "y"}, separator == " " ? "" : separator));
    else if (!is_counted && text.choice(names, 2) == 1)
        text.line(text.row({"x", "y", "z"}, separator == " " ? "" : separator));
    for (const Vec3d& p : elements.vertices) {
        text.between("#");
        std::vector<std::string> all = numbers_of(text, p);
        if (is_turned) all = {"7", all[2], all[0], all[1]};
        if (has_commas)
            for (std::string& word : all) std::replace(word.begin(), word.end(), '.', ',');
        if (is_counted && style[names] % 3 == 0) all.insert(all.begin(), "Fe");
        text.line(text.row(all, separator == " " ? "" : separator));
    }
    return text.written();
}

struct Format {
    const char* file;
    bool holds_faces, holds_points;
    std::string (*write)(const Elements&, const Style&);
};
constexpr Format formats[] = {
    {"a.obj", true, true, obj},
    {"a.off", true, true, off},
    {"a.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::nullopt); }},
    {"b.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::endian::little); }},
    {"c.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::endian::big); }},
    {"a.stl", true, false, stl},
    {"a.csv", false, true, [](const Elements& e, const Style& s) { return rows(e, s, true); }},
    {"a.xyz", false, true, [](const Elements& e, const Style& s) { return rows(e, s, false); }},
};

}  // namespace hedgerow::hunter
