/// Rows of numbers in every format: round trips, chunks of any size, and bad input.
#include <hedgerow/columns.h>
#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>

#include <cmath>
#include <limits>

#include "io_support.h"

namespace hedgerow {
namespace {

using namespace testing_io;

const InputColumns points{{"x", "y", "z"}};
const InputColumns segment{{"x", "y", "t_min", "t_max"}, {0.25, 8}};

/// All rows of a file, read `most` at a time.
template <class T>
std::vector<T> rows_of(const std::filesystem::path& path, const InputColumns& columns, std::size_t most = 7) {
    const auto reader = open_rows<T>(path, row_format(path), columns);
    std::vector<T> all, some;
    while (const std::size_t rows = reader->read(some, most)) {
        EXPECT_LE(rows, most);
        EXPECT_EQ(some.size(), rows * columns.size());
        all.insert(all.end(), some.begin(), some.end());
    }
    EXPECT_TRUE(some.empty());
    EXPECT_EQ(reader->read(some, most), 0u) << "the end stays the end";
    EXPECT_EQ(reader->size().value_or(all.size() / columns.size()) * columns.size(), all.size());
    return all;
}

/// A NumPy file with a header of one's own.
std::string npy(const std::string& dictionary, const std::string& elements, int version = 1) {
    std::string bytes = "\x93NUMPY";
    bytes += static_cast<char>(version);
    bytes += '\0';
    if (version == 1)
        append(bytes, static_cast<std::uint16_t>(dictionary.size()));
    else
        append(bytes, static_cast<std::uint32_t>(dictionary.size()));
    return bytes + dictionary + elements;
}
template <class U>
std::string packed(const std::vector<U>& numbers, std::endian order = std::endian::little) {
    std::string bytes;
    for (const U n : numbers) append(bytes, n, order);
    return bytes;
}

template <class T>
void expect_all_formats_read() {
    TempFolder folder;
    std::mt19937_64 random(5);
    std::vector<T> numbers(3 * 50);
    for (T& x : numbers) x = random_coordinate<T>(random);
    save_npy<T>(folder / "a.npy", numbers, {50, 3});
    std::string csv, json = "[";
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        char digits[64];
        const std::string number(digits, std::to_chars(digits, digits + 64, numbers[i]).ptr);
        csv += number + (i % 3 == 2 ? "\n" : ",");
        json += (i % 3 == 0 ? (i == 0 ? "[" : ", [") : ",") + number + (i % 3 == 2 ? "]" : "");
    }
    json += "]";
    folder.file("a.csv", csv);
    folder.file("a.json", json);
    for (const std::string name : {"a.npy", "a.csv", "a.json"}) {
        for (const std::size_t most : {1u, 2u, 49u, 50u, 51u, 1000u})
            ASSERT_TRUE(same_bits(rows_of<T>(folder / name, points, most), numbers)) << name << ", " << most;
        gzip(folder / (name + ".gz"), contents(folder / name));
        ASSERT_TRUE(same_bits(rows_of<T>(folder / (name + ".gz"), points), numbers)) << name;
    }
}

TEST(Rows, AreReadFromEveryFormatBitForBit) {
    expect_all_formats_read<float>();
    expect_all_formats_read<double>();
}

TEST(Rows, NumPyArraysOfEveryTypeAndOrder) {
    TempFolder folder;
    const std::vector<double> expected = {1, 2, 3, 40, 50, 60};
    const auto header = [](const std::string& descr) {
        return "{'descr': " + descr + ", 'fortran_order': False, 'shape': (2, 3), }";
    };
    for (const int version : {1, 2, 3})
        EXPECT_EQ(
            rows_of<double>(folder.file("a.npy", npy(header("'<f8'"), packed(expected), version)), points),
            expected);
    const std::vector<float> floats(expected.begin(), expected.end());
    EXPECT_EQ(
        rows_of<double>(folder.file("a.npy", npy(header("'>f4'"), packed(floats, std::endian::big))), points),
        expected);
    const std::vector<std::uint16_t> whole(expected.begin(), expected.end());
    EXPECT_EQ(rows_of<float>(folder.file("a.npy", npy(header("'<u2'"), packed(whole))), points), floats);
    // Fields of records are read by their names, wherever they are.
    std::string records;
    for (std::size_t i = 0; i < 2; ++i) {
        const double* const p = &expected[3 * i];
        append(records, p[2]);
        append(records, std::uint8_t(9));
        append(records, static_cast<float>(p[0]), std::endian::big);
        append(records, p[1]);
    }
    const std::string of_records =
        "{'descr': [('z', '<f8'), ('id', '|u1'), ('x', '>f4'), ('y', '<f8')], 'fortran_order': False, "
        "'shape': (2,)}";
    EXPECT_EQ(rows_of<double>(folder.file("a.npy", npy(of_records, records)), points), expected);
    EXPECT_EQ(rows_of<double>(folder.file("a.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': "
                                                       "(0, 3)}",
                                                       "")),
                              points),
              std::vector<double>{});
}

