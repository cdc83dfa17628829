/// Snapshots of runs as files of rows: a row a particle.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <hedgerow/base/column.h>
#include <hedgerow/io/rows.h>

namespace hedgerow::cli {

constexpr std::size_t snapshot_rows_at_once = 1 << 15;

/// Writes a row with these columns for each of `count` particles. each(i, f) calls f(name, number) for the
/// columns of particle i.
template <class Each>
void save_snapshot_rows(const std::filesystem::path& path, const ColumnList& columns, std::size_t count,
                        Each each) {
    RowWriter out(path, row_format(path), columns.all, count);
    for (std::size_t first = 0; first < count; first += snapshot_rows_at_once) {
        const std::size_t some = std::min(snapshot_rows_at_once, count - first);
        std::string records;
        append_records(records, some, columns.all.size() * sizeof(double),
                       [&](std::size_t k, Record& record) { each(first + k, record); });
        out.write(out.encode(std::move(records)), some);
    }
    out.finish();
}

/// Reads the rows of a snapshot: calls take(numbers) for each, with a pointer to its numbers in these
/// columns.
template <class Take>
void load_snapshot_rows(const std::filesystem::path& path, const ColumnList& columns, Take take) {
    InputColumns wanted;
    for (const Column& column : columns.all) wanted.names.push_back(column.name);
    const auto rows = open_rows<double>(path, row_format(path), wanted);
    std::vector<double> numbers;
    while (const std::size_t count = rows->read(numbers, snapshot_rows_at_once))
        for (std::size_t i = 0; i < count; ++i) take(&numbers[i * columns.all.size()]);
}

}  // namespace hedgerow::cli
