/// The facets of an STL file, ascii or binary, one after the other.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_parts.h"
#include "text_source.h"

namespace hedgerow::detail {

template <class T>
class StlFacets {
public:
    explicit StlFacets(ByteSource& file) : file_(file) {
        if (is_ascii(file_.ahead()))
            words_.emplace(file_);
        else
            read_header();
    }
    /// Replaces `corners` by those of the next facet; false at the end of the file.
    bool next(std::vector<Vec<T, 3>>& corners) {
        corners.clear();
        return words_ ? next_of_text(corners) : next_of_binary(corners);
    }

private:
    /// This many triangles of zeros in a row are not a mesh but a hole in the file: a download that was cut
    /// off.
    static constexpr std::uint32_t most_zeros = 65536;

    /// Whether a file is text. Binary files may begin with "solid" too. A file is text if "facet" or
    /// "endsolid" comes after that line, or if its first 512 bytes are all text.
    static bool is_ascii(std::string_view start) {
        start = without_mark(start);
        std::string_view rest = start;
        if (lower_case(take_word(rest)) != "solid") return false;
        rest.remove_prefix(std::min(rest.find_first_of("\r\n"), rest.size()));
        const std::string word = lower_case(take_word(rest));
        if (word == "facet" || word == "endsolid" || word == "end") return true;
        const std::string_view sample = start.substr(0, 512);
        return std::all_of(sample.begin(), sample.end(), [](char c) {
            const auto u = static_cast<unsigned char>(c);
            return u >= 32 || is_space(u);
        });
    }

    // ---- Binary ----

    /// Reads 80 bytes that are skipped, then the number of triangles.
    void read_header() {
        if (!file_.skip(80) || !file_.value(count_, std::endian::little))
            file_.fail("is too short for an STL file, which has a header of 84 bytes. Fetch it again");
        check_declared(file_, count_, 50, sizeof(TriangleIndices), "triangles");
    }
    bool next_of_binary(std::vector<Vec<T, 3>>& corners) {
        if (at_ == count_) {
            expect_end();
            return false;
        }
        float numbers[12];  // the normal, then three corners
        for (float& x : numbers)
            if (!file_.value(x, std::endian::little)) fail_truncated();
        if (!file_.skip(2)) fail_truncated();
        // Refuse a long run of zeros.
        zeros_ = std::all_of(numbers, numbers + 12, [](float x) { return x == 0; }) ? zeros_ + 1 : 0;
        if (zeros_ == most_zeros)
            file_.fail_here("the " + std::to_string(zeros_) + " triangles before are all zeros: that part " +
                            "of the file was never written. Fetch it again");
        for (int c = 3; c < 12; c += 3)
            corners.push_back(Vec<T, 3>(Vec3f(numbers[c], numbers[c + 1], numbers[c + 2])));
        ++at_;
        return true;
    }
    /// Refuses further triangles. Some programs fill a file up with other bytes.
    void expect_end() {
        constexpr std::uint64_t facet = 50;
        std::uint64_t spare = 0;
        for (; !file_.at_end(); spare += file_.ahead().size(), file_.skip(file_.ahead().size())) {
        }
        if (spare == 0) return;
        if (spare % facet == 0)
            file_.fail("its header promises " + std::to_string(count_) +
                       " triangles, but there are more. The header is wrong: write the file again");
        file_.warn(std::to_string(spare) +
                   " bytes follow the triangles that its header counts. They are not "
                   "read");
    }
    [[noreturn]] void fail_truncated() const {
        file_.fail_here("the file ends in triangle " + std::to_string(at_) + " of the " +
                        std::to_string(count_) +
                        " that its header promises. It was cut off, or is not STL: fetch it again");
    }

    // ---- Text ----

    bool next_of_text(std::vector<Vec<T, 3>>& corners) {
        for (std::string w = keyword(); !w.empty(); w = keyword()) {
            if (w == "solid" || w == "endsolid") {
                closed_ = w == "endsolid";
                words_->skip_line();
            } else if (w == "facet") {
                read_facet(corners);
                return true;
            } else {
                words_->fail(shown(w) + " where 'facet' or 'endsolid' should stand. Repair the file");
            }
        }
        if (!closed_) words_->fail("the file ends before 'endsolid'. It was cut off: fetch it again");
        return false;
    }
    void read_facet(std::vector<Vec<T, 3>>& corners) {
        expect("normal");
        for (int i = 0; i < 3; ++i) words_->next();
        skip_words();
        expect("outer");
        expect("loop");
        std::string w = keyword_after_words();
        for (; w == "vertex"; w = keyword_after_words()) {
            Vec<T, 3> p;
            for (int i = 0; i < 3; ++i) {
                const std::string_view number = words_->next();
                const auto x = parse_coordinate<T>(number, file_.rounding());
                if (!x) words_->fail(shown(number) + " where a coordinate should stand. Repair the file");
                p[i] = *x;
            }
            append(file_, corners, p);
        }
        if (w != "endloop") fail_expected(w, "endloop");
        if (w = keyword_after_words(); w != "endfacet") fail_expected(w, "endfacet");
        skip_words();
    }
    /// The next word in lower case; "end solid" counts as one.
    std::string keyword() {
        std::string w = pending_.empty() ? lower_case(words_->next()) : std::exchange(pending_, {});
        if (w == "end") w += lower_case(words_->next_of_line());
        return w;
    }
    std::string keyword_after_words() {
        skip_words();
        return keyword();
    }
    /// Skips the rest of the line up to a keyword.
    void skip_words() {
        constexpr std::string_view keywords[] = {"outer",    "vertex", "end",   "endloop",
                                                 "endfacet", "facet",  "solid", "endsolid"};
        std::string_view word;
        while (pending_.empty() && !(word = words_->next_of_line()).empty()) {
            const std::string w = lower_case(word);
            if (std::find(std::begin(keywords), std::end(keywords), w) != std::end(keywords)) pending_ = w;
        }
    }
    void expect(std::string_view wanted) {
        const std::string w = keyword();
        if (w != wanted) fail_expected(w, wanted);
    }
    [[noreturn]] void fail_expected(std::string_view w, std::string_view wanted) const {
        if (w.empty()) words_->fail("the file ends in a facet. It was cut off: fetch it again");
        words_->fail(shown(w) + " where " + shown(wanted) + " should stand. Repair the file");
    }

    ByteSource& file_;
    std::uint32_t count_ = 0, at_ = 0, zeros_ = 0;  // of a binary file
    std::optional<WordSource> words_;               // of a text
    std::string pending_;                           // a word that was read ahead
    bool closed_ = true;
};

}  // namespace hedgerow::detail
