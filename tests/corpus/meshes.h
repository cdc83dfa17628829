/// Files of OBJ with MTL, PLY, STL and OFF.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "../io_support.h"
#include "file.h"

namespace hedgerow::testing_corpus {

inline void add_obj(std::vector<CorpusFile>& all) {
    const std::string places = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\n";
    const auto add = [&](const std::string& text, const std::vector<ThreeCorners>& triangles) {
        all.push_back({"a.obj", text, triangles});
    };
    add_text(all, {"a.obj", "# two\no pair\n" + places + "\nf 1 2 3\nf 3 2 4\n", two});
    // A \ at the end of what is no list of numbers joins nothing.
    for (const std::string line : {"# C:\\models\\", "o name\\", "g left\\", "usemtl C:\\paint\\",
                                   "mtllib C:\\paint\\", "s off\\", "call a.obj\\", "#\\", "unknown \\"}) {
        add(line + "\n" + places + "f 1 2 3\nf 3 2 4\n", two);
        add(places + "f 1 2 3\n" + line + "\nf 3 2 4\n", two);
    }
    add("v 0 0 0 # C:\\\nv 1 0 0\nv 0 1 0 # \\ \nv 1 1 0.5\nf 1 2 3 # here\\\nf 3 2 4\n", two);
    // Lists of numbers are joined.
    add("v 0 \\\n0 0\nv 1 0 0\nv 0 1\\\n 0\nv 1 1 0.5\nf 1 \\\n2 \\\n3\nf 3 2 4\n", two);
    add("v 0 \\\r\n0 0\r\nv 1 0 0\r\nv 0 1\\\r\n 0\r\nv 1 1 0.5\r\nf 1 \\\r\n2 3\r\nf 3 2 4\r\n", two);
    add("v 0 \\\r0 0\rv 1 0 0\rv 0 1 0\rv 1 1 0.5\rf 1 \\\r2 3\rf 3 2 4\r", two);
    add(places + "f 1 2 \\  \n3\nf 3 2 4\n", two);
    add(places + "vn 0 0 \\\n1\nvt 0 \\\n0\nl 1 2 \\\n3\np 1 \\\n2\nf 1//1 2//1 3//1\nf 3/1 2/1 4/1\n", two);
    // Ordinals of every form, also of what the file lacks.
    for (const std::string form :
         {"f 1/1 2/1 3/1\nf 3/1 2/1 4/1\n", "f 1//1 2//1 3//1\nf 3//1 2//1 4//1\n",
          "f 1/1/1 2/1/1 3/1/1\nf 3/1/1 2/1/1 4/1/1\n", "f -4 -3 -2\nf -2 -3 -1\n",
          "f -4/-1 -3/-1 -2/-1\nf -2/-1 -3/-1 -1/-1\n", "f 1/ 2/ 3/\nf 3// 2// 4//\n", "fo 1 2 3\nfo 3 2 4\n",
          "f  1\t2 3 \nf 3 2 4\t\n"}) {
        add(places + form, two);
        add("vt 0.5 0.5\nvn 0 0 1\n" + places + form, two);
    }
    add("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nv 1 1 0.5 1\nf 1 2 3\nf 3 2 4\n", two);
    add("v 0 0 0 .1 .2 .3\nv 1 0 0 1 1 1\nv 0 1 0 0 0 0\nv 1 1 0.5 1 0 1\nf 1 2 3\nf 3 2 4\n", two);
    add("v +0 -0 0.0\nv 1e0 0 0\nv 0 1.000 0\nv 1 1 5E-1\nf 1 2 3\nf 3 2 4\n", two);
    add("f 1 2 3\n" + places + "f 3 2 4\n", two);
    all.push_back({"a.obj", places, {}, {a, b, c, d}});
    all.push_back({"a.obj", places + "p 1 2 3 4\n", {}, {a, b, c, d}});
}

inline void add_mtl(std::vector<CorpusFile>& all) {
    const std::string text = "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl green\nf 1 2 3\n";
    const Vec3f green(0, 1, 0);
    CorpusFile file{"a.obj", text, one, {}, green};
    for (const auto& [how, paint] : as_systems_write("newmtl green\nKd 0 1 0\n")) {
        file.beside = {{"paint.mtl", paint}};
        all.push_back(file);
    }
    for (const std::string paint :
         {"# C:\\paint\\\nnewmtl green\n\tKd 0 1 0\n", "newmtl red\nKd 1 0 0\n\nnewmtl green\nKd  0\t1 0 \n",
          "newmtl green\nmap_Bump C:\\maps\\\nKd 0 1 0\n",
          "newmtl green\nKd 0 1 0\nnewmtl green\nKd 1 0 0\n"}) {
        file.beside = {{"paint.mtl", paint}};
        all.push_back(file);
    }
}

inline std::string ply_header(
    const std::string& format, const std::string& end = "\n",
    const std::string& faces = "element face 2\nproperty list uchar int vertex_indices\n") {
    std::string header = "ply\nformat " + format +
                         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
                         faces + "end_header\n",
                written;
    for (const char letter : header) written += letter == '\n' ? end : std::string(1, letter);
    return written;
}

inline void add_ply(std::vector<CorpusFile>& all) {
    const std::string places = "0 0 0\n1 0 0\n0 1 0\n1 1 0.5\n", faces = "3 0 1 2\n3 2 1 3\n";
    add_text(all, {"a.ply", ply_header("ascii") + places + faces, two});
    const auto add = [&](const std::string& text, const std::vector<ThreeCorners>& triangles) {
        all.push_back({"a.ply", text, triangles});
    };
    // Binary, by headers of every kind of line.
    using testing_io::append;
    for (const std::endian order : {std::endian::little, std::endian::big})
        for (const std::string end : {"\n", "\r\n", "\r"})
            for (const std::string mark : {"", "\xEF\xBB\xBF"}) {
                std::string bytes = mark + ply_header(order == std::endian::little ? "binary_little_endian"
                                                                                   : "binary_big_endian",
                                                      end);
                for (const Vec3d& p : {a, b, c, d})
                    for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k]), order);
                for (const auto& face : {std::array{0, 1, 2}, std::array{2, 1, 3}}) {
                    bytes += '\3';
                    for (const int v : face) append(bytes, std::int32_t(v), order);
                }
                add(bytes, two);
            }
    // Data that begin with the byte of a line's end.
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string bytes = ply_header("binary_little_endian", end,
                                       "element face 1\nproperty list uchar int vertex_indices\n");
        const std::string type = "property float x";
        bytes.replace(bytes.find(type), type.size(), "property uchar x");
        const auto vertex = [&](std::uint8_t x, float y, float z) {
            append(bytes, x), append(bytes, y), append(bytes, z);
        };
        vertex(10, 0, 0), vertex(13, 0, 0), vertex(10, 1, 0), vertex(0, 0, 0);
        bytes += '\3';
        for (const int v : {0, 1, 2}) append(bytes, std::int32_t(v));
        add(bytes, {{Vec3d(10, 0, 0), Vec3d(13, 0, 0), Vec3d(10, 1, 0)}});
    }
    // Strips.
    const auto strips = [](const std::string& type) {
        return "element tristrips 1\nproperty list int " + type + " vertex_indices\n";
    };
    add(ply_header("ascii", "\n", strips("int")) + places + "4 0 1 2 3\n", two);
    add(ply_header("ascii", "\n", strips("int")) + places + "8 0 1 2 -1 2 1 3 -1\n", two);
    add(ply_header("ascii", "\n", strips("uint")) + places + "4 0 1 2 3\n", two);
    add(ply_header("ascii", "\n", "element tristrips 2\nproperty list uchar short vertex_index\n") + places +
            "3 0 1 2\n3 2 1 3\n",
        two);
    std::string binary = ply_header("binary_little_endian", "\n", strips("int"));
    for (const Vec3d& p : {a, b, c, d})
        for (int k = 0; k < 3; ++k) append(binary, static_cast<float>(p[k]));
    for (const int n : {7, 0, 1, 2, -1, 2, 1, 3}) append(binary, std::int32_t(n));
    add(binary, two);
    add(ply_header("ascii", "\n",
                   "element face 1\nproperty list uchar int vertex_indices\n" + strips("int")) +
            places + "3 0 1 2\n3 2 1 3\n",
        two);
    // Headers in other words.
    std::string header = ply_header("ascii");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = header;
        for (std::size_t at = 0; (at = changed.find(from, at)) != changed.npos; at += to.size())
            changed.replace(at, from.size(), to);
        return changed + places + faces;
    };
    add(with("float", "float32"), two);
    add(with("float", "double"), two);
    add(with("float", "float64"), two);
    add(with("uchar int", "uint8 int32"), two);
    add(with("uchar int", "int uint"), two);
    add(with("vertex_indices", "vertex_index"), two);
    add(with("element vertex", "comment ends in \\\nobj_info 1\nelement vertex"), two);
    add(ply_header("ascii") + "0 0 0 1 0 0\n0 1 0\n1 1\n0.5 3 0 1 2 3 2 1 3", two);
    add("ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_indices\nelement vertex 4\n"
        "property float z\nproperty uchar red\nproperty float y\nproperty float x\nend_header\n" +
            faces + "0 9 0 0\n0 9 0 1\n0 9 1 0\n0.5 9 1 1\n",
        two);
    all.push_back({"a.ply", ply_header("ascii", "\n", "") + places, {}, {a, b, c, d}});
    all.push_back(
        {"a.ply",
         ply_header("ascii", "\n", "element face 0\nproperty list uchar int vertex_indices\n") + places,
         {},
         {a, b, c, d}});
    add(ply_header("ascii") + places + faces + "3 0 1 2\n", two);  // a face more than it counts
}

