/// Rows of numbers as text, one a line; points among them.
#include "csv_rows.h"

#include <algorithm>

#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

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
    return cloud;
}

}  // namespace

template <class T>
bool CsvRows::next(T* numbers) {
    while (file_.line(text_)) {
        ++line_;
        std::string_view line = text_;
        if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
        line = trimmed(line);
        if (line.empty() || line.front() == '#') continue;
        split(line);
        const bool names = !begun_ && !parse_real<T>(fields_[0]);
        if (!begun_) begin(names);
        if (names) continue;
        read_row(numbers);
        return true;
    }
    return false;
}

void CsvRows::split(std::string_view line) {
    fields_.clear();
    const char separator = line.find(';') != line.npos ? ';' : line.find(',') != line.npos ? ',' : ' ';
    if (separator == ' ') {
        for (auto word = take_word(line); !word.empty(); word = take_word(line)) fields_.push_back(word);
        return;
    }
    for (std::size_t end = 0; end != line.npos;) {
        end = line.find(separator);
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
    named_ = has_names && place_.size() >= columns_.required();
    if (named_) {
        if (place_.size() < columns_.size()) place_.resize(columns_.required());
        width_ = fields_.size();
        return;
    }
    // Without names, the columns are in their order.
    width_ = !more_ && fields_.size() == columns_.size() ? columns_.size() : columns_.required();
    place_.resize(width_);
    for (std::size_t i = 0; i < width_; ++i) place_[i] = i;
}

template <class T>
void CsvRows::read_row(T* numbers) {
    if (fields_.size() < width_ || (fields_.size() > width_ && !more_))
        fail("has " + std::to_string(fields_.size()) + " columns, not " + std::to_string(width_) +
             (named_ ? ". Write as many as the first line names"
                     : ". Leave out the others, or name the columns " + columns_.names[0] + ", " +
                           columns_.names[1] + ", ... in the first line"));
    for (std::size_t i = 0; i < place_.size(); ++i) {
        const std::string_view field = fields_[place_[i]];
        const auto x = parse_real<T>(field);
        if (!x) fail(shown(field) + " where a number should stand. Repair the file");
        numbers[i] = *x;
    }
    for (std::size_t i = place_.size(); i < columns_.size(); ++i)
        numbers[i] = static_cast<T>(columns_.defaults[i - columns_.required()]);
}

void CsvRows::fail(const std::string& what) const {
    file_.fail("line " + std::to_string(line_) + ": " + what);
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
