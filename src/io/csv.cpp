/// Points as text, one a line.
#include <algorithm>
#include <array>

#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

template <class T, int D>
class CsvReader {
public:
    /// `more`: lines may have further fields after the coordinates.
    explicit CsvReader(ByteSource& file, bool more = false) : file_(file), more_(more) {}

    PointCloud<T, D> read() {
        std::string text;
        while (file_.line(text)) {
            ++line_;
            std::string_view line = text;
            if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
            line = trimmed(line);
            if (line.empty() || line.front() == '#') continue;
            split(line);
            if (first_ && !parse_real<T>(fields_[0]))
                name_columns();
            else
                read_point();
            first_ = false;
        }
        return std::move(cloud_);
    }

private:
    void split(std::string_view line) {
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
    static std::string_view unquoted(std::string_view field) {
        const bool has_quotes = field.size() >= 2 && field.front() == '"' && field.back() == '"';
        return has_quotes ? field.substr(1, field.size() - 2) : field;
    }
    void name_columns() {
        bool found = true;
        for (std::size_t a = 0; a < D; ++a) {
            const auto is_axis = [&](std::string_view f) {
                return lower_case(f) == std::string(1, "xyz"[a]);
            };
            const auto at = std::find_if(fields_.begin(), fields_.end(), is_axis);
            column_[a] = static_cast<std::size_t>(at - fields_.begin());
            found = found && at != fields_.end();
        }
        named_ = found;
        if (named_)
            columns_ = fields_.size();
        else
            for (std::size_t a = 0; a < D; ++a) column_[a] = a;
    }
    void read_point() {
        check_room(file_, cloud_.points.size(), "points");
        if (fields_.size() < columns_ || (fields_.size() > columns_ && !more_))
            fail("has " + std::to_string(fields_.size()) + " columns, not " + std::to_string(columns_) +
                 (named_ ? ". Write as many as the first line names"
                         : ". Leave out the others, or name the columns x, y, ... in the first line"));
        Vec<T, D> p;
        for (std::size_t a = 0; a < D; ++a) {
            const std::string_view field = fields_[column_[a]];
            const auto x = parse_real<T>(field);
            if (!x) fail(shown(field) + " where a number should stand. Repair the file");
            p[static_cast<int>(a)] = *x;
        }
        append(file_, cloud_.points, p);
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(line_) + ": " + what);
    }

    static std::array<std::size_t, D> in_order() {
        std::array<std::size_t, D> places{};
        for (std::size_t a = 0; a < D; ++a) places[a] = a;
        return places;
    }

    ByteSource& file_;
    std::uint64_t line_ = 0;
    bool more_, first_ = true, named_ = false;
    std::size_t columns_ = D;
    std::array<std::size_t, D> column_ = in_order();
    std::vector<std::string_view> fields_;
    PointCloud<T, D> cloud_;
};

}  // namespace

template <class T, int D>
PointCloud<T, D> read_csv_points(ByteSource& file) {
    return CsvReader<T, D>(file).read();
}

template <class T, int D>
PointCloud<T, D> read_xyz_points(ByteSource& file) {
    return CsvReader<T, D>(file, true).read();
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