TEST(Rows, TextWithNamesInAnyOrder) {
    TempFolder folder;
    const std::vector<double> expected = {1, 2, 3, -0.5, 1e10, 4};
    for (const std::string text :
         {"1,2,3\n-.5,+1e10,4", "1;2;3\r\n-0.5 ; 1e10;4\r\n", "# rows\n\n1 2\t3\n  -0.5   1e10 4\n",
          "\xEF\xBB\xBF\"Z\";id;X;y\n3;7;1;2\n4;8;-0.5;1e10\n", "1,0;2;3\n-,5;1e10;4,0\n"})
        EXPECT_EQ(rows_of<double>(folder.file("a.csv", text), points), expected) << text;
    // A first line that is no row must name the columns.
    expect_input_error([&] { rows_of<double>(folder.file("b.csv", "east,north,up\n1,2,3\n"), points); },
                       {"b.csv: line 1", "'east'", "x, y, z"});
    for (const std::string text :
         {"\xEF\xBB\xBF[[1,2,3],[-0.5,1e10,4]]", "[[1,2,3],[-0.5,1e10,4]]",
          " [ [ 1 , 2 , 3 ] ,\n[-5e-1,1E+10,4.0] ]\n", "[1,2,3]\n[-0.5,1e10,4]\n",
          "{\"x\":1,\"y\":2,\"z\":3}\n{\"z\":4,\"name\":\"}]\\\"\",\"x\":-0.5,\"y\":1e10}",
          "[{\"x\":1,\"y\":2,\"z\":3},{\"z\":4,\"flag\":true,\"none\":null,\"id\":7,\"x\":-0.5,\"y\":1e10}]"})
        EXPECT_EQ(rows_of<double>(folder.file("a.json", text), points), expected) << text;
    EXPECT_EQ(rows_of<double>(folder.file("a.csv", "x,y,z\n"), points), std::vector<double>{});
    EXPECT_EQ(rows_of<double>(folder.file("a.json", "[]"), points), std::vector<double>{});
    EXPECT_TRUE(std::isnan(rows_of<double>(folder.file("a.json", "[[1,null,3]]"), points)[1]));
}

TEST(Rows, LastColumnsMayBeLeftOut) {
    TempFolder folder;
    const std::vector<double> without = {1, 2, 0.25, 8}, with = {1, 2, 3, 4};
    EXPECT_EQ(rows_of<double>(folder.file("a.csv", "1,2\n"), segment), without);
    EXPECT_EQ(rows_of<double>(folder.file("a.csv", "1,2,3,4\n"), segment), with);
    EXPECT_EQ(rows_of<double>(folder.file("a.csv", "y,x\n2,1\n"), segment), without);
    EXPECT_EQ(rows_of<double>(folder.file("a.csv", "t_max,y,x,t_min\n4,2,1,3\n"), segment), with);
    EXPECT_EQ(rows_of<double>(folder.file("a.json", "[[1,2]]"), segment), without);
    EXPECT_EQ(rows_of<double>(folder.file("a.json", "[[1,2,3,4]]"), segment), with);
    EXPECT_EQ(rows_of<double>(folder.file("a.json", "[{\"x\":1,\"y\":2,\"t_max\":null}]"), segment), without);
    save_npy<double>(folder / "a.npy", std::vector<double>{1, 2}, {1, 2});
    EXPECT_EQ(rows_of<double>(folder / "a.npy", segment), without);
    save_npy<double>(folder / "a.npy", with, {1, 4});
    EXPECT_EQ(rows_of<double>(folder / "a.npy", segment), with);
}

