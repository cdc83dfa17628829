/// Reads OFF files (Geomview's text and binary forms): places and faces here, what follows them by a class of
/// looks.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_parts.h"
#include "text_source.h"

namespace hedgerow::detail {

/// Looks of a mesh that has none. It shows what a class of looks needs.
struct NoOffLooks {
    /// Begins, or begins anew. The letters are those before "OFF": "ST", "C" and "N" for texture coordinates,
    /// colours and normals of vertices.
    void begin(std::string_view) {}
    /// The numbers of a vertex after its coordinates.
    void vertex(std::string_view, const ByteSource&) {}
    /// The numbers of a face after its corners, of which there are so many. Returns further ordinals of
    /// these, as a FaceList wants them.
    std::span<const std::vector<std::uint32_t>> face(std::string_view, std::size_t) { return {}; }
};

template <class T, class Looks>
class OffReader {
public:
    OffReader(ByteSource& file, Looks& looks) : file_(file), looks_(looks) {}

    /// Reads word by word, as the format wants. Some programs write further numbers behind a vertex that the
    /// keyword does not announce, so where that fails, or leaves something behind the last face, reads a
    /// vertex a line.
    TriangleMesh<T> read() {
        for (const bool by_lines : {false, true}) {
            try {
                TriangleMesh<T> mesh = read_as(by_lines);
                if (!has_more()) return mesh;
            } catch (const InputError&) {
            }
            file_.rewind();
        }
        TriangleMesh<T> mesh = read_as(true);
        file_.warn("something follows the faces that its header counts. It is not read");
        return mesh;
    }
    /// The lists of further ordinals, once the mesh is read.
    std::vector<TriangleIndices> take_others(std::size_t list) { return faces_->take_others(list); }

private:
    /// What is being read: for a message about a file that ends before it.
    struct Entry {
        const char* what = "header line";
        std::uint64_t number = 0, all = 0;
    };

    TriangleMesh<T> read_as(bool by_lines) {
        lines_.emplace(file_);
        is_pending_ = false;
        faces_.emplace(file_);
        mesh_ = {};
        entry_ = {"header line", 1, 2};
        read_keyword();
        if (is_binary_)
            read_binary();
        else
            read_text(by_lines);
        faces_->move_to(mesh_);
        return std::move(mesh_);
    }
    /// The keyword may be missing: the file then begins with the counts.
    void read_keyword() {
        need_line();
        is_binary_ = false, numbers_behind_ = 0;
        std::string_view first = rest_;
        const std::string_view keyword = take_word(first);
        const std::string lower = lower_case(keyword);
        if (!lower.ends_with("off")) {
            if (!parse_integer<std::uint64_t>(keyword))
                lines_->fail("does not begin with 'OFF'. Check the extension");
            return looks_.begin({});
        }
        const std::string letters = lower.substr(0, lower.size() - 3);
        if (keyword.find_first_of("4n") != keyword.npos)
            lines_->fail(shown(keyword) +
                         ": only points in three dimensions are read. Write the file as OFF");
        rest_ = first;
        is_binary_ = lower_case(trimmed(rest_)) == "binary";
        const auto has = [&](std::string_view l) { return letters.find(l) != letters.npos; };
        numbers_behind_ = 3 * has("n") + 4 * has("c") + 2 * letters.starts_with("st");
        looks_.begin(letters);
    }
    /// Throws InputError for counts that the file cannot hold.
    void expect_room(std::uint64_t vertices, std::uint64_t faces, std::uint64_t vertex_bytes,
                     std::uint64_t face_bytes) const {
        check_declared(file_, vertices, vertex_bytes, sizeof(Vec<T, 3>), "vertices");
        check_declared(file_, faces, face_bytes, sizeof(TriangleIndices), "faces");
    }
    [[noreturn]] void fail_cut() const {
        const std::string what = std::string("the file ends in ") + entry_.what + " " +
                                 std::to_string(entry_.number) + " of " + std::to_string(entry_.all) +
                                 ". It was cut off, or a count is wrong: fetch it again";
        if (is_binary_) file_.fail_here(what);
        lines_->fail(what);
    }
    bool has_more() {
        if (is_binary_) return !file_.at_end();
        return next_line();
    }

    // ---- Text ----

