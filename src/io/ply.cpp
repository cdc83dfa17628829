/// PLY meshes and points: ascii, little and big endian, any elements and properties.
#include <algorithm>

#include "mesh_parts.h"
#include "ply_header.h"
#include "readers.h"
#include "word_source.h"

namespace hedgerow::detail {

namespace {

/// Reads the values after a header one by one, each as T or as an integer.
template <class T>
class PlyValues {
public:
    PlyValues(ByteSource& file, const PlyHeader& header)
        : file_(file), words_(file, header.lines + 1), encoding_(header.encoding) {}

    /// Sets the element and the ordinal of the entry that error messages name.
    void enter(const PlyElement& element) { element_ = &element; }
    void enter(std::uint64_t ordinal) { ordinal_ = ordinal; }

    ByteSource& file() const { return file_; }
    /// The least bytes that an entry of the element takes in the file. Lists may be empty; a word has at
    /// least one letter and a space after it.
    std::uint64_t least_bytes(const PlyElement& element) const {
        std::uint64_t bytes = 0;
        for (const PlyProperty& p : element.properties)
            bytes += encoding_ == PlyEncoding::ascii ? 2 : size_of(p.count.value_or(p.type));
        return bytes;
    }

    T real(PlyType type) {
        if (encoding_ == PlyEncoding::ascii) {
            const std::string_view w = word();
            if (const auto x = parse_real<T>(w)) return *x;
            fail(shown(w) + " is not a number");
        }
        return decode<T>(type, [](auto x) {
            if constexpr (std::is_same_v<decltype(x), double>)
                return rounded<T>(x);
            else
                return static_cast<T>(x);
        });
    }
    std::int64_t integer(PlyType type) {
        if (encoding_ == PlyEncoding::ascii) {
            const std::string_view w = word();
            if (const auto i = parse_integer<std::int64_t>(w)) return *i;
            fail(shown(w) + " is not a whole number");
        }
        // The header's checks refuse floating-point types. A 64-bit number beyond int64 becomes negative, and
        // callers refuse that.
        return decode<std::int64_t>(type, [](auto x) {
            if constexpr (std::is_floating_point_v<decltype(x)>)
                return std::int64_t(-1);
            else
                return static_cast<std::int64_t>(x);
        });
    }
    void skip(PlyType type, std::uint64_t count) {
        if (encoding_ == PlyEncoding::ascii)
            for (; count > 0; --count) word();
        else if (!file_.skip(count * size_of(type)))
            fail_truncated();
    }
    std::uint64_t list_size(PlyType type) {
        const std::int64_t n = integer(type);
        if (n < 0 || n > 0xFFFFFFFF) fail("a list of " + std::to_string(n) + " values");
        return static_cast<std::uint64_t>(n);
    }
    [[noreturn]] void fail(const std::string& what) {
        const std::string message = what + " (" + place() + "). Repair the file";
        if (encoding_ == PlyEncoding::ascii) words_.fail(message);
        file_.fail_here(message);
    }

private:
    static std::uint64_t size_of(PlyType type) {
        constexpr std::uint64_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
        return sizes[static_cast<int>(type)];
    }
    std::string_view word() {
        const std::string_view w = words_.next();
        if (w.empty()) fail_truncated();
        return w;
    }
    template <class R, class F>
    R decode(PlyType type, F f) {
        switch (type) {
            case PlyType::i1:
                return f(raw<std::int8_t>());
            case PlyType::u1:
                return f(raw<std::uint8_t>());
            case PlyType::i2:
                return f(raw<std::int16_t>());
            case PlyType::u2:
                return f(raw<std::uint16_t>());
            case PlyType::i4:
                return f(raw<std::int32_t>());
            case PlyType::u4:
                return f(raw<std::uint32_t>());
            case PlyType::i8:
                return f(raw<std::int64_t>());
            case PlyType::u8:
                return f(raw<std::uint64_t>());
            case PlyType::f4:
                return f(raw<float>());
            case PlyType::f8:
                break;
        }
        return f(raw<double>());
    }
    template <class U>
    U raw() {
        U v;
        const std::endian order = encoding_ == PlyEncoding::little ? std::endian::little : std::endian::big;
        if (!file_.value(v, order)) fail_truncated();
        return v;
    }
    std::string place() const {
        return "element '" + element_->name + "', number " + std::to_string(ordinal_);
    }
    [[noreturn]] void fail_truncated() {
        file_.fail_here("the file ends in " + place() + " of the " + std::to_string(element_->count) +
                        " that its header promises. It was cut off, or the header is wrong: fetch it again");
    }

    ByteSource& file_;
    WordSource words_;
    PlyEncoding encoding_;
    const PlyElement* element_ = nullptr;
    std::uint64_t ordinal_ = 0;
};

/// Which properties of an element are wanted: their positions in the element, −1 if there is none.
struct Wanted {
    int axis[3] = {-1, -1, -1};
    int corners = -1;

