/// Writers of rows, by format.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <hedgerow/base/error.h>
#include <hedgerow/io/rows.h>

#include "npy_format.h"
#include "output_file.h"
#include "text.h"

namespace hedgerow {

namespace {

/// Calls f with the number at an address.
template <class F>
void with_number(NumberType type, const char* at, F f) {
    const auto give = [&](auto number) {
        std::memcpy(&number, at, sizeof number);
        f(number);
    };
    switch (type) {
        case NumberType::flag:
            return f(*at != 0);
        case NumberType::id:  // NOLINT(bugprone-branch-clone): each gives another type
            return give(std::uint32_t());
        case NumberType::count:
            return give(std::uint64_t());
        case NumberType::f32:
            return give(float());
        case NumberType::f64:
            return give(double());
        case NumberType::sign:
            return give(std::int8_t());
    }
}

/// Appends a number. A zero has no sign in text.
template <class N>
void append_unsigned_zero(std::string& text, N number) {
    detail::append_number(text, number == 0 ? N(0) : number);
}
void append_csv(std::string& text, NumberType type, const char* at) {
    with_number(type, at, [&]<class N>(N number) {
        if constexpr (std::is_same_v<N, bool>)
            text.push_back(number ? '1' : '0');
        else
            append_unsigned_zero(text, number);
    });
}
void append_json(std::string& text, NumberType type, const char* at) {
    with_number(type, at, [&]<class N>(N number) {
        if constexpr (std::is_same_v<N, bool>) {
            text += number ? "true" : "false";
        } else {
            bool none = false;
            if constexpr (std::is_floating_point_v<N>) none = !std::isfinite(number);
            if constexpr (std::is_same_v<N, std::uint32_t>)
                none = number == std::numeric_limits<std::uint32_t>::max();
            if constexpr (std::is_same_v<N, std::int8_t>)
                none = number == std::numeric_limits<std::int8_t>::min();
            if (none)
                text += "null";
            else
                append_unsigned_zero(text, number);
        }
    });
}

/// The header of records. With `length`, it takes at least so many bytes.
std::string records_header(const std::vector<Column>& columns, std::uint64_t rows, std::size_t length = 0) {
    constexpr const char* dtypes[] = {"b1", "u4", "u8", "f4", "f8", "i1"};
    constexpr char order = std::endian::native == std::endian::little ? '<' : '>';
    std::string descr = "[";
    for (const Column& c : columns) {
        if (descr.size() > 1) descr += ", ";
        descr += "('" + c.name + "', '" + (size_of(c.type) == 1 ? '|' : order) +
                 dtypes[static_cast<std::size_t>(c.type)] + "')";
    }
    return detail::npy_header_of(descr + "]", {static_cast<std::size_t>(rows)}, length);
}

}  // namespace

struct RowWriter::State {
    RowFormat format;
    std::vector<Column> columns;
    std::optional<std::uint64_t> announced;
    std::unique_ptr<detail::OutputFile> file;
    std::size_t record_bytes = 0, header_bytes = 0;
    std::uint64_t rows = 0;

    /// Writes what is left to write when all rows are there.
    void end() {
        if (format == RowFormat::json) file->write(rows == 0 ? "[]\n" : "\n]\n");
        if (format == RowFormat::npy && rows != announced) {
            if (!file->seekable())
                throw OutputError("the output ends after " + std::to_string(rows) + " of " +
                                  std::to_string(*announced) + " rows, and a pipe cannot be corrected");
            file->seek(0);
            file->write(records_header(columns, rows, header_bytes));
        }
    }
};

RowWriter::RowWriter(const std::filesystem::path& path, RowFormat format, std::vector<Column> columns,
                     std::optional<std::uint64_t> rows)
    : state_(std::make_unique<State>()) {
    if (path.extension() == ".gz")
        throw UsageError(path.string() + ": rows are written without compression; leave .gz out");
    State& s = *state_;
    s.format = format, s.columns = std::move(columns), s.announced = rows;
    for (const Column& c : s.columns) s.record_bytes += size_of(c.type);
    s.file = path == "-" ? detail::OutputFile::standard_output() : std::make_unique<detail::OutputFile>(path);
    if (format == RowFormat::npy) {
        if (!rows && !s.file->seekable())
            throw OutputError(
                "a pipe of .npy needs the number of rows before the first: write a file, or choose csv or "
                "json");
        // The longest number fits into the header, so that any other does.
        s.header_bytes = records_header(s.columns, std::numeric_limits<std::uint64_t>::max()).size();
        s.file->write(records_header(s.columns, rows.value_or(0), s.header_bytes));
        if (!rows) s.announced = 0;
    } else if (format == RowFormat::csv) {
        std::string names;
        for (const Column& c : s.columns) names += (names.empty() ? "" : ",") + c.name;
        s.file->write(names + "\n");
    }
}
RowWriter::~RowWriter() = default;

std::string RowWriter::encode(std::string records) const {
    const State& s = *state_;
    if (s.format == RowFormat::npy) return records;
    std::string text;
    for (std::string_view left = records; !left.empty(); left.remove_prefix(s.record_bytes)) {
        const char* at = left.data();
        text += s.format == RowFormat::json ? ",\n{" : "";
        for (std::size_t i = 0; i < s.columns.size(); ++i) {
            const Column& c = s.columns[i];
            if (i > 0) text.push_back(',');
            if (s.format == RowFormat::json) {
                text += '"';
                text += c.name;
                text += "\":";
                append_json(text, c.type, at);
            } else {
                append_csv(text, c.type, at);
            }
            at += size_of(c.type);
        }
        text += s.format == RowFormat::json ? "}" : "\n";
    }
    return text;
}

void RowWriter::write(std::string_view encoded, std::uint64_t rows) {
    State& s = *state_;
    if (rows == 0) return;
    // The first row of JSON follows the array's bracket, not a comma.
    if (s.format == RowFormat::json && s.rows == 0) {
        s.file->write("[");
        encoded.remove_prefix(1);
    }
    s.file->write(encoded);
    s.rows += rows;
}
std::uint64_t RowWriter::rows() const {
    return state_->rows;
}
void RowWriter::finish() {
    state_->end();
    state_->file->commit();
}
void RowWriter::finish_as(const std::filesystem::path& path) {
    state_->end();
    state_->file->commit_as(path);
}

}  // namespace hedgerow
