/// Files of points alone: CSV, XYZ and NPY.
#pragma once

#include <string>
#include <vector>

#include "../io_support.h"
#include "file.h"

namespace hedgerow::testing_corpus {

inline void add_rows(std::vector<CorpusFile>& all) {
    const std::vector<Vec3d> points{a, Vec3d(1.5, -2, 1e3), d};
    const auto add = [&](const std::string& name, const std::string& text) {
        all.push_back({name, text, {}, points});
    };
    add_text(all, {"a.csv", "x,y,z\n0,0,0\n1.5,-2,1e3\n1,1,0.5\n", {}, points});
    add_text(all, {"a.xyz", "0 0 0\n1.5 -2 1e3\n1 1 0.5\n", {}, points});
    for (const std::string text :
         {"0,0,0\n1.5,-2,1e3\n1,1,0.5\n", "0;0;0\n1.5;-2;1e3\n1;1;0.5\n", "0;0;0\n1,5;-2;1e3\n1;1;0,5\n",
          "x;y;z\n0,0;0,0;0,0\n1,5;-2,0;1000,0\n1,0;1,0;0,5\n",
          "X\tY\tZ\n0\t0\t0\n1.5\t-2\t1000\n1\t1\t0.5\n",
          "\"z\",\"id\",\"x\",\"y\"\n0,7,0,0\n1000,8,1.5,-2\n0.5,9,1,1\n",
          "id \"x\" Y z\n7 0 0 0\n7 1.5 -2 1e3\n7 1 1 0.5\n",  // found by the hunter
          ",x,y,z\n0,0,0,0\n1,1.5,-2,1e3\n2,1,1,0.5\n",
          "# C:\\\n//X,Y,Z\n\n0, 0, 0 \n 1.5 ,-2,+1000\n1,1,.5\n"})
        add("a.csv", text);
    for (const std::string text :
         {"3\n0 0 0\n1.5 -2 1e3\n1 1 0.5\n", "3\n\n0 0 0\n1.5 -2 1e3\n1 1 0.5\n",
          "3\nwater\nO 0 0 0\nH 1.5 -2 1e3\nH 1 1 0.5\n", "3\nfrom 0 0 0\nO 0 0 0\nH 1.5 -2 1e3\nH 1 1 0.5\n",
          "3\n9 9 9\n0 0 0\n1.5 -2 1e3\n1 1 0.5\n", "0 0 0 255 0 0\n1.5 -2 1e3 0 0 0\n1 1 0.5 1 1 1\n",
          "x y z intensity\n0 0 0 1\n1.5 -2 1e3 1\n1 1 0.5 1\n",
          "//X Y Z R\n0 0 0 1\n1.5 -2 1e3 1\n1 1 0.5 1\n", "0;0;0\n1,5;-2;1000\n1;1;0,5\n"})
        add("a.xyz", text);
}

template <class U>
std::string npy_of(const std::string& type, bool is_fortran, int version) {
    const std::vector<Vec3d> points{a, b, Vec3d(2, 3, 4)};
    std::string header = "{'descr': '" + type + "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                         ", 'shape': (3, 3), }\n",
                bytes = "\x93NUMPY";
    bytes += {static_cast<char>(version), '\0'};
    if (version == 1)
        testing_io::append(bytes, static_cast<std::uint16_t>(header.size()));
    else
        testing_io::append(bytes, static_cast<std::uint32_t>(header.size()));
    bytes += header;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            const double x =
                is_fortran ? points[static_cast<std::size_t>(k)][i] : points[static_cast<std::size_t>(i)][k];
            testing_io::append(bytes, static_cast<U>(x),
                               type[0] == '>' ? std::endian::big : std::endian::little);
        }
    return bytes;
}

inline void add_npy(std::vector<CorpusFile>& all) {
    const auto add = [&]<class U>(const std::string& type, U) {
        int n = 0;
        for (const std::string order : {"<", ">"})
            for (const bool is_fortran : {false, true})
                all.push_back(
                    {"a.npy", npy_of<U>(order + type, is_fortran, 1 + n++ % 3), {}, {a, b, Vec3d(2, 3, 4)}});
    };
    add("f4", float()), add("f8", double()), add("i1", std::int8_t()), add("i2", std::int16_t());
    add("i4", std::int32_t()), add("i8", std::int64_t()), add("u1", std::uint8_t()),
        add("u2", std::uint16_t());
    add("u4", std::uint32_t()), add("u8", std::uint64_t());
}

}  // namespace hedgerow::testing_corpus
