/// Styles of texts: ends of lines, comments, blanks, joined lines and other words than the plainest text has.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include <hedgerow/geometry/vec.h>
#include <hedgerow/scenes/random.h>

namespace hedgerow::hunter {

/// How a text departs from the plainest one. A trait is 0 where it does not.
enum Trait : std::size_t {
    ends,      // of lines: \r\n, \r
    last_end,  // missing
    mark,      // a byte order mark
    blanks,    // tabs, several, and around words
    gaps,      // empty lines
    comments,  // lines of comments
    notes,     // comments behind statements
    joins,     // a statement over several lines, or several on one
    names,     // statements that are no geometry
    order,     // of elements
    words,     // other words for the same
    digits,    // other digits for the same number
    locale,    // the program's: a comma is the decimal point
    traits
};
using Style = std::array<std::uint64_t, traits>;

inline std::string digits_of(double x) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

/// Writes the lines of a text in a style.
class Text {
public:
    explicit Text(const Style& style) : style_(style) {}

    bool has(Trait trait) const { return style_[trait] != 0; }
    /// A number below `most` for the next place in the text; 0 where the style lacks the trait.
    std::uint64_t choice(Trait trait, std::uint64_t most) {
        ++places_;
        return has(trait) ? scattered(scattered(style_[trait]) + places_) % most : 0;
    }
    std::string number(double x) {
        const std::string text = digits_of(x);
        const bool is_whole = text.find_first_of(".e") == text.npos, has_power = text.find('e') != text.npos;
        const std::string others[] = {text, text[0] == '-' ? text : "+" + text,
                                      is_whole ? text + ".00" : text, has_power ? text : text + "e0",
                                      has_power ? text : text + "E+00"};
        return others[choice(digits, 5)];
    }
    std::string blank() { return std::array{" ", "  ", "\t", " \t "}[choice(blanks, 4)]; }
    std::string margin() { return std::array{"", " ", "\t", "  "}[choice(blanks, 4)]; }
    std::string row(const std::vector<std::string>& all, const std::string& separator = "") {
        std::string line = margin();
        for (std::size_t i = 0; i < all.size(); ++i)
            line += (i == 0 ? "" : separator.empty() ? blank() : margin() + separator + margin()) + all[i];
        return line + margin();
    }
    /// What may stand between statements: empty lines, and comments that begin with these letters.
    void between(const std::string& comment) {
        if (choice(gaps, 4) == 1) line(margin());
        static constexpr const char* remarks[] = {" C:\\models\\", " v 0 0 0", "\\", " 1 2 3",
                                                  " caf\xC3\xA9"};
        if (!comment.empty() && choice(comments, 4) == 1)
            line(comment + remarks[choice(comments, std::size(remarks))]);
    }
    /// What may follow a statement on its line.
    std::string note(const std::string& comment) {
        return std::array<std::string, 4>{"", "", " " + comment + " note",
                                          " " + comment + "\\"}[choice(notes, 4)];
    }
    void line(const std::string& text) { lines_.push_back(text); }
    std::string written() const {
        const std::string end = std::array{"\n", "\r\n", "\r"}[style_[ends] % 3];
        std::string text = has(mark) ? "\xEF\xBB\xBF" : "";
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            for (const char letter : lines_[i]) text += letter == '\n' ? end : std::string(1, letter);
            if (i + 1 < lines_.size() || !has(last_end)) text += end;
        }
        return text;
    }

private:
    const Style& style_;
    std::uint64_t places_ = 0;
    std::vector<std::string> lines_;
};

inline std::vector<std::string> numbers_of(Text& text, const Vec3d& p) {
    return {text.number(p[0]), text.number(p[1]), text.number(p[2])};
}

}  // namespace hedgerow::hunter
