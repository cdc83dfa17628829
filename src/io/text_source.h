/// Opens the text of files, and reads it line by line or word by word.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "byte_source.h"
#include "text.h"

namespace hedgerow::detail {

/// The byte order mark of UTF-8, with which some editors begin a text.
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

inline std::string_view without_mark(std::string_view text) {
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    return text;
}

/// Skips the byte order mark at the beginning of a file. Does nothing further on in it. Throws InputError for
/// text in UTF-16. Whatever reads a text calls this first.
void open_text(ByteSource& file);

/// The lines of a text file, with their numbers.
class LineSource {
public:
    explicit LineSource(ByteSource& file) : file_(file) { open_text(file); }

    /// The next line without its end; false at the end of the file. A line ends in \n, \r\n or \r. Where the
    /// first line of a file ends in \r alone, \r is the end of every line.
    bool next(std::string& text);
    /// The number of the last line, from 1 on.
    std::uint64_t number() const { return number_; }
    ByteSource& file() const { return file_; }
    /// Throws InputError "NAME, line N: WHAT".
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(number_) + ": " + what);
    }

private:
    ByteSource& file_;
    std::uint64_t number_ = 0;
    std::optional<bool> ends_in_returns_;  // what the first line says
};

/// The words of a text file, with the number of each word's line.
class WordSource {
public:
    explicit WordSource(ByteSource& file, std::uint64_t first_line = 1) : file_(file), line_(first_line) {
        open_text(file);
    }

    /// The next word, valid until the next call; empty at the end of the file.
    std::string_view next();
    /// The next word of this line; empty if the line has no more.
    std::string_view next_of_line();
    /// Skips the rest of this line.
    void skip_line();
    std::uint64_t line() const { return line_; }
    ByteSource& file() const { return file_; }
    /// Throws InputError "NAME, line N: WHAT".
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(line_) + ": " + what);
    }

private:
    void skip_space();

    ByteSource& file_;
    std::uint64_t line_;
    std::string word_;
};

}  // namespace hedgerow::detail