TEST(Rows, BadInput) {
    TempFolder folder;
    const auto expect_bad = [&](const std::string& name, const std::string& bytes,
                                std::vector<std::string> parts) {
        parts.insert(parts.begin(), name);
        const auto path = folder.file(name, bytes);
        expect_input_error([&] { rows_of<float>(path, points); }, parts);
        expect_input_error([&] { rows_of<double>(path, points); }, parts);
    };
    const auto header = [](const std::string& shape, const std::string& descr = "'<f4'",
                           const std::string& fortran = "False") {
        return "{'descr': " + descr + ", 'fortran_order': " + fortran + ", 'shape': " + shape + "}";
    };
    const std::string six = packed<float>({1, 2, 3, 4, 5, 6});
    expect_bad("a.npy", "", {"empty"});
    expect_bad("a.npy", "junk that is no array", {"not a NumPy array"});
    expect_bad("a.npy", npy(header("(6,)"), six), {"shape (6,)", "(N, 3)", "x, y, z"});
    expect_bad("a.npy", npy(header("(3, 2)"), six), {"shape (3, 2)", "(N, 3)"});
    expect_bad("a.npy", npy(header("(1, 2, 3)"), six), {"shape (1, 2, 3)"});
    expect_bad("a.npy", npy(header("(2, 3)", "'<f4'", "True"), six), {"Fortran order", "ascontiguousarray"});
    expect_bad("a.npy", npy(header("(2, 3)", "'<c8'"), six + six), {"'<c8'"});
    expect_bad("a.npy", npy(header("(2, 3)", "'|O'"), six), {"'|O'"});
    expect_bad("a.npy", npy(header("(2, 3)", "'|b1'"), "123456"), {"truth values"});
    expect_bad("a.npy", npy(header("(2,)", "[('x', '<f4'), ('y', '<f4')]"), six), {"no field 'z'"});
    expect_bad("a.npy", npy(header("(2,)", "[('x', '<f4', (3,))]"), six), {"fields are more than numbers"});
    expect_bad("a.npy", npy(header("(3, 3)"), six), {"cut off"});
    expect_bad("a.npy", npy(header("(4000000000000000000, 3)"), six), {"larger than any memory"});
    expect_bad("a.npy", npy(header("(2, 3)"), six).substr(0, 30), {"cut off"});

    expect_bad("a.csv", "1,2,3\n1,2\n", {"line 2", "2 columns, not 3"});
    expect_bad("a.csv", "1,2,3,4\n", {"line 1", "4 columns, not 3"});
    expect_bad("a.csv", "x,y,z\n1,two,3\n", {"line 2", "'two'"});

    expect_bad("a.json", "7", {"row 0", "neither an array nor an object"});
    expect_bad("a.json", "[[1,2,3],[1,2]]", {"row 1", "2 of the 3 numbers x, ..., z"});
    expect_bad("a.json", "[[1,2,3],[1,2,3,4]]", {"row 1", "4 of the 3 numbers"});
    expect_bad("a.json", "[[1,2,3],[1,\"2\",3]]", {"row 1", "the text '2'"});
    expect_bad("a.json", "[[1,2,3],[1,[2],3]]", {"row 1", "an array"});
    expect_bad("a.json", "[[1,2,3],[1,true,3]]", {"row 1", "truth value"});
    expect_bad("a.json", "[[1,2,3],[1,2,3}]", {"row 1", "no JSON"});
    expect_bad("a.json", "[[1,2,3]", {"row 1", "cut off"});
    expect_bad("a.json", "[[1,2,3],[1,2", {"row 1", "cut off"});
    expect_bad("a.json", "[[1,2,3] [1,2,3]]", {"row 1", "comma"});
    expect_bad("a.json", "[[1,2,3]] [4,5,6]", {"follows the array"});
    expect_bad("a.json", "[{\"x\":1,\"y\":2}]", {"row 0", "2 of the 3"});
    expect_bad("a.json", "[" + std::string(100000, '['), {"row 0", "longer than 64 KiB"});

    EXPECT_THROW(row_format("a.txt"), UsageError);
    EXPECT_THROW(row_format("-"), UsageError);
    EXPECT_THROW(row_format("a.npy", "xml"), UsageError);
    EXPECT_EQ(row_format("a.txt", "csv"), RowFormat::csv);
    EXPECT_EQ(row_format("a.NPY.gz"), RowFormat::npy);
}

TEST(Rows, ThoseBeforeAFaultAreRead) {
    TempFolder folder;
    const auto reader =
        open_rows<double>(folder.file("a.csv", "1,2,3\n4,5,6\n7,8\n"), RowFormat::csv, points);
    std::vector<double> numbers;
    EXPECT_THROW(reader->read(numbers, 10), InputError);
    EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3, 4, 5, 6}));
}

