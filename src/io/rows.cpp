/// Readers of rows, by format.
#include <hedgerow/io/rows.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <hedgerow/base/error.h>

#include "csv_rows.h"
#include "json_rows.h"
#include "npy_format.h"
#include "readers.h"
#include "text.h"

namespace hedgerow {

namespace {

constexpr std::string_view row_formats[] = {"npy", "csv", "json"};

/// Rows in text, which `Rows` reads one by one.
template <class T, class Rows>
class TextRows final : public RowReader<T> {
public:
    TextRows(const std::filesystem::path& path, const InputColumns& columns, const Progress& progress)
        : file_(path, progress, detail::Pipes::yes), rows_(file_, columns), columns_(columns.size()) {
        if (file_.at_end()) file_.fail("has nothing in it. Write a line of names, or an empty array");
    }
    std::size_t read(std::vector<T>& numbers, std::size_t most) override {
        numbers.resize(most * columns_);
        std::size_t rows = 0;
        try {
            while (rows < most && rows_.next(&numbers[rows * columns_])) ++rows;
        } catch (...) {
            numbers.resize(rows * columns_);
            throw;
        }
        numbers.resize(rows * columns_);
        return rows;
    }

private:
    detail::ByteSource file_;
    Rows rows_;
    std::size_t columns_;
};

/// Numbers of type From, `stride` bytes apart, converted to a column of rows that have `columns` each.
template <class T, class From>
void read_column(const unsigned char* from, std::size_t stride, bool swapped, T* to, std::size_t columns,
                 std::size_t rows) {
    for (std::size_t row = 0; row < rows; ++row, from += stride, to += columns) {
        From x;
        std::memcpy(&x, from, sizeof(From));
        if (swapped) {
            unsigned char bytes[sizeof(From)];
            std::reverse_copy(from, from + sizeof(From), bytes);
            std::memcpy(&x, bytes, sizeof(From));
        }
        if constexpr (std::is_same_v<From, double>)
            *to = detail::rounded<T>(x);
        else
            *to = static_cast<T>(x);
    }
}
template <class T>
using ReadColumn = void (*)(const unsigned char*, std::size_t, bool, T*, std::size_t, std::size_t);
template <class T>
ReadColumn<T> reader_of(const std::string& dtype) {
    if (dtype == "f4") return read_column<T, float>;
    if (dtype == "f8") return read_column<T, double>;
    if (dtype == "i1") return read_column<T, std::int8_t>;
    if (dtype == "i2") return read_column<T, std::int16_t>;
    if (dtype == "i4") return read_column<T, std::int32_t>;
    if (dtype == "i8") return read_column<T, std::int64_t>;
    if (dtype == "u1" || dtype == "b1") return read_column<T, std::uint8_t>;
    if (dtype == "u2") return read_column<T, std::uint16_t>;
    if (dtype == "u4") return read_column<T, std::uint32_t>;
    return read_column<T, std::uint64_t>;
}

/// Rows of a NumPy array: of numbers, or of records.
template <class T>
class NpyRows final : public RowReader<T> {
public:
    NpyRows(const std::filesystem::path& path, const InputColumns& columns, const Progress& progress)
        : file_(path, progress, detail::Pipes::yes), wanted_(columns) {
        const detail::NpyHeader header = detail::read_npy_header(file_);
        if (header.fortran && header.shape.size() > 1)
            file_.fail("the array is in Fortran order. Save numpy.ascontiguousarray(rows)");
        if (header.fields.empty())
            find_columns(header);
        else
            find_fields(header);
        as_in_memory_ = as_in_memory();
        rows_ = left_ = header.shape[0];
        detail::expect_npy_elements(file_, header);
    }
    std::optional<std::uint64_t> size() const override { return rows_; }
    std::size_t read(std::vector<T>& numbers, std::size_t most) override {
        const std::size_t columns = wanted_.size();
        // Whatever size a header gives to a record, a chunk takes little memory.
        constexpr std::size_t most_bytes = std::size_t(1) << 26;
        most = std::min(most, std::max<std::size_t>(1, most_bytes / row_bytes_));
        std::size_t rows = static_cast<std::size_t>(std::min<std::uint64_t>(most, left_));
        bytes_.resize(rows * row_bytes_);
        const std::size_t got = file_.read(bytes_.data(), bytes_.size());
        const bool cut = got < bytes_.size();
        if (cut) rows = got / row_bytes_;
        numbers.resize(rows * columns);
        // Convert some rows at a time, so that they stay in the cache.
        constexpr std::size_t some = 512;
        for (std::size_t row = 0; row < rows; row += some) convert(row, std::min(some, rows - row), numbers);
        left_ -= rows;
        if (cut)
            file_.fail("the file ends in row " + std::to_string(rows_ - left_) + " of " +
                       std::to_string(rows_) + ". It was cut off: fetch it again");
        return rows;
    }

private:
    struct Place {
        std::size_t offset;
        ReadColumn<T> read;
        bool swapped;
    };

