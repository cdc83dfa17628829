/// A file of the corpus, and the ways in which systems write a text.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hedgerow/geometry/vec.h>

namespace hedgerow::testing_corpus {

using ThreeCorners = std::array<Vec3d, 3>;

/// A file, and its triangles by their corners, or its points. The base colour is that of the first material.
struct CorpusFile {
    std::string name, bytes;
    std::vector<ThreeCorners> triangles;
    std::vector<Vec3d> points = {};
    std::optional<Vec3f> colour = {};
    /// Files beside it, by name and contents.
    std::vector<std::pair<std::string, std::string>> beside = {};
};

inline const Vec3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0.5);
inline const std::vector<ThreeCorners> one{{a, b, c}}, two{{a, b, c}, {c, b, d}},
    square{{a, b, d}, {a, d, c}};

/// What editors and systems make of the same text: the ends of lines, and a byte order mark.
inline std::vector<std::pair<std::string, std::string>> as_systems_write(const std::string& text) {
    std::vector<std::pair<std::string, std::string>> all;
    for (const std::string mark : {"", "\xEF\xBB\xBF"})
        for (const std::string end : {"\n", "\r\n", "\r"})
            for (const bool has_last_end : {true, false}) {
                std::string written = mark;
                for (const char letter : text) written += letter == '\n' ? end : std::string(1, letter);
                if (!has_last_end) written.resize(written.size() - end.size());
                all.emplace_back((mark.empty() ? "" : "mark ") +
                                     std::string(end == "\n"   ? "LF"
                                                 : end == "\r" ? "CR"
                                                               : "CRLF") +
                                     (has_last_end ? "" : " without the last"),
                                 written);
            }
    return all;
}

/// Adds a text in all the ways in which systems write it.
inline void add_text(std::vector<CorpusFile>& all, const CorpusFile& file) {
    for (const auto& [how, text] : as_systems_write(file.bytes)) {
        all.push_back(file);
        all.back().bytes = text;
    }
}

}  // namespace hedgerow::testing_corpus
