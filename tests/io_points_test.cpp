/// Point files and NumPy arrays: round trips, every variant, and bad input.
#include <hedgerow/io/npy.h>
#include <hedgerow/io/point_file.h>
#include <hedgerow/io/validate.h>

#include <cmath>
#include <limits>

#include "io_support.h"

namespace hedgerow {
namespace {

using namespace testing_io;

template <class T, int D>
PointCloud<T, D> random_cloud(std::mt19937_64& random) {
    PointCloud<T, D> cloud;
    cloud.points.resize(1 + random() % 50);
    for (auto& p : cloud.points)
        for (int i = 0; i < D; ++i) p[i] = random_coordinate<T>(random);
    return cloud;
}

template <class T, int D>
void expect_round_trips() {
    TempFolder folder;
    std::mt19937_64 random(11);
    for (int round = 0; round < 50; ++round) {
        const auto cloud = random_cloud<T, D>(random);
        for (const std::string name : {"a.ply", "a.npy", "a.csv", "a.CSV"}) {
            save_points(folder / name, cloud);
            ASSERT_TRUE(same_bits(load_points<T, D>(folder / name).points, cloud.points)) << name;
            gzip(folder / (name + ".gz"), contents(folder / name));
            ASSERT_TRUE(same_bits(load_points<T, D>(folder / (name + ".gz")).points, cloud.points)) << name;
        }
    }
}

TEST(PointFile, WhatIsSavedIsReadBack) {
    expect_round_trips<float, 2>();
    expect_round_trips<float, 3>();
    expect_round_trips<double, 2>();
    expect_round_trips<double, 3>();
}

TEST(Csv, AnySeparatorAndHeader) {
    TempFolder folder;
    const std::vector<Vec3d> expected = {{1, 2, 3}, {-0.5, 1e10, 4}};
    for (const std::string text :
         {"1,2,3\n-.5,+1e10,4", "1;2;3\r\n-0.5 ; 1e10;4\r\n", "# x y z\n\n1 2\t3\n  -0.5   1e10 4\n",
          "\xEF\xBB\xBFx,y,z\n1,2,3\n-0.5,1e10,4\n", "\"Z\";id;\"X\";Y\n3;7;1;2\n4;8;-0.5;1e10\n",
          "1,0;2;3\n-,5;1e10;4,\n", "// east north up\n1 2 3\n-0.5 1e10 4\n"})
        EXPECT_EQ((load_points<double, 3>(folder.file("a.csv", text)).points), expected) << text;
}

TEST(PointFile, ReportsWhatFloatsLose) {
    TempFolder folder;
    const auto report_of = [&](const std::string& text) {
        LoadReport report;
        load_points<float, 3>(folder.file("a.csv", text), {.report = &report});
        return report;
    };
    // Half a metre apart, at coordinates of the Earth's grid.
    const LoadReport lost = report_of("431234,5412345.2,210\n431234,5412345.7,210\n");
    EXPECT_TRUE(lost.loses_detail);
    EXPECT_NEAR(lost.rounding, 0.2, 1e-6);
    LoadReport exact;
    load_points<double, 3>(folder / "a.csv", {.report = &exact});
    EXPECT_FALSE(exact.loses_detail);
    EXPECT_EQ(exact.rounding, 0);
    for (const std::string text : {"0.1,0.2,0.3\n0.4,0.5,0.6\n", "431234,5412345,210\n431235,5412345,210\n",
                                   "1000.1,0,0\n1001.2,0,0\n1002.3,0,0\n", "0.1,0.1,0.1\n"})
        EXPECT_FALSE(report_of(text).loses_detail) << text;
    // Apart, and in one place once they are floats.
    EXPECT_TRUE(report_of("431234.01,5412345.1,210.001\n431234.011,5412345.2,210.001\n").loses_detail);
    save_npy<double>(folder / "a.npy", std::vector<double>{5412345.25, 0, 0, 5412345.5, 0, 0}, {2, 3});
    LoadReport of_array;
    load_points<float, 3>(folder / "a.npy", {.report = &of_array});
    EXPECT_TRUE(of_array.loses_detail);
    // Whole numbers too.
    const std::string ply = "element vertex 2\nproperty int x\nproperty int y\nproperty int z\nend_header\n";
    std::string binary = "ply\nformat binary_little_endian 1.0\n" + ply;
    for (const std::int32_t x : {541234525, 0, 0, 541230525, 0, 0}) testing_io::append(binary, x);
    for (const std::string& text :
         {binary, "ply\nformat ascii 1.0\n" + ply + "541234525 0 0\n541230525 0 0\n"}) {
        LoadReport of_integers;
        load_points<float, 3>(folder.file("a.ply", text), {.report = &of_integers});
        EXPECT_TRUE(of_integers.loses_detail);
        EXPECT_EQ(of_integers.rounding, 29);
    }
}

TEST(PointFile, NumbersAreRoundedOnce) {
    TempFolder folder;
    // Just above the middle of two floats: as a double it would be that middle.
    const auto cloud = load_points<float, 3>(
        folder.file("a.csv", "1.00000005960464477539062500001,1.000000059604644775390625,7e-46\n"));
    EXPECT_EQ(cloud.points[0], Vec3f(1.00000011920928955078125f, 1.0f, 0.0f));
}

TEST(PointFile, BadInput) {
    TempFolder folder;
    const auto expect_bad = [&](const std::string& name, const std::string& bytes,
                                std::vector<std::string> parts) {
        parts.insert(parts.begin(), name);
        const auto path = folder.file(name, bytes);
        expect_input_error([&] { load_points<float, 3>(path); }, parts);
        expect_input_error([&] { load_points<double, 3>(path); }, parts);
    };
    expect_input_error([&] { load_points(folder / "none.csv"); }, {"none.csv", "no such file"});
    expect_bad("a.csv", "", {"empty"});
    expect_bad("a.csv", "x,y,z\n", {"no points"});
    expect_bad("a.csv", "1,2\n", {"line 1", "2 columns, not 3"});
    expect_bad("a.csv", "x,y,z,w\n1,2,3\n", {"line 2", "3 columns, not 4"});
    expect_bad("a.csv", "1,2,3\n1,2,\n", {"line 2", "''"});
    expect_bad("a.csv", "1.000,5;2;3\n", {"line 1", "'1.000,5'", "x, y, z"});
    expect_bad("b.csv", "1;2;3\n1,5,5;2;3\n", {"line 2", "'1,5,5'"});
    expect_bad("c.csv", "east north up\n1 2 3\n", {"line 1", "'east'", "does not name the column x"});
    expect_bad("d.csv", "0,5 0,25 0\n1,5 0,25 0\n", {"line 1", "'5 0'", "semicolons"});
    expect_bad("a.xyz", "3\n0 0 0\n1 0 0\n", {"promises 3 points, but there are 2"});
    expect_bad("a.csv", "1,2,3\n1,nan,3\n", {"point 1 is (", "drop_bad"});
    expect_bad("a.csv", "1,2,3\n1,-inf,3\n", {"point 1 is ("});
    expect_bad("a.pts", "1 2 3\n", {"'.pts'", ".ply .npy .csv .xyz"});
    expect_bad("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nend_header\n",
               {"'z'"});
    EXPECT_EQ((load_points<float, 3>(folder.file("a.csv", "1,nan,2\n1,2,3\n"), {.drop_bad = true}).points),
              (std::vector<Vec3f>{{1, 2, 3}}));
    expect_input_error([&] { load_points(folder.file("a.csv", "1,nan,2\n"), {.drop_bad = true}); },
                       {"none is left"});
    LoadReport report;
    load_points(folder.file("a.csv", "0,0,0\nnan,0,0\n1,0,0\n2,0,0\n"),
                {.drop_bad = true, .report = &report});
    EXPECT_EQ(report.dropped_points, 1u);
    EXPECT_EQ(report.kept_points, (std::vector<std::uint32_t>{0, 2, 3}));
    // PLY files with integer coordinates, read into the plane: z must be absent or 0.
    const std::string flat = "ply\nformat ascii 1.0\nelement vertex 2\nproperty int x\nproperty int y\n";
    EXPECT_EQ((load_points<float, 2>(folder.file("a.ply", flat + "end_header\n1 2\n3 4\n")).size()), 2u);
    expect_input_error(
        [&] {
            load_points<float, 2>(folder.file("a.ply", flat + "property int z\nend_header\n1 2 0\n3 4 1\n"));
        },
        {"line 9", "z is not 0", "3D"});
    // The shape of an array must fit the dimension.
    save_npy<double>(folder / "a.npy", std::vector<double>(8), {4, 2});
    expect_input_error([&] { load_points<float, 3>(folder / "a.npy"); }, {"shape (4, 2)", "(N, 3)"});
    EXPECT_EQ((load_points<float, 2>(folder / "a.npy").size()), 4u);
    const PointCloud<float, 3> one{{{1, 2, 3}}};
    expect_output_error([&] { save_points(folder / "none/a.npy", one); }, {"cannot be written"});
    expect_input_error([&] { save_points(folder / "a.obj", one); }, {"'.obj'", ".ply .npy .csv"});
    EXPECT_NO_THROW(validate_points(one, "one"));
}

template <class T>
std::string npy(const std::string& type, bool fortran, const std::string& shape, const std::vector<T>& values,
                std::endian order, int version) {
    std::string header = "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
                         ", 'shape': " + shape + ", }\n";
    std::string bytes = "\x93NUMPY";
    bytes += {static_cast<char>(version), '\0'};
    if (version == 1)
        append(bytes, static_cast<std::uint16_t>(header.size()));
    else
        append(bytes, static_cast<std::uint32_t>(header.size()));
    bytes += header;
    for (const T v : values) append(bytes, v, order);
    return bytes;
}

template <class T>
void expect_npy(const std::string& kind) {
    TempFolder folder;
    const std::vector<T> in_order = {0, 1, 2, 3, 4, 5}, in_columns = {0, 3, 1, 4, 2, 5};
    for (const int version : {1, 2, 3})
        for (const bool big : {false, true})
            for (const bool fortran : {false, true}) {
                const auto order = big ? std::endian::big : std::endian::little;
                const auto path =
                    folder.file("a.npy", npy(std::string(big ? ">" : "<") + kind, fortran, "(2, 3)",
                                             fortran ? in_columns : in_order, order, version));
                const NpyArray array = load_npy(path);
                ASSERT_EQ(array.dtype, kind);
                ASSERT_EQ(array.shape, (std::vector<std::size_t>{2, 3}));
                ASSERT_EQ(array.size(), 6u);
                ASSERT_EQ(array.as<T>(), in_order);
                ASSERT_EQ(array.as<double>(), (std::vector<double>{0, 1, 2, 3, 4, 5}));
                ASSERT_EQ(array.as<std::uint8_t>(), (std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5}));
            }
    save_npy<T>(folder / "b.npy", in_order, {3, 1, 2});
    const NpyArray saved = load_npy(folder / "b.npy");
    EXPECT_EQ(saved.dtype, kind);
    EXPECT_EQ(saved.shape, (std::vector<std::size_t>{3, 1, 2}));
    EXPECT_EQ(saved.as<T>(), in_order);
    EXPECT_EQ(contents(folder / "b.npy").size(), 128 + 6 * sizeof(T)) << "the data should begin at 128";
}

TEST(Npy, EveryTypeOrderAndVersion) {
    expect_npy<float>("f4");
    expect_npy<double>("f8");
    expect_npy<std::int8_t>("i1");
    expect_npy<std::int16_t>("i2");
    expect_npy<std::int32_t>("i4");
    expect_npy<std::int64_t>("i8");
    expect_npy<std::uint8_t>("u1");
    expect_npy<std::uint16_t>("u2");
    expect_npy<std::uint32_t>("u4");
    expect_npy<std::uint64_t>("u8");
}

TEST(Npy, ScalarsVectorsEmptyAndBool) {
    TempFolder folder;
    for (const auto& [shape, count] : std::vector<std::pair<std::vector<std::size_t>, std::size_t>>{
             {{}, 1}, {{5}, 5}, {{0, 3}, 0}, {{2, 0}, 0}}) {
        save_npy<float>(folder / "a.npy", std::vector<float>(count, 2), shape);
        EXPECT_EQ(load_npy(folder / "a.npy").shape, shape);
        EXPECT_EQ(load_npy(folder / "a.npy").as<float>(), std::vector<float>(count, 2));
    }
    const auto path =
        folder.file("b.npy", npy<std::uint8_t>("|b1", false, "(2,)", {1, 0}, std::endian::little, 1));
    EXPECT_EQ(load_npy(path).as<std::int32_t>(), (std::vector<std::int32_t>{1, 0}));
}

TEST(Npy, ConversionsAreExactOrSaid) {
    TempFolder folder;
    const auto array = [&](auto value) {
        using T = decltype(value);
        save_npy<T>(folder / "a.npy", std::vector<T>{0, value}, {2});
        return load_npy(folder / "a.npy");
    };
    expect_input_error([&] { array(0.5).as<std::int32_t>(); }, {"element 1", "0.5", "i4"});
    expect_input_error([&] { array(-1.0).as<std::uint64_t>(); }, {"element 1"});
    expect_input_error([&] { array(0x1p63).as<std::int64_t>(); }, {"element 1"});
    expect_input_error([&] { array(NAN).as<std::int64_t>(); }, {"element 1", "nan"});
    expect_input_error([&] { array(std::int32_t(300)).as<std::uint8_t>(); }, {"300", "u1"});
    expect_input_error([&] { array(std::int8_t(-3)).as<std::uint64_t>(); }, {"-3"});
    EXPECT_EQ(array(-0x1p63).as<std::int64_t>()[1], std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(array(1e300).as<float>()[1], std::numeric_limits<float>::infinity());
    EXPECT_EQ(array(0.1).as<float>()[1], 0.1f);
}

TEST(Npy, BadInput) {
    TempFolder folder;
    const auto expect_bad = [&](const std::string& bytes, std::vector<std::string> parts) {
        parts.insert(parts.begin(), "a.npy");
        const auto path = folder.file("a.npy", bytes);
        expect_input_error([&] { load_npy(path); }, parts);
    };
    const auto with = [](const std::string& type, const std::string& shape) {
        return npy<double>(type, false, shape, {1, 2, 3}, std::endian::little, 1);
    };
    expect_bad("", {"empty"});
    expect_bad("not an array", {"not a NumPy array"});
    expect_bad(with("<f8", "(4,)"), {"ends", "32 bytes"});
    expect_bad(with("<f8", "(4611686018427387904, 4)"), {"larger than any memory"});
    expect_bad(with("<f8", "(99999999999999999999,)"), {"no list of sizes"});
    expect_bad(with("<f8", "(1000000000000,)"), {"cut off"});
    expect_bad(with("<f2", "(3,)"), {"'<f2'", "f4 f8"});
    expect_bad(with("<c16", "(3,)"), {"'<c16'"});
    expect_bad(with("|O", "(3,)"), {"'|O'"});
    expect_bad(with("", "(3,)"), {"''"});
    expect_bad(with("<f8", "3"), {"lacks a '('"});
    expect_bad(with("<f8", "(3,)").substr(0, 40), {"ends in the array's header"});
    const std::string whole = with("<f8", "(3,)");
    for (std::size_t n = 1; n < whole.size(); ++n) expect_bad(whole.substr(0, n), {""});
    std::string version = whole;
    version[6] = 9;
    expect_bad(version, {"version 9"});
    expect_input_error([&] { save_npy<float>(folder / "b.npy", std::vector<float>(3), {2}); },
                       {"b.npy", "3 values"});
    expect_output_error([&] { save_npy<float>(folder / "no/b.npy", std::vector<float>(2), {2}); },
                        {"cannot be written"});
}

}  // namespace
}  // namespace hedgerow
