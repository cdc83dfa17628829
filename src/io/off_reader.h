/// Reads the lines of OFF files (Geomview's text form): places and faces here, what follows them on their
/// lines by a class of looks.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_parts.h"
#include "text.h"

namespace hedgerow::detail {

/// Looks of a mesh that has none. It shows what a class of looks needs.
struct NoOffLooks {
    /// The letters before "OFF": "ST", "C" and "N" for texture coordinates, colours and normals of vertices.
    void begin(std::string_view) {}
    /// The rest of a vertex's line, after its coordinates.
    void vertex(std::string_view, const ByteSource&) {}
    /// The rest of the line of a face with so many corners. Returns further ordinals of these, as a FaceList
    /// wants them.
    std::span<const std::vector<std::uint32_t>> face(std::string_view, std::size_t) { return {}; }
};

template <class T, class Looks>
class OffReader {
public:
    OffReader(ByteSource& file, Looks& looks) : file_(file), looks_(looks) {}

    TriangleMesh<T> read() {
        read_keyword();
        const std::uint64_t vertices = count("vertices"), faces = count("faces");
        check_declared(file_, vertices, 6, sizeof(Vec<T, 3>), "vertices");  // "0 0 0" and the line's end
        check_declared(file_, faces, 2, sizeof(TriangleIndices), "faces");
        for (std::uint64_t i = 0; i < vertices; ++i) read_vertex(i, vertices);
        for (std::uint64_t i = 0; i < faces; ++i) read_face(i, faces);
        faces_.move_to(mesh_);
        return std::move(mesh_);
    }
    /// The lists of further ordinals, once the mesh is read.
    std::vector<TriangleIndices> take_others(std::size_t list) { return faces_.take_others(list); }

private:
    /// The keyword may be missing: the file then begins with the counts.
    void read_keyword() {
        need_line("header line", 1, 2);
        std::string_view first = rest_;
        const std::string_view keyword = take_word(first);
        if (lower_case(keyword).ends_with("off")) {
            if (keyword.find_first_of("4n") != keyword.npos)
                fail(shown(keyword) + ": only points in three dimensions are read. Write the file as OFF");
            rest_ = first;
            if (trimmed(rest_) == "BINARY") fail("binary OFF is not read. Write the file as text");
            looks_.begin(keyword.substr(0, keyword.size() - 3));
        } else if (!parse_integer<std::uint64_t>(keyword)) {
            fail("does not begin with 'OFF'. Check the extension");
        }
    }
    /// Reads the next line that has more than a comment. The message for a file that ends before it names
    /// line `i` of `all`.
    void need_line(const char* what, std::uint64_t i, std::uint64_t all) {
        do {
            if (!file_.line(text_))
                file_.fail(std::string("the file ends in ") + what + " " + std::to_string(i) + " of " +
                           std::to_string(all) + ". It was cut off, or a count is wrong: fetch it again");
            ++line_;
            rest_ = trimmed(std::string_view(text_).substr(0, text_.find('#')));
        } while (rest_.empty());
    }
    std::uint64_t count(const char* what) {
        if (trimmed(rest_).empty()) need_line("header line", 2, 2);
        const std::string_view word = take_word(rest_);
        const auto n = parse_integer<std::uint64_t>(word);
        if (!n) fail(shown(word) + " where the number of " + what + " should stand. Repair the file");
        return *n;
    }
    void read_vertex(std::uint64_t i, std::uint64_t all) {
        need_line("vertex", i, all);
        Vec<T, 3> p;
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = take_word(rest_);
            const auto x = parse_real<T>(word);
            if (!x) fail(shown(word) + " where a coordinate should stand. Repair the file");
            p[k] = *x;
        }
        append(file_, mesh_.vertices, p);
        looks_.vertex(rest_, file_);
    }
    void read_face(std::uint64_t i, std::uint64_t all) {
        need_line("face", i, all);
        const std::string_view size = take_word(rest_);
        const auto n = parse_integer<std::uint32_t>(size);
        if (!n) fail(shown(size) + " where a number of corners should stand. Repair the file");
        corners_.clear();
        for (std::uint32_t k = 0; k < *n; ++k) {
            const std::string_view word = take_word(rest_);
            const auto v = parse_integer<std::uint32_t>(word);
            if (!v)
                fail(shown(word) + " where a vertex of face " + std::to_string(i) +
                     " should stand. Repair it");
            append(file_, corners_, *v);
        }
        faces_.add(corners_, looks_.face(rest_, corners_.size()));
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(line_) + ": " + what);
    }

    ByteSource& file_;
    Looks& looks_;
    std::string text_;
    std::string_view rest_;
    std::uint64_t line_ = 0;
    TriangleMesh<T> mesh_;
    FaceList faces_{file_};
    std::vector<std::uint32_t> corners_;
};

}  // namespace hedgerow::detail
