#include "text_source.h"

namespace hedgerow::detail {

namespace {
constexpr std::size_t longest_line = std::size_t(1) << 26, longest_word = 4096;

bool ends_line(int c) {
    return c == '\n' || c == '\r';
}
}  // namespace

void open_text(ByteSource& file) {
    if (file.offset() != 0) return;
    const std::string_view start = file.ahead();
    if (start.starts_with("\xFF\xFE") || start.starts_with("\xFE\xFF"))
        file.fail("is text in UTF-16. Save it in UTF-8");
    // A pipe may bring the bytes of the mark one by one.
    for (const char c : byte_order_mark)
        if (file.peek() == static_cast<unsigned char>(c)) file.next();
}

bool LineSource::next(std::string& text) {
    text.clear();
    if (file_.at_end()) return false;
    ++number_;
    int c = file_.next();
    for (; c != -1 && !ends_line(c); c = file_.next()) {
        text.push_back(static_cast<char>(c));
        if (text.size() > longest_line)
            file_.fail_here(
                "a line is longer than 64 MiB. Is this a text file of the kind its extension says?");
    }
    if (!ends_in_returns_) ends_in_returns_ = c == '\r' && file_.peek() != '\n';
    if (c == '\r' && !*ends_in_returns_ && file_.peek() == '\n') file_.next();
    return true;
}

std::string_view WordSource::next() {
    skip_space();
    return next_of_line();
}

std::string_view WordSource::next_of_line() {
    word_.clear();
    int c = file_.peek();
    for (; is_space(c) && !ends_line(c); c = file_.peek()) file_.next();
    for (; c != -1 && !is_space(c); c = file_.peek()) {
        if (word_.size() == longest_word) fail("a word of more than 4096 letters. Is this a text file?");
        word_.push_back(static_cast<char>(file_.next()));
    }
    return word_;
}

void WordSource::skip_line() {
    for (int c = file_.peek(); c != -1 && !ends_line(c); c = file_.peek()) file_.next();
}

void WordSource::skip_space() {
    for (int c = file_.peek(); c != -1 && is_space(c); c = file_.peek()) {
        file_.next();
        line_ += c == '\n' || (c == '\r' && file_.peek() != '\n');
    }
}

}  // namespace hedgerow::detail