inline void add_stl(std::vector<CorpusFile>& all) {
    const auto facet = [](const std::string& places, const std::string& behind = "") {
        return "facet normal 0 0 1" + behind + "\nouter loop" + behind + "\n" + places + "endloop" + behind +
               "\nendfacet" + behind + "\n";
    };
    const std::string abc = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n",
                      cbd = "vertex 0 1 0\nvertex 1 0 0\nvertex 1 1 0.5\n";
    add_text(all, {"a.stl", "solid a\n" + facet(abc) + facet(cbd) + "endsolid a\n", two});
    const auto add = [&](const std::string& text) { all.push_back({"a.stl", text, two}); };
    add(" solid one\r" + facet(abc) + "endsolid one\r\r solid two\r" + facet(cbd) + "endsolid two\r");
    for (const std::string behind : {" 1", " one two", "\t# note", " facet2"})
        add("solid a\n" + facet(abc, behind) + facet(cbd, behind) + "endsolid a b\n");
    add("solid\n" + facet(abc) + facet(cbd) + "end solid\n");
    add("solid a\n" + facet(abc) + facet(cbd) + "end solid a\n");
    add("solid a\n" + facet(abc) + "end solid a\nsolid b\n" + facet(cbd) + "ENDSOLID b\n");
    add("SOLID A\n FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 0 0 0\n VERTEX 1 0 0\n VERTEX 0 1 0\n ENDLOOP\n "
        "ENDFACET\n" +
        facet(cbd) + "endsolid\n");
    add("solid a facet here\n" + facet(abc) + facet(cbd) + "endsolid\n");
    add("solid a\n" + facet("vertex 0 0 0 7\nvertex 1 0 0 red\nvertex 0 1 0\n") + facet(cbd) + "endsolid\n");
    add("solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet " +
        facet(cbd) + "endsolid\n");
    add("solid a\nfacet normal 0 0 1\nouter loop\n" + abc + "end loop\nend facet\n" + facet(cbd) +
        "end solid\n");
    // Binary, with headers of every kind and spare bytes.
    using testing_io::append;
    for (const std::string start :
         {"binary", "solid made by a program", "\xEF\xBB\xBFsolid", "solid\n", "solid\rfacets\r"})
        for (const std::size_t spare : {0u, 1u, 49u, 92u}) {
            std::string bytes = start;
            bytes.resize(80, '\0');
            append(bytes, std::uint32_t(2));
            for (const ThreeCorners& t : two) {
                for (int k = 0; k < 3; ++k) append(bytes, 0.f);
                for (const Vec3d& p : t)
                    for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k]));
                append(bytes, std::uint16_t(7));
            }
            add(bytes + std::string(spare, '\5'));
        }
}

