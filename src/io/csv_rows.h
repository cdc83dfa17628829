/// Reads rows of numbers from text, one a line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/base/column.h>

#include "other_columns.h"
#include "text_source.h"

namespace hedgerow::detail {

/// Lines of numbers, as `open_rows` (io/rows.h) and `load_points` (io/point_file.h) describe them.
class CsvRows {
public:
    /// `more`: lines may have further fields after the columns.
    CsvRows(ByteSource& file, InputColumns columns, bool more = false)
        : lines_(file), columns_(std::move(columns)), more_(more) {}

    /// Reads a number for each column; false at the end of the file. Throws InputError with the line. T is
    /// float or double.
    template <class T>
    bool next(T* numbers);
    /// The number of points that the file begins with, once the first was read: some files of lines with
    /// further fields have one, then perhaps a line of words, and a word before the numbers of each line.
    const std::optional<std::uint64_t>& count() const { return count_; }

private:
    /// Whether a line is the count or the line of words behind it. Drops the word before the numbers of a
    /// line.
    bool skip_of_counted();
    template <class T>
    std::optional<T> number(std::string_view field);
    void split(std::string_view line);
    /// Decides by the first line's fields where the columns are.
    void begin(bool has_names);
    template <class T>
    void read_row(T* numbers);
    [[noreturn]] void fail(const std::string& what) const;
    /// For a line of another number of fields.
    [[noreturn]] void fail_for_width(std::size_t width) const;

    LineSource lines_;
    InputColumns columns_;
    std::optional<std::uint64_t> count_;
    char separator_ = ' ';
    bool more_, begun_ = false, named_ = false;
    std::size_t width_ = 0;           // fields of a line
    std::vector<std::size_t> place_;  // of each column among the fields
    std::vector<std::string_view> fields_;
    std::string text_, decimal_;
};

}  // namespace hedgerow::detail
