/// Reads rows of numbers from JSON, one after the other, however long the file is.
#pragma once

#include <cstdint>
#include <string>

#include <hedgerow/base/column.h>

#include "text_source.h"

namespace hedgerow::detail {

/// Rows of an array, or rows one after the other (JSON Lines), as `open_rows` (io/rows.h) describes them. The
/// text of a row is found by its brackets, and then parsed.
class JsonRows {
public:
    JsonRows(ByteSource& file, InputColumns columns) : file_(file), columns_(std::move(columns)) {
        open_text(file_);
    }

    /// Reads a number for each column; false at the end. Throws InputError with the row's number. T is float
    /// or double.
    template <class T>
    bool next(T* numbers);

private:
    /// Finds the text of the next row; false at the end.
    bool find_row();
    /// Expects the end of the file; false.
    bool end_array();
    int next_letter();
    void read_text();
    [[noreturn]] void fail(const std::string& what) const;

    ByteSource& file_;
    InputColumns columns_;
    std::uint64_t row_ = 0;
    bool begun_ = false, in_array_ = false, ended_ = false;
    std::string text_;
};

}  // namespace hedgerow::detail
