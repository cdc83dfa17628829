/// Reads the lines of OBJ files: vertices and faces here, all else by a class of looks. This reader replaces
/// tinyobjloader (2.0 rc10), which reads words that are not numbers, "nan" too, as 0 and does not round
/// correctly.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_parts.h"
#include "text_source.h"

namespace hedgerow::detail {

/// A file and the number of the line where the statement begins that is being read.
struct ObjPlace {
    ByteSource& file;
    std::uint64_t line = 0;

    [[noreturn]] void fail(const std::string& what) const {
        file.fail("line " + std::to_string(line) + ": " + what);
    }
};

/// Whether a \ at the end of a statement joins the next line to it. The format joins any statements, but
/// programs end names of objects and files in a \, too, and mean no more by it. So only lists of numbers are
/// joined.
inline bool may_be_joined(std::string_view word) {
    constexpr std::string_view lists[] = {"v",    "vt",   "vn",   "vp",    "f",    "fo",
                                          "l",    "p",    "curv", "curv2", "surf", "parm",
                                          "trim", "hole", "scrv", "sp",    "con",  "bmat"};
    return std::find(std::begin(lists), std::end(lists), word) != std::end(lists);
}

/// Looks of a mesh that has none. It shows what a class of looks needs.
struct NoObjLooks {
    /// The rest of the line of vertex `ordinal`, after its three coordinates.
    void vertex(std::string_view, std::uint64_t, const ObjPlace&) {}
    /// A line that is no vertex and no face.
    void line(std::string_view, std::string_view, const ObjPlace&) {}
    /// A corner of a face: "/", and what follows it, of "vertex/texture/normal". Empty without a slash.
    void corner(std::string_view, const ObjPlace&) {}
    /// The ordinals of the corners since the last face ended, as a FaceList wants them.
    std::span<const std::vector<std::uint32_t>> corners() const { return {}; }
    /// The end of a face. There are so many triangles now.
    void end_face(std::uint64_t) {}
};

template <class T, class Looks>
class ObjReader {
public:
    ObjReader(ByteSource& file, Looks& looks) : lines_(file), place_{file}, looks_(looks) {}

    TriangleMesh<T> read() {
        std::string line;
        while (next(line)) {
            std::string_view rest = line;
            const std::string_view word = take_word(rest);
            if (word == "v")
                read_vertex(rest);
            else if (word == "f" || word == "fo")
                read_face(rest);
            else
                looks_.line(word, rest, place_);
        }
        faces_.move_to(mesh_);
        return std::move(mesh_);
    }
    /// The lists of further ordinals, once the mesh is read.
    std::vector<TriangleIndices> take_others(std::size_t list) { return faces_.take_others(list); }

private:
    /// Reads a statement: a line without its comment, and the lines that a \ at its end joins to it.
    bool next(std::string& statement) {
        if (!lines_.next(statement)) return false;
        place_.line = lines_.number();
        while (ends_in_join(statement)) {
            statement.back() = ' ';
            if (!lines_.next(more_)) break;
            statement += more_;
            if (statement.size() > (std::size_t(1) << 26))
                place_.fail("a line of more than 64 MiB. Is this an OBJ file?");
        }
        return true;
    }
    /// Whether a statement goes on in the next line. Removes what follows its \ or its numbers.
    static bool ends_in_join(std::string& statement) {
        if (statement.find('\\') == statement.npos) return false;
        std::string_view rest = statement;
        if (!may_be_joined(take_word(rest))) return false;
        statement.resize(std::min(statement.find('#'), statement.size()));
        while (!statement.empty() && is_space(static_cast<unsigned char>(statement.back())))
            statement.pop_back();
        return statement.ends_with('\\');
    }
    void read_vertex(std::string_view rest) {
        check_room(place_.file, mesh_.vertices.size(), "vertices");
        Vec<T, 3> p;
        for (int i = 0; i < 3; ++i) {
            const std::string_view number = take_word(rest);
            if (number.empty()) place_.fail("a vertex with fewer than 3 coordinates. Was the file cut off?");
            const auto x = parse_coordinate<T>(number, place_.file.rounding());
            if (!x) place_.fail(shown(number) + " where a coordinate should stand. Repair the file");
            p[i] = *x;
        }
        looks_.vertex(rest, mesh_.vertices.size(), place_);
        append(place_.file, mesh_.vertices, p);
    }
    void read_face(std::string_view rest) {
        check_room(place_.file, faces_.face_count(), "faces");
        corners_.clear();
        for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#';
             word = take_word(rest)) {
            const auto slash = std::min(word.find('/'), word.size());
            const auto index = parse_integer<std::int64_t>(word.substr(0, slash));
            if (!index || *index == 0)
                place_.fail("the face names vertex " + shown(word) +
                            ". Indices are whole numbers and begin at 1");
            const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
            const std::int64_t v = *index > 0 ? *index - 1 : count + *index;
            if (v < 0 || v >= static_cast<std::int64_t>(most_ordinals))
                place_.fail("the face names vertex " + std::to_string(*index) + ", but there are only " +
                            std::to_string(count) + " so far. Repair the file");
            append(place_.file, corners_, static_cast<std::uint32_t>(v));
            looks_.corner(word.substr(slash), place_);
        }
        faces_.add(corners_, looks_.corners());
        looks_.end_face(faces_.triangle_count());
    }

    LineSource lines_;
    ObjPlace place_;
    Looks& looks_;
    std::string more_;
    TriangleMesh<T> mesh_;
    FaceList faces_{place_.file};
    std::vector<std::uint32_t> corners_;
};

}  // namespace hedgerow::detail
