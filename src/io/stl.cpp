/// STL meshes: ascii and binary, corners joined where they are equal.
#include <algorithm>

#include "mesh_parts.h"
#include "readers.h"
#include "word_source.h"

namespace hedgerow::detail {

namespace {

/// Whether a file is text. Binary files may begin with "solid" too. A file is text if "facet" or "endsolid"
/// comes after that line, or if its first 512 bytes are all text.
bool is_ascii(std::string_view start) {
    if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
    std::string_view rest = start;
    if (lower_case(take_word(rest)) != "solid") return false;
    rest.remove_prefix(std::min(rest.find('\n'), rest.size()));
    const std::string word = lower_case(take_word(rest));
    if (word == "facet" || word == "endsolid") return true;
    const std::string_view sample = start.substr(0, 512);
    return std::all_of(sample.begin(), sample.end(), [](char c) {
        const auto u = static_cast<unsigned char>(c);
        return u >= 32 || is_space(u);
    });
}

template <class T>
class StlReader {
public:
    explicit StlReader(ByteSource& file) : file_(file) {}

    TriangleMesh<T> read() {
        if (is_ascii(file_.ahead()))
            read_text();
        else
            read_binary();
        TriangleMesh<T> mesh;
        mesh.vertices = welder_.take();
        faces_.move_to(mesh);
        return mesh;
    }

private:
    /// This many triangles of zeros in a row are not a mesh but a hole in the file: a download that was cut
    /// off.
    static constexpr std::uint32_t most_zeros = 65536;

    void read_binary() {
        // Read the header: 80 bytes that are skipped, then the number of triangles.
        std::uint32_t count = 0;
        if (!file_.skip(80) || !file_.value(count, std::endian::little))
            file_.fail("is too short for an STL file, which has a header of 84 bytes. Fetch it again");
        check_declared(file_, count, 50, sizeof(TriangleIndices), "triangles");
        std::uint32_t zeros = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            float numbers[12];  // the normal, then three corners
            for (float& x : numbers)
                if (!file_.value(x, std::endian::little)) fail_truncated(i, count);
            if (!file_.skip(2)) fail_truncated(i, count);
            // Refuse a long run of zeros.
            zeros = std::all_of(numbers, numbers + 12, [](float x) { return x == 0; }) ? zeros + 1 : 0;
            if (zeros == most_zeros)
                file_.fail_here("the " + std::to_string(zeros) +
                                " triangles before are all zeros: that part " +
                                "of the file was never written. Fetch it again");
            for (int c = 3; c < 12; c += 3)
                add_corner(Vec<T, 3>(Vec3f(numbers[c], numbers[c + 1], numbers[c + 2])));
            close_face();
        }
        // Refuse more triangles than the header declares.
        if (file_.skip(50))
            file_.fail("its header promises " + std::to_string(count) +
                       " triangles, but there are more. The header is wrong: write the file again");
    }
    [[noreturn]] void fail_truncated(std::uint32_t at, std::uint32_t count) const {
        file_.fail_here("the file ends in triangle " + std::to_string(at) + " of the " +
                        std::to_string(count) +
                        " that its header promises. It was cut off, or is not STL: fetch it again");
    }

    void read_text() {
        WordSource words(file_);
        bool closed = true;
        for (std::string w = lower_case(words.next()); !w.empty(); w = lower_case(words.next())) {
            if (w.ends_with("solid")) {  // also "endsolid", and a first word with a byte order mark
                closed = w == "endsolid";
                words.skip_line();
            } else if (w == "facet") {
                read_facet(words);
            } else {
                words.fail(shown(w) + " where 'facet' or 'endsolid' should stand. Repair the file");
            }
        }
        if (!closed) words.fail("the file ends before 'endsolid'. It was cut off: fetch it again");
    }
    void read_facet(WordSource& words) {
        expect(words, "normal");
        for (int i = 0; i < 3; ++i) words.next();
        expect(words, "outer");
        expect(words, "loop");
        std::string w = lower_case(words.next());
        for (; w == "vertex"; w = lower_case(words.next())) {
            Vec<T, 3> p;
            for (int i = 0; i < 3; ++i) {
                const std::string_view number = words.next();
                const auto x = parse_real<T>(number);
                if (!x) words.fail(shown(number) + " where a coordinate should stand. Repair the file");
                p[i] = *x;
            }
            add_corner(p);
        }
        if (w != "endloop") fail_expected(words, w, "endloop");
        expect(words, "endfacet");
        close_face();
    }
    static void expect(WordSource& words, std::string_view wanted) {
        const std::string_view w = words.next();
        if (lower_case(w) != wanted) fail_expected(words, w, wanted);
    }
    [[noreturn]] static void fail_expected(const WordSource& words, std::string_view w,
                                           std::string_view wanted) {
        if (w.empty()) words.fail("the file ends in a facet. It was cut off: fetch it again");
        words.fail(shown(w) + " where " + shown(wanted) + " should stand. Repair the file");
    }

    void add_corner(const Vec<T, 3>& p) {
        check_room(file_, welder_.size(), "vertices");
        append(file_, corners_, welder_.vertex(p));
    }
    void close_face() {
        check_room(file_, faces_.face_count(), "faces");
        faces_.add(corners_);
        corners_.clear();
    }

    ByteSource& file_;
    Welder<T> welder_{file_};
    FaceList faces_{file_};
    std::vector<std::uint32_t> corners_;
};

}  // namespace

template <class T>
TriangleMesh<T> read_stl(ByteSource& file) {
    return StlReader<T>(file).read();
}

template TriangleMesh<float> read_stl(ByteSource&);
template TriangleMesh<double> read_stl(ByteSource&);

}  // namespace hedgerow::detail