    int axis_of(int property) const {
        return static_cast<int>(std::find(axis, axis + 3, property) - axis);  // 3: none
    }
};

/// Calls take(point, corners) for each entry of the element, in their order. `memory_bytes` is what the
/// wanted properties of an entry take in memory, 0 if none is wanted.
template <class T, class F>
void read_element(PlyValues<T>& values, const PlyElement& element, const Wanted& wanted,
                  std::size_t memory_bytes, F take) {
    values.enter(element);
    if (element.properties.empty()) return;
    // Refuse a count that the file or the memory cannot hold.
    if (memory_bytes > 0)
        check_declared(values.file(), element.count, values.least_bytes(element), memory_bytes,
                       element.name == "face" ? "faces" : "vertices");
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        values.enter(i);
        Vec<T, 3> point;
        // Read the wanted properties of the entry and skip the others.
        for (int k = 0; k < static_cast<int>(element.properties.size()); ++k) {
            const PlyProperty& p = element.properties[static_cast<std::size_t>(k)];
            const std::uint64_t n = p.count ? values.list_size(*p.count) : 1;
            if (k == wanted.corners) {
                corners.clear();
                for (std::uint64_t j = 0; j < n; ++j) {
                    const std::int64_t v = values.integer(p.type);
                    if (v < 0 || v >= static_cast<std::int64_t>(most_ordinals))
                        values.fail("names vertex " + std::to_string(v) + ", which cannot be");
                    append(values.file(), corners, static_cast<std::uint32_t>(v));
                }
            } else if (const int axis = wanted.axis_of(k); axis < 3) {
                point[axis] = values.real(p.type);
            } else {
                values.skip(p.type, n);
            }
        }
        take(point, corners);
    }
}

Wanted coordinates_of(const ByteSource& file, const PlyElement& element) {
    Wanted wanted;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        if (p.name != "x" && p.name != "y" && p.name != "z") continue;
        if (p.count)
            file.fail("the property '" + p.name + "' of the vertices is a list. Write it as a number");
        wanted.axis[p.name[0] - 'x'] = static_cast<int>(k);
    }
    return wanted;
}

void need_axes(const ByteSource& file, const Wanted& wanted, int dimension) {
    for (int a = 0; a < dimension; ++a)
        if (wanted.axis[a] < 0)
            file.fail(std::string("the vertices have no property '") + "xyz"[a] + "'. Write them with it");
}

Wanted corners_of(const ByteSource& file, const PlyElement& element) {
    Wanted wanted;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& p = element.properties[k];
        if (wanted.corners >= 0 || (p.name != "vertex_indices" && p.name != "vertex_index")) continue;
        if (!p.count || p.type >= PlyType::f4)
            file.fail("the property '" + p.name +
                      "' of the faces is not a list of whole numbers. Write it as " +
                      "'property list uchar int vertex_indices'");
        wanted.corners = static_cast<int>(k);
    }
    if (wanted.corners < 0 && element.count > 0)
        file.fail("the faces have no property 'vertex_indices'. Write them with it");
    return wanted;
}

}  // namespace

template <class T>
TriangleMesh<T> read_ply_mesh(ByteSource& file) {
    const PlyHeader header = read_ply_header(file);
    PlyValues<T> values(file, header);
    TriangleMesh<T> mesh;
    FaceList faces(file);
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            const Wanted wanted = coordinates_of(file, element);
            if (element.count > 0) need_axes(file, wanted, 3);
            read_element(values, element, wanted, sizeof(Vec<T, 3>),
                         [&](const Vec<T, 3>& p, const auto&) { append(file, mesh.vertices, p); });
        } else if (element.name == "face") {
            read_element(values, element, corners_of(file, element), sizeof(TriangleIndices),
                         [&](const Vec<T, 3>&, const auto& corners) { faces.add(corners); });
        } else {
            read_element(values, element, Wanted{}, 0, [](const Vec<T, 3>&, const auto&) {});
        }
    }
    faces.move_to(mesh);
    return mesh;
}

template <class T, int D>
PointCloud<T, D> read_ply_points(ByteSource& file) {
    const PlyHeader header = read_ply_header(file);
    PlyValues<T> values(file, header);
    PointCloud<T, D> cloud;
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex") {
            read_element(values, element, Wanted{}, 0, [](const Vec<T, 3>&, const auto&) {});
            continue;
        }
        const Wanted wanted = coordinates_of(file, element);
        // Read the points, and nothing after them.
        if (element.count > 0) need_axes(file, wanted, D);
        read_element(values, element, wanted, sizeof(Vec<T, D>), [&](const Vec<T, 3>& p, const auto&) {
            if constexpr (D == 3) {
                append(file, cloud.points, p);
            } else {
                if (p[2] != 0) values.fail("z is not 0, but the points are read in 2D. Read them in 3D");
                append(file, cloud.points, Vec<T, D>(p[0], p[1]));
            }
        });
        break;
    }
    return cloud;
}

template TriangleMesh<float> read_ply_mesh(ByteSource&);
template TriangleMesh<double> read_ply_mesh(ByteSource&);
template PointCloud<float, 2> read_ply_points(ByteSource&);
template PointCloud<float, 3> read_ply_points(ByteSource&);
template PointCloud<double, 2> read_ply_points(ByteSource&);
template PointCloud<double, 3> read_ply_points(ByteSource&);

}  // namespace hedgerow::detail