/// A hit and a miss in records, as queries answer them.
std::vector<Column> columns_of_hits() {
    ColumnList list;
    list("query", std::uint64_t());
    list_columns(Hit<float>(), list);
    list("hit", false);
    return list.all;
}
std::string two_records() {
    std::string records;
    const Hit<float> hit{0.1f, 0.25f, 1e-20f, 7, 0, 0, 8};
    append_record(records, [&](Record& record) {
        record("query", std::uint64_t(1) << 40), list_columns(hit, record), record("hit", true);
    });
    append_record(records, [&](Record& record) {
        record("query", std::uint64_t(3)), list_columns(Hit<float>(), record), record("hit", false);
    });
    return records;
}
void write(const std::filesystem::path& path, int chunks) {
    RowWriter out(path, row_format(path), columns_of_hits());
    for (int i = 0; i < chunks; ++i) {
        out.write(out.encode(two_records()), 2);
    }
    EXPECT_EQ(out.rows(), 2u * static_cast<unsigned>(chunks));
    out.finish();
}

TEST(RowWriter, WritesEveryFormat) {
    TempFolder folder;
    write(folder / "a.csv", 1);
    EXPECT_EQ(contents(folder / "a.csv"),
              "query,primitive,t,u,v,hit\n1099511627776,7,0.1,0.25,1e-20,1\n3,4294967295,inf,0,0,0\n");
    write(folder / "a.json", 1);
    const std::string first =
        "{\"query\":1099511627776,\"primitive\":7,\"t\":0.1,\"u\":0.25,\"v\":1e-20,\"hit\":true}";
    const std::string second = "{\"query\":3,\"primitive\":null,\"t\":null,\"u\":0,\"v\":0,\"hit\":false}";
    EXPECT_EQ(contents(folder / "a.json"), "[\n" + first + ",\n" + second + "\n]\n");
    write(folder / "a.json", 2);
    EXPECT_EQ(contents(folder / "a.json"),
              "[\n" + first + ",\n" + second + ",\n" + first + ",\n" + second + "\n]\n");
    write(folder / "a.json", 0);
    EXPECT_EQ(contents(folder / "a.json"), "[]\n");

    write(folder / "a.npy", 3);
    const std::string bytes = contents(folder / "a.npy");
    const std::size_t header = bytes.size() - 3 * two_records().size();
    EXPECT_EQ(header % 64, 0u);
    EXPECT_NE(bytes.find("'descr': [('query', '<u8'), ('primitive', '<u4'), ('t', '<f4'), ('u', '<f4'), "
                         "('v', '<f4'), ('hit', '|b1')], 'fortran_order': False, 'shape': (6,"),
              std::string::npos)
        << bytes;
    EXPECT_EQ(bytes.substr(header), two_records() + two_records() + two_records());
    // What is written can be read as rows again.
    const InputColumns read{{"u", "query"}};
    EXPECT_EQ(rows_of<double>(folder / "a.npy", read, 4).size(), 12u);
    EXPECT_EQ(rows_of<double>(folder / "a.npy", read)[1], 1099511627776.0);
    write(folder / "a.npy", 0);
    EXPECT_TRUE(rows_of<double>(folder / "a.npy", read).empty());
}

TEST(RowWriter, AFileThatEndsEarlyIsValidUnderAnotherName) {
    TempFolder folder;
    for (const std::string name : {"a.npy", "a.csv", "a.json"}) {
        folder.file(name, "precious");
        {
            RowWriter out(folder / name, row_format(name), columns_of_hits(), 100);
            out.write(out.encode(two_records()), 2);
            out.finish_as(folder / ("b" + name));
        }
        EXPECT_EQ(contents(folder / name), "precious");
        EXPECT_EQ(rows_of<double>(folder / ("b" + name), {{"query", "u"}}).size(), 4u) << name;
        { const RowWriter unfinished(folder / name, row_format(name), columns_of_hits()); }
        EXPECT_EQ(contents(folder / name), "precious");
    }
    EXPECT_EQ(folder.file_count(), 6u) << "nothing else is left";
}

TEST(RowWriter, FullDisksAndPipesAreRefused) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
    for (const RowFormat format : {RowFormat::npy, RowFormat::csv, RowFormat::json})
        expect_output_error(
            [&] {
                RowWriter out("/dev/full", format, columns_of_hits(), 100000);
                std::string records;
                for (int i = 0; i < 50000; ++i) records += two_records();
                out.write(out.encode(records), 100000);
                out.finish();
            },
            {"/dev/full", "No space left"});
    expect_output_error([] { RowWriter("/dev/null", RowFormat::npy, columns_of_hits()); },
                        {"number of rows"});
    expect_output_error([] { RowWriter("/no/such/folder/a.npy", RowFormat::npy, columns_of_hits()); },
                        {"no folder"});
}

}  // namespace
}  // namespace hedgerow