inline void add_off(std::vector<CorpusFile>& all) {
    const std::string places = "0 0 0\n1 0 0\n0 1 0\n1 1 0.5\n", faces = "3 0 1 2\n3 2 1 3\n";
    add_text(all, {"a.off", "OFF\n4 2 0\n" + places + faces, two});
    const auto add = [&](const std::string& text) { all.push_back({"a.off", text, two}); };
    for (const std::string header :
         {"OFF 4 2 0\n", "off\n4 2 0\n", "4 2 0\n", "OFF\n4 2\n", "OFF\n4\n2\n0\n", "OFF\n4 2 5\n",
          "# C:\\\nOFF # \\\n\n4 2 0 # counts\n", "OFF 4\n2 0\n", "\tOFF\n  4  2\t0\n"}) {
        add(header + places + faces);
        add(header + "0 0 0 1 0 0\n0 1 0 1 1 0.5\n" + faces);
        add(header + "0 0 0 1 0 0 0 1 0 1 1 0.5\n" + faces);
    }
    add("OFF\n4 2 0\n" + places + "3 0\n1 2\n3\n2\n1\n3\n");
    // Found by the hunter: as many lines as vertices and faces, and none of them one of these.
    add("OFF\n4 2 0\n0 0 0 1 0 0\n0 1 0 1 1 0.5\n3 0\n1 2\n3 2\n1 3\n");
    all.push_back({"a.off", "OFF 3 1 0\n0 0 0 1 0 0\n0 1 0\n3 1 2\n0\n", {{b, c, a}}});
    add("OFF\n4 2 0\n0\n0\n0\n1 0\n0\n0 1 0\n1 1\n0.5\n" + faces);
    add("OFF\n4 2 0\n" + places + "3 0 1 2 255 0 0\n3 2 1 3 0.5 0.5 0.5 1\n");
    add("OFF\n4 2 0\n" + places + "3  0 1 2 # \\\n\n# \\\n3 2 1 3\n");
    add("OFF\n4 2 0\n0 0 0 9 9\n1 0 0 9 9\n0 1 0 9 9\n1 1 0.5 9 9\n" + faces);
    add("COFF\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n1 1 0.5 0 0 0 1\n" + faces);
    add("COFF\n4 2 0\n0 0 0 1 1 1 1 1 0 0 1 1 1 1\n0 1 0 1 1 1 1 1 1 0.5 0 0 0 1\n" + faces);
    add("NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n1 1 0.5 0 0 1\n" + faces);
    add("STOFF\n4 2 0\n0 0 0 0 1\n1 0 0 0 1\n0 1 0 1 1\n1 1 0.5 1 1\n" + faces);
    add("OFF\n4 2 0\n" + places + faces + "3 0 1 3\n");  // a face more than it counts
    using testing_io::append;
    for (const std::string keyword : {"OFF BINARY\n", "OFF BINARY\r\n", "COFF BINARY\n"}) {
        const bool is_coloured = keyword[0] == 'C';
        std::string bytes = keyword;
        const auto whole = [&](int n) { append(bytes, std::int32_t(n), std::endian::big); };
        const auto real = [&](double x) { append(bytes, static_cast<float>(x), std::endian::big); };
        for (const int n : {4, 2, 0}) whole(n);
        for (const Vec3d& p : {a, b, c, d}) {
            for (int k = 0; k < 3; ++k) real(p[k]);
            for (int k = 0; k < 4 && is_coloured; ++k) real(1);
        }
        for (const int n : {3, 0, 1, 2, 0, 3, 2, 1, 3, 3}) whole(n);
        for (int k = 0; k < 3; ++k) real(0.5);
        add(bytes);
    }
    all.push_back({"a.off", "OFF\n4 0 0\n" + places, {}, {a, b, c, d}});
}

}  // namespace hedgerow::testing_corpus
