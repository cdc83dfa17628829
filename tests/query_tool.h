/// What the tests of `hedgerow query` share: files of rows, and what the tool makes of them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <hedgerow/io/npy.h>
#include <hedgerow/io/rows.h>
#include <hedgerow/scenes/random.h>

#include "tool.h"

namespace hedgerow {

class QueryTest : public ToolTest {
protected:
    /// All numbers of the columns in a file.
    static std::vector<double> rows_of(const std::filesystem::path& path,
                                       const std::vector<std::string>& names) {
        std::vector<double> all, some;
        const auto reader = open_rows<double>(path, row_format(path), InputColumns{names});
        while (reader->read(some, 1000) > 0) all.insert(all.end(), some.begin(), some.end());
        return all;
    }
    /// Random numbers around the unit cube, as rows.
    template <class T>
    void write_rows(const std::string& name, std::size_t rows, std::size_t columns, double last = 0) const {
        std::vector<T> numbers(rows * columns);
        Random random(7, 0);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            numbers[i] = static_cast<T>(random.uniform() * 4 - 2);
            // Boxes have a high corner above the low one.
            if (last > 0 && i % columns >= columns / 2)
                numbers[i] = numbers[i - columns / 2] + static_cast<T>(last * random.uniform());
        }
        save_npy<T>(file(name), numbers, {rows, columns});
    }
    static void expect_done(const std::string& arguments) {
        const auto r = run(arguments);
        EXPECT_EQ(r.code, 0) << arguments << "\n" << r.output;
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(file(name), std::ios::binary) << text;
    }
};

}  // namespace hedgerow