    /// Whether rows begin with the numbers that are read, as they are in memory.
    bool as_in_memory() const {
        bool equal = !places_.empty();
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const Place& p = places_[i];
            equal = equal && p.offset == i * sizeof(T) && p.read == ReadColumn<T>(read_column<T, T>) &&
                    !p.swapped;
        }
        return equal;
    }
    void copy(std::size_t first, std::size_t rows, std::vector<T>& numbers) const {
        const std::size_t columns = wanted_.size(), given = places_.size();
        for (std::size_t row = first; row < first + rows; ++row) {
            T* const to = numbers.data() + row * columns;
            std::memcpy(to, bytes_.data() + row * row_bytes_, given * sizeof(T));
            for (std::size_t i = given; i < columns; ++i)
                to[i] = static_cast<T>(wanted_.defaults[i - wanted_.required()]);
        }
    }
    void convert(std::size_t first, std::size_t rows, std::vector<T>& numbers) const {
        if (as_in_memory_) return copy(first, rows, numbers);
        const std::size_t columns = wanted_.size();
        T* const to = numbers.data() + first * columns;
        const unsigned char* const from = bytes_.data() + first * row_bytes_;
        for (std::size_t i = 0; i < places_.size(); ++i)
            places_[i].read(from + places_[i].offset, row_bytes_, places_[i].swapped, to + i, columns, rows);
        for (std::size_t i = places_.size(); i < columns; ++i)
            for (std::size_t row = 0; row < rows; ++row)
                to[row * columns + i] = static_cast<T>(wanted_.defaults[i - wanted_.required()]);
    }
    static std::string text_of(const std::vector<std::size_t>& shape) {
        std::string text;
        for (const std::size_t n : shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
        return text + (shape.size() == 1 ? "," : "");
    }
    void add_place(std::size_t offset, const detail::NpyType& type) {
        places_.push_back({offset, reader_of<T>(type.dtype), type.order != std::endian::native});
    }
    void find_columns(const detail::NpyHeader& header) {
        const std::size_t width = header.shape.size() == 2 ? header.shape[1] : 0;
        if (width != wanted_.size() && width != wanted_.required()) {
            std::string all = "(N, " + std::to_string(wanted_.required()) + ")";
            if (!wanted_.defaults.empty()) all += " or (N, " + std::to_string(wanted_.size()) + ")";
            detail::fail_for_columns([&] {
                file_.fail("the array has shape (" + text_of(header.shape) + "), but these rows are " + all +
                           ": " + names() + ". Reshape it");
            });
        }
        if (header.type.dtype == "b1") file_.fail("the array has truth values where numbers should stand");
        for (std::size_t i = 0; i < width; ++i) add_place(i * header.type.item, header.type);
        row_bytes_ = width * header.type.item;
    }
    void find_fields(const detail::NpyHeader& header) {
        if (header.shape.size() != 1)
            file_.fail("the records have shape (" + text_of(header.shape) + "), but should be (N,)");
        for (const std::string& name : wanted_.names) {
            const auto named = [&](const detail::NpyField& f) { return f.name == name; };
            const auto at = std::find_if(header.fields.begin(), header.fields.end(), named);
            if (at == header.fields.end()) break;
            add_place(at->offset, at->type);
        }
        if (places_.size() < wanted_.required())
            detail::fail_for_columns([&] {
                file_.fail("the records have no field '" + wanted_.names[places_.size()] +
                           "'. These rows need " + names());
            });
        if (places_.size() < wanted_.size()) places_.resize(wanted_.required());
        row_bytes_ = header.type.item;
    }
    std::string names() const {
        std::string all;
        for (const std::string& name : wanted_.names) all += (all.empty() ? "" : ", ") + name;
        return all;
    }
    detail::ByteSource file_;
    InputColumns wanted_;
    std::vector<Place> places_;
    bool as_in_memory_ = false;
    std::size_t row_bytes_ = 0;
    std::uint64_t rows_ = 0, left_ = 0;
    std::vector<unsigned char> bytes_;
};

}  // namespace

RowFormat row_format(const std::filesystem::path& path, std::string_view name) {
    std::string wanted(name);
    if (wanted.empty()) wanted = path == "-" ? "" : detail::format_of(path);
    if (wanted.starts_with('.')) wanted.erase(0, 1);
    const auto at = std::find(std::begin(row_formats), std::end(row_formats), wanted);
    if (at == std::end(row_formats))
        throw UsageError(
            (path == "-" ? std::string("a pipe") : path.string()) + ": the format " +
            (wanted.empty() ? "" : detail::shown(wanted) + " ") +
            "is not known for rows; name one with --format or by the file's ending: npy, csv or json");
    return static_cast<RowFormat>(at - std::begin(row_formats));
}

template <class T>
std::unique_ptr<RowReader<T>> open_rows(const std::filesystem::path& path, RowFormat format,
                                        const InputColumns& columns, const Progress& progress) {
    switch (format) {
        case RowFormat::npy:
            return std::make_unique<NpyRows<T>>(path, columns, progress);
        case RowFormat::csv:
            return std::make_unique<TextRows<T, detail::CsvRows>>(path, columns, progress);
        default:
            return std::make_unique<TextRows<T, detail::JsonRows>>(path, columns, progress);
    }
}
template std::unique_ptr<RowReader<float>> open_rows(const std::filesystem::path&, RowFormat,
                                                     const InputColumns&, const Progress&);
template std::unique_ptr<RowReader<double>> open_rows(const std::filesystem::path&, RowFormat,
                                                      const InputColumns&, const Progress&);

}  // namespace hedgerow
