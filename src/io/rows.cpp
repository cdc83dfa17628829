/// Readers of rows, by format.
#include <hedgerow/io/rows.h>

#include <algorithm>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

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

/// The number of type From at an address, in either byte order.
template <class T, class From>
T number_at(const unsigned char* from, bool swapped) {
    unsigned char bytes[sizeof(From)];
    std::memcpy(bytes, from, sizeof(From));
    if (swapped) std::reverse(std::begin(bytes), std::end(bytes));
    From x;
    std::memcpy(&x, bytes, sizeof(From));
    if constexpr (std::is_same_v<From, double>)
        return detail::rounded<T>(x);
    else
        return static_cast<T>(x);
}
template <class T>
using NumberAt = T (*)(const unsigned char*, bool);
template <class T>
NumberAt<T> reader_of(const std::string& dtype) {
    if (dtype == "f4") return number_at<T, float>;
    if (dtype == "f8") return number_at<T, double>;
    if (dtype == "i1") return number_at<T, std::int8_t>;
    if (dtype == "i2") return number_at<T, std::int16_t>;
    if (dtype == "i4") return number_at<T, std::int32_t>;
    if (dtype == "i8") return number_at<T, std::int64_t>;
    if (dtype == "u1" || dtype == "b1") return number_at<T, std::uint8_t>;
    if (dtype == "u2") return number_at<T, std::uint16_t>;
    if (dtype == "u4") return number_at<T, std::uint32_t>;
    if (dtype == "u8") return number_at<T, std::uint64_t>;
    return nullptr;
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
        for (std::size_t i = 0; i < columns; ++i) read_column(i, numbers, rows);
        left_ -= rows;
        if (cut)
            file_.fail("the file ends in row " + std::to_string(rows_ - left_) + " of " +
                       std::to_string(rows_) + ". It was cut off: fetch it again");
        return rows;
    }

private:
    struct Place {
        std::size_t offset;
        NumberAt<T> number_at;
        bool swapped;
    };

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
            file_.fail("the array has shape (" + text_of(header.shape) + "), but these rows are " + all +
                       ": " + names() + ". Reshape it");
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
            file_.fail("the records have no field '" + wanted_.names[places_.size()] + "'. These rows need " +
                       names());
        if (places_.size() < wanted_.size()) places_.resize(wanted_.required());
        row_bytes_ = header.type.item;
    }
    std::string names() const {
        std::string all;
        for (const std::string& name : wanted_.names) all += (all.empty() ? "" : ", ") + name;
        return all;
    }
    void read_column(std::size_t i, std::vector<T>& numbers, std::size_t rows) const {
        const std::size_t columns = wanted_.size();
        if (i >= places_.size()) {
            const T value = static_cast<T>(wanted_.defaults[i - wanted_.required()]);
            for (std::size_t row = 0; row < rows; ++row) numbers[row * columns + i] = value;
            return;
        }
        const Place& p = places_[i];
        const unsigned char* from = bytes_.data() + p.offset;
        for (std::size_t row = 0; row < rows; ++row, from += row_bytes_)
            numbers[row * columns + i] = p.number_at(from, p.swapped);
    }

    detail::ByteSource file_;
    InputColumns wanted_;
    std::vector<Place> places_;
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