    void read_text(bool by_lines) {
        entry_ = {"header line", 2, 2};
        const auto vertices = number<std::uint64_t>("the number of vertices");
        const auto faces = number<std::uint64_t>("the number of faces");
        expect_room(vertices, faces, 6, 2);  // "0 0 0" and the line's end
        skip_edges();
        for (std::uint64_t i = 0; i < vertices; ++i) {
            entry_ = {"vertex", i, vertices};
            read_vertex(by_lines);
        }
        if (!by_lines && !trimmed(rest_).empty()) lines_->fail("goes on after the last vertex");
        for (std::uint64_t i = 0; i < faces; ++i) {
            entry_ = {"face", i, faces};
            read_face();
        }
    }
    /// The number of edges ends the line or has one of its own. Some programs leave it out.
    void skip_edges() {
        const bool ends_line = !trimmed(rest_).empty();
        rest_ = {};
        if (ends_line || !next_line()) return;
        std::string_view after = rest_;
        const bool is_edges = parse_integer<std::uint64_t>(take_word(after)) && after.empty();
        is_pending_ = !is_edges;
        rest_ = {};
    }
    /// Reads the next line that has more than a comment; false at the end of the file.
    bool next_line() {
        if (std::exchange(is_pending_, false)) {
            rest_ = trimmed(std::string_view(text_).substr(0, text_.find('#')));
            return true;
        }
        do {
            if (!lines_->next(text_)) return false;
            rest_ = trimmed(std::string_view(text_).substr(0, text_.find('#')));
        } while (rest_.empty());
        return true;
    }
    void need_line() {
        if (!next_line()) fail_cut();
    }
    /// The next word of this line or of a further one.
    std::string_view word() {
        if (rest_ = trimmed(rest_); rest_.empty()) need_line();
        return take_word(rest_);
    }
    template <class I>
    I number(const char* what) {
        const std::string_view w = word();
        const auto n = parse_integer<I>(w);
        if (!n) lines_->fail(shown(w) + " where " + what + " should stand. Repair the file");
        return *n;
    }
    void read_vertex(bool by_lines) {
        if (by_lines) need_line();
        Vec<T, 3> p;
        for (int k = 0; k < 3; ++k) {
            const std::string_view w = by_lines ? take_word(rest_) : word();
            const auto x = parse_coordinate<T>(w, file_.rounding());
            if (!x) lines_->fail(shown(w) + " where a coordinate should stand. Repair the file");
            p[k] = *x;
        }
        append(file_, mesh_.vertices, p);
        if (by_lines) return looks_.vertex(rest_, file_);
        behind_.clear();
        for (int k = 0; k < numbers_behind_; ++k) (behind_ += word()) += ' ';
        looks_.vertex(behind_, file_);
    }
    /// A face begins a line, whose rest behind the corners is the face's colour.
    void read_face() {
        need_line();
        const auto n = number<std::uint32_t>("a number of corners");
        corners_.clear();
        for (std::uint32_t k = 0; k < n; ++k)
            append(file_, corners_, number<std::uint32_t>("a vertex of a face"));
        faces_->add(corners_, looks_.face(rest_, corners_.size()));
    }

    // ---- Binary: integers and floats of 4 bytes, the largest first ----

    void read_binary() {
        const auto vertices = binary<std::uint32_t>(), faces = binary<std::uint32_t>();
        binary<std::uint32_t>();  // the number of edges
        expect_room(vertices, faces, 12, 8);
        for (std::uint32_t i = 0; i < vertices; ++i) {
            entry_ = {"vertex", i, vertices};
            Vec<T, 3> p;
            for (int k = 0; k < 3; ++k) p[k] = static_cast<T>(binary<float>());
            append(file_, mesh_.vertices, p);
            looks_.vertex(floats(static_cast<std::uint32_t>(numbers_behind_)), file_);
        }
        for (std::uint32_t i = 0; i < faces; ++i) {
            entry_ = {"face", i, faces};
            corners_.clear();
            for (auto n = binary<std::uint32_t>(); n > 0; --n)
                append(file_, corners_, binary<std::uint32_t>());
            const auto colours = binary<std::uint32_t>();
            faces_->add(corners_, looks_.face(floats(colours), corners_.size()));
        }
    }
    template <class U>
    U binary() {
        U value;
        if (!file_.value(value, std::endian::big)) fail_cut();
        return value;
    }
    /// So many floats as text, the form in which looks are read: with a point, for whole numbers are others
    /// in colours.
    std::string_view floats(std::uint32_t count) {
        behind_.clear();
        for (; count > 0; --count) {
            const float x = binary<float>();
            if (behind_.size() >= most_behind) continue;
            const std::size_t at = behind_.size();
            append_number(behind_, x);
            behind_ += behind_.find_first_of(".en", at) == std::string::npos ? ".0 " : " ";
        }
        return behind_;
    }

    static constexpr std::size_t most_behind = 1024;

    ByteSource& file_;
    Looks& looks_;
    std::optional<LineSource> lines_;
    std::string text_, behind_;
    std::string_view rest_;
    Entry entry_;
    bool is_pending_ = false;  // the line was read, and its words were not
    bool is_binary_ = false;
    int numbers_behind_ = 0;  // of a vertex, by the keyword
    TriangleMesh<T> mesh_;
    std::optional<FaceList> faces_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace hedgerow::detail
