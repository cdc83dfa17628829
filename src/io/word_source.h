/// The words of a text file, with the number of each word's line.
#pragma once

#include "byte_source.h"
#include "text.h"

namespace hedgerow::detail {

class WordSource {
public:
    explicit WordSource(ByteSource& file, std::uint64_t first_line = 1) : file_(file), line_(first_line) {}

    /// The next word, valid until the next call; empty at the end of the file.
    std::string_view next() {
        word_.clear();
        skip_space();
        for (int c = file_.peek(); c != -1 && !is_space(c); c = file_.peek()) {
            if (word_.size() == longest_word) fail("a word of more than 4096 letters. Is this a text file?");
            word_.push_back(static_cast<char>(file_.next()));
        }
        return word_;
    }
    /// Skips the rest of this line.
    void skip_line() {
        for (int c = file_.peek(); c != -1 && c != '\n'; c = file_.peek()) file_.next();
    }
    void skip_space() {
        for (int c = file_.peek(); c != -1 && is_space(c); c = file_.peek()) {
            line_ += c == '\n';
            file_.next();
        }
    }
    ByteSource& file() const { return file_; }
    /// Throws InputError "NAME, line N: WHAT".
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(line_) + ": " + what);
    }

private:
    static constexpr std::size_t longest_word = 4096;

    ByteSource& file_;
    std::uint64_t line_;
    std::string word_;
};

}  // namespace hedgerow::detail
