/// Rows of numbers as text, one a line; points among them.
#include "csv_rows.h"

#include <algorithm>

#include "mesh_parts.h"
#include "readers.h"

namespace hedgerow::detail {

namespace {

std::string_view unquoted(std::string_view field) {
    const bool has_quotes = field.size() >= 2 && field.front() == '"' && field.back() == '"';
    return has_quotes ? field.substr(1, field.size() - 2) : field;
}

template <class T, int D>
PointCloud<T, D> read_points(ByteSource& file, bool more) {
    InputColumns axes{{"x", "y"}};
    if (D == 3) axes.names.emplace_back("z");
    CsvRows rows(file, axes, more);
    PointCloud<T, D> cloud;
    for (Vec<T, D> p; rows.next(p.data);) {
        check_room(file, cloud.points.size(), "points");
        append(file, cloud.points, p);
    }
    if (const auto count = rows.count()) {
        // The count tells a comment of numbers from a point.
        if (cloud.size() == *count + 1) cloud.points.erase(cloud.points.begin());
        if (cloud.size() != *count)
            file.fail("its first line promises " + std::to_string(*count) + " points, but there are " +
                      std::to_string(cloud.size()) +
                      ". It was cut off, or the count is wrong: fetch it again");
    }
    return cloud;
}

}  // namespace

template <class T>
bool CsvRows::next(T* numbers) {
    while (lines_.next(text_)) {
        const std::string_view line = trimmed(text_);
        if (line.empty() || line.front() == '#' || line.starts_with("//")) continue;
        split(line);
        if (more_ && skip_of_counted()) continue;
        const bool names = !begun_ && !number<double>(fields_[0]);
        if (!begun_) begin(names);
        if (names) continue;
        read_row(numbers);
        return true;
    }
    return false;
}

bool CsvRows::skip_of_counted() {
    if (!begun_ && !count_ && fields_.size() == 1)
        if ((count_ = parse_integer<std::uint64_t>(fields_[0]))) return true;
    if (!count_) return false;
    if (fields_.size() > columns_.required() && !number<double>(fields_[0])) fields_.erase(fields_.begin());
    if (begun_) return false;
    const auto is_number = [&](std::string_view field) { return number<double>(field).has_value(); };
    return fields_.size() < columns_.required() ||
           !std::all_of(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(columns_.required()),
                        is_number);
}

template <class T>
std::optional<T> CsvRows::number(std::string_view field) {
    // Where semicolons divide a line, a comma may stand for the decimal point.
    if (separator_ == ';' && field.find('.') == field.npos && field.find(',') != field.npos) {
        decimal_ = field;
        decimal_[decimal_.find(',')] = '.';
        field = decimal_;
    }
    return parse_coordinate<T>(field, lines_.file().rounding());
}

void CsvRows::split(std::string_view line) {
    fields_.clear();
    separator_ = line.find(';') != line.npos ? ';' : line.find(',') != line.npos ? ',' : ' ';
    if (separator_ == ' ') {
        for (auto word = take_word(line); !word.empty(); word = take_word(line))
            fields_.push_back(unquoted(word));
        return;
    }
    for (std::size_t end = 0; end != line.npos;) {
        end = line.find(separator_);
        fields_.push_back(unquoted(trimmed(line.substr(0, end))));
        if (end != line.npos) line.remove_prefix(end + 1);
    }
}

void CsvRows::begin(bool has_names) {
    begun_ = true;
    // Find the columns by their names. Those that may be left out are read if all of them are named.
    const auto place_of = [&](const std::string& name) {
        const auto is_name = [&](std::string_view f) { return lower_case(f) == name; };
        return static_cast<std::size_t>(std::find_if(fields_.begin(), fields_.end(), is_name) -
                                        fields_.begin());
    };
    place_.clear();
    for (std::size_t i = 0; has_names && i < columns_.size(); ++i) {
        const std::size_t place = place_of(columns_.names[i]);
        if (place == fields_.size()) break;
        place_.push_back(place);
    }
    named_ = has_names;
    if (named_) {
        if (place_.size() < columns_.required()) {
            std::string all;
            for (std::size_t i = 0; i < columns_.required(); ++i)
                all += (i == 0 ? "" : ", ") + columns_.names[i];
            fail_for_columns([&] {
                fail(shown(fields_[0]) + " is no number, and the line does not name the column " +
                     columns_.names[place_.size()] + ". Name the columns " + all +
                     ", or leave the line out if it is no row");
            });
        }
        if (place_.size() < columns_.size()) place_.resize(columns_.required());
        width_ = fields_.size();
        return;
    }
    // Without names, the columns are in their order.
    if (!more_ && fields_.size() != columns_.size() && fields_.size() != columns_.required())
        fail_for_columns([&] { fail_for_width(columns_.required()); });
    width_ = !more_ && fields_.size() == columns_.size() ? columns_.size() : columns_.required();
    place_.resize(width_);
    for (std::size_t i = 0; i < width_; ++i) place_[i] = i;
}

template <class T>
void CsvRows::read_row(T* numbers) {
    if (fields_.size() < width_ || (fields_.size() > width_ && !more_)) fail_for_width(width_);
    for (std::size_t i = 0; i < place_.size(); ++i) {
        const std::string_view field = fields_[place_[i]];
        const auto x = number<T>(field);
        if (!x)
            fail(shown(field) + " where a number should stand. " +
                 (field.find(' ') == field.npos ? "Repair the file"
                                                : "Divide columns by semicolons if numbers have commas"));
        numbers[i] = *x;
    }
    for (std::size_t i = place_.size(); i < columns_.size(); ++i)
        numbers[i] = static_cast<T>(columns_.defaults[i - columns_.required()]);
}

void CsvRows::fail_for_width(std::size_t width) const {
    fail("has " + std::to_string(fields_.size()) + " columns, not " + std::to_string(width) +
         (named_ ? ". Write as many as the first line names"
                 : ". Leave out the others, or name the columns " + columns_.names[0] + ", " +
                       columns_.names[1] + ", ... in the first line"));
}
void CsvRows::fail(const std::string& what) const {
    lines_.fail(what);
}

template bool CsvRows::next(float*);
template bool CsvRows::next(double*);

template <class T, int D>
PointCloud<T, D> read_csv_points(ByteSource& file) {
    return read_points<T, D>(file, false);
}

template <class T, int D>
PointCloud<T, D> read_xyz_points(ByteSource& file) {
    return read_points<T, D>(file, true);
}

template PointCloud<float, 2> read_csv_points(ByteSource&);
template PointCloud<float, 3> read_csv_points(ByteSource&);
template PointCloud<double, 2> read_csv_points(ByteSource&);
template PointCloud<double, 3> read_csv_points(ByteSource&);
template PointCloud<float, 2> read_xyz_points(ByteSource&);
template PointCloud<float, 3> read_xyz_points(ByteSource&);
template PointCloud<double, 2> read_xyz_points(ByteSource&);
template PointCloud<double, 3> read_xyz_points(ByteSource&);

}  // namespace hedgerow::detail
