/// Rows of numbers in JSON (RFC 8259), each parsed through nlohmann-json.
#include "json_rows.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <nlohmann/json.hpp>

#include "other_columns.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

constexpr std::size_t longest_row = std::size_t(1) << 16;

/// Takes the numbers of a row as the parser finds them. A function that returns false ends the parse, and
/// `wrong` says why.
template <class T>
class RowOfJson {
public:
    RowOfJson(const InputColumns& columns, T* numbers) : columns_(columns), numbers_(numbers) {
        for (std::size_t i = 0; i < columns.size(); ++i) numbers_[i] = default_of(i);
    }

    std::string wrong;
    /// How many columns have a number or `null`.
    std::size_t found = 0;
    bool is_array = false;

    bool null() { return skip_column(); }
    bool boolean(bool) { return refuse("a truth value"); }
    /// The parser calls this for integers with a sign, so 0 is −0.
    bool number_integer(std::int64_t x) { return number(x == 0 ? -T(0) : static_cast<T>(x)); }
    bool number_unsigned(std::uint64_t x) { return number(static_cast<T>(x)); }
    bool number_float(double x, const std::string& digits) {
        return number(parse_real<T>(digits).value_or(static_cast<T>(x)));
    }
    bool string(std::string& text) { return refuse("the text " + shown(text)); }
    bool binary(nlohmann::json::binary_t&) { return refuse("binary data"); }
    bool start_array(std::size_t) {
        is_array = depth_ == 0;
        return depth_++ == 0 || refuse("an array");
    }
    bool start_object(std::size_t) { return depth_++ == 0 || refuse("an object"); }
    bool end_array() { return true; }
    bool end_object() { return true; }
    bool key(std::string& name) {
        const auto at = std::find(columns_.names.begin(), columns_.names.end(), name);
        column_ = static_cast<std::size_t>(at - columns_.names.begin());
        other_member_ = at == columns_.names.end();
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) {
        wrong = "is no JSON";
        return false;
    }

private:
    T default_of(std::size_t i) const {
        return i < columns_.required() ? std::numeric_limits<T>::quiet_NaN()
                                       : static_cast<T>(columns_.defaults[i - columns_.required()]);
    }
    bool number(T x) {
        if (!is_array && other_member_) return true;
        if (column_ < columns_.size()) numbers_[column_] = x;
        return skip_column();
    }
    bool skip_column() {
        if (!is_array && other_member_) return true;
        ++found, ++column_;
        return true;
    }
    bool refuse(const std::string& what) {
        if (!is_array && other_member_ && depth_ == 1) return true;
        wrong = "has " + what + " where a number should stand";
        return false;
    }

    const InputColumns& columns_;
    T* numbers_;
    std::size_t column_ = 0;
    int depth_ = 0;
    bool other_member_ = false;
};

}  // namespace

void JsonRows::fail(const std::string& what) const {
    file_.fail("row " + std::to_string(row_) + " " + what + ". Repair the file");
}

int JsonRows::next_letter() {
    int c = file_.next();
    while (c != -1 && is_space(c)) c = file_.next();
    return c;
}

bool JsonRows::end_array() {
    ended_ = true;
    if (next_letter() != -1) file_.fail_here("something follows the array of rows. Repair the file");
    return false;
}

bool JsonRows::find_row() {
    if (ended_) return false;
    int c = next_letter();
    // The first bracket begins the array of rows if a row, or the array's end, follows it.
    if (!begun_) {
        begun_ = true;
        if (c == '[') {
            const int first = next_letter();
            in_array_ = first == '[' || first == '{' || first == ']';
            text_.assign(1, in_array_ ? static_cast<char>(first) : '[');
            if (!in_array_ && first != -1) text_.push_back(static_cast<char>(first));
            if (in_array_ && first == ']') return end_array();
            read_text();
            return true;
        }
    } else if (in_array_) {
        if (c == ']') return end_array();
        if (c == -1) fail("is missing: the array of rows has no end. The file was cut off");
        if (c != ',') fail("does not follow a comma");
        c = next_letter();
    }
    if (c == -1 && !in_array_) return false;
    if (c != '[' && c != '{') fail("is neither an array nor an object");
    text_.assign(1, static_cast<char>(c));
    read_text();
    return true;
}

void JsonRows::read_text() {
    int depth = 0;
    bool in_string = false, escaped = false;
    const auto count = [&](char c) {
        if (escaped)
            escaped = false;
        else if (in_string)
            escaped = c == '\\', in_string = c != '"';
        else if (c == '"')
            in_string = true;
        else
            depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    };
    for (const char c : text_) count(c);
    while (depth > 0) {
        const int c = file_.next();
        if (c == -1) fail("has no end. The file was cut off");
        if (text_.size() == longest_row) fail("is longer than 64 KiB");
        text_.push_back(static_cast<char>(c));
        count(text_.back());
    }
}

template <class T>
bool JsonRows::next(T* numbers) {
    if (!find_row()) return false;
    RowOfJson<T> row(columns_, numbers);
    const bool whole = nlohmann::json::sax_parse(text_, &row);
    if (!whole) fail(row.wrong.empty() ? "is no row of numbers" : row.wrong);
    const std::size_t found = row.found;
    if (found < columns_.required() || found > columns_.size() ||
        (row.is_array && found > columns_.required() && found < columns_.size())) {
        const auto fail_here = [&] {
            fail("has " + std::to_string(found) + " of the " + std::to_string(columns_.required()) +
                 (columns_.defaults.empty() ? "" : " or " + std::to_string(columns_.size())) + " numbers " +
                 columns_.names.front() + ", ..., " + columns_.names.back());
        };
        if (row_ == 0) fail_for_columns(fail_here);
        fail_here();
    }
    ++row_;
    return true;
}
template bool JsonRows::next(float*);
template bool JsonRows::next(double*);

}  // namespace hedgerow::detail
