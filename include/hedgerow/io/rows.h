/// Rows of numbers from and to files, a chunk at a time: what bulk queries read and write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/base/column.h>
#include <hedgerow/parallel/progress.h>

namespace hedgerow {

enum class RowFormat { npy, csv, json };

/// The format of that name ("npy", "csv" or "json"), or, if the name is empty, the one that the extension of
/// `path` tells (`.gz` may follow it). Throws UsageError where neither is known, as of "-".
RowFormat row_format(const std::filesystem::path& path, std::string_view name = "");

/// Reads rows in chunks, in memory that does not grow with the file. T is float or double; numbers are
/// rounded once, from the file's value to T.
template <class T>
class RowReader {
public:
    virtual ~RowReader() = default;

    /// Replaces `numbers` by those of the next rows, `most` of them or all that are left, each with a number
    /// for each column. Returns how many rows there are; 0 at the end. Throws InputError, naming the file,
    /// the place (row or line), the fault and a remedy, and Cancelled. After an exception `numbers` holds the
    /// rows before the fault.
    virtual std::size_t read(std::vector<T>& numbers, std::size_t most) = 0;
    /// The number of rows in the file, if it says so.
    virtual std::optional<std::uint64_t> size() const { return std::nullopt; }
};

/// Opens rows that have the given columns. "-" is the standard input, which may be a pipe, as may the file.
///
/// - npy: an array of N × C numbers in C order (versions 1 to 3, either byte order), or one of N records, in
///   which fields that have the columns' names are read.
/// - csv: a row per line, with numbers separated by semicolons, else by commas, else by white space. Lines
///   that are empty or begin with `#` or `//` are skipped. Between semicolons a number may have a comma in
///   place of its point. If the first line does not begin with a number, it must name the columns, which are
///   read. Otherwise rows have the columns in their order, and no more.
/// - json: an array of rows, or rows one after the other (JSON Lines). A row is an array of numbers, or an
///   object whose members have the columns' names. `null` is no number: NaN, or the column's default.
///
/// Files may be compressed by gzip, pipes not. Throws InputError as `read` does. A file of `.npy` that is
/// shorter than its header says is refused here.
template <class T>
std::unique_ptr<RowReader<T>> open_rows(const std::filesystem::path& path, RowFormat format,
                                        const InputColumns& columns, const Progress& progress = {});

/// Writes rows in chunks. The file appears under its name once it is finished, whole: it is written under
/// another name beside it. A device or a pipe, and "-", the standard output, are written directly.
///
/// - npy: an array of records with a field for each column (version 1, no gaps). Its header has room for any
///   number of rows, and the number is filled in at the end. So a pipe, in which nothing can be filled in,
///   is refused unless the number is given.
/// - csv: a line of names, then a line for each row; numbers have the fewest digits that read back as the
///   same number, flags are 0 and 1.
/// - json: an array of objects, one a line. Numbers that are not finite and ids of none are `null`.
class RowWriter {
public:
    /// `rows` is the number of rows, if it is known. Throws OutputError as all functions do, and UsageError
    /// for a name that ends in `.gz`.
    RowWriter(const std::filesystem::path& path, RowFormat format, std::vector<Column> columns,
              std::optional<std::uint64_t> rows = std::nullopt);
    ~RowWriter();
    RowWriter(const RowWriter&) = delete;
    RowWriter& operator=(const RowWriter&) = delete;

    /// `records` (append_record) as the format has them. Several threads may call it at once.
    std::string encode(std::string records) const;
    /// Writes what `encode` made of so many rows.
    void write(std::string_view encoded, std::uint64_t rows);
    /// The number of rows written so far.
    std::uint64_t rows() const;
    /// Ends the file, which has its name then. Throws OutputError if rows were announced and there are fewer.
    void finish();
    /// Ends the file with the rows that it has, under another name. Does nothing to a pipe but end its text.
    void finish_as(const std::filesystem::path& path);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace hedgerow
