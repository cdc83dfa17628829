/// Wavefront OBJ meshes. This reader replaces tinyobjloader (2.0 rc10), which reads words that are not
/// numbers, "nan" too, as 0 and does not round correctly.
#include "mesh_parts.h"
#include "readers.h"
#include "text.h"

namespace hedgerow::detail {

namespace {

template <class T>
class ObjReader {
public:
    explicit ObjReader(ByteSource& file) : file_(file) {}

    TriangleMesh<T> read() {
        std::string line;
        while (next(line)) {
            std::string_view rest = line;
            const std::string_view word = take_word(rest);
            if (word == "v")
                read_vertex(rest);
            else if (word == "f" || word == "fo")
                read_face(rest);
        }
        faces_.move_to(mesh_);
        return std::move(mesh_);
    }

private:
    /// Reads a line and the lines that a \ at its end joins to it.
    bool next(std::string& line) {
        if (!file_.line(line)) return false;
        line_ += 1 + joined_;
        joined_ = 0;
        while (line.ends_with('\\')) {
            line.back() = ' ';
            if (!file_.line(more_)) break;
            line += more_;
            ++joined_;
            if (line.size() > (std::size_t(1) << 26))
                fail("a line of more than 64 MiB. Is this an OBJ file?");
        }
        return true;
    }
    void read_vertex(std::string_view rest) {
        check_room(file_, mesh_.vertices.size(), "vertices");
        Vec<T, 3> p;
        for (int i = 0; i < 3; ++i) {
            const std::string_view number = take_word(rest);
            if (number.empty()) fail("a vertex with fewer than 3 coordinates. Was the file cut off?");
            const auto x = parse_real<T>(number);
            if (!x) fail(shown(number) + " where a coordinate should stand. Repair the file");
            p[i] = *x;
        }
        append(file_, mesh_.vertices, p);
    }
    void read_face(std::string_view rest) {
        check_room(file_, faces_.face_count(), "faces");
        corners_.clear();
        for (std::string_view word = take_word(rest); !word.empty() && word[0] != '#';
             word = take_word(rest)) {
            const auto index = parse_integer<std::int64_t>(word.substr(0, word.find('/')));
            if (!index || *index == 0)
                fail("the face names vertex " + shown(word) + ". Indices are whole numbers and begin at 1");
            const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
            const std::int64_t v = *index > 0 ? *index - 1 : count + *index;
            if (v < 0 || v >= static_cast<std::int64_t>(most_ordinals))
                fail("the face names vertex " + std::to_string(*index) + ", but there are only " +
                     std::to_string(count) + " so far. Repair the file");
            append(file_, corners_, static_cast<std::uint32_t>(v));
        }
        faces_.add(corners_);
    }
    [[noreturn]] void fail(const std::string& what) const {
        file_.fail("line " + std::to_string(line_) + ": " + what);
    }

    ByteSource& file_;
    std::uint64_t line_ = 0, joined_ = 0;
    std::string more_;
    TriangleMesh<T> mesh_;
    FaceList faces_{file_};
    std::vector<std::uint32_t> corners_;
};

}  // namespace

template <class T>
TriangleMesh<T> read_obj(ByteSource& file) {
    return ObjReader<T>(file).read();
}

template TriangleMesh<float> read_obj(ByteSource&);
template TriangleMesh<double> read_obj(ByteSource&);

}  // namespace hedgerow::detail
