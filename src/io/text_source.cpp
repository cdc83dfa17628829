#include "text_source.h"

namespace hedgerow::detail {

namespace {
constexpr std::size_t longest_line = std::size_t(1) << 26, longest_word = 4096;

bool ends_line(int c) {
    return c == '\n' || c == '\r';
}

/// Appends what comes before a letter that `ends`, or before the end of the file. Stops somewhere beyond
/// `most` letters.
template <class Ends>
void append_until(ByteSource& file, std::string& text, std::size_t most, Ends ends) {
    while (text.size() <= most && !file.at_end()) {
        const std::string_view ahead = file.ahead();
        std::size_t length = 0;
        while (length < ahead.size() && !ends(static_cast<unsigned char>(ahead[length]))) ++length;
        text.append(ahead.substr(0, length));
        file.skip(length);
        if (length < ahead.size()) return;
    }
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
    append_until(file_, text, longest_line, ends_line);
    if (text.size() > longest_line)
        file_.fail_here("a line is longer than 64 MiB. Is this a text file of the kind its extension says?");
    const int c = file_.next();
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
    for (int c = file_.peek(); is_space(c) && !ends_line(c); c = file_.peek()) file_.next();
    append_until(file_, word_, longest_word, is_space);
    if (word_.size() > longest_word) fail("a word of more than 4096 letters. Is this a text file?");
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
