/// Hunts for texts that mean the same and are read as something else. A mesh or points are written in a
/// style: with other ends of lines, comments, blanks, joined lines, orders and words than the plainest text
/// has. Every style must give the same geometry.
#include <array>
#include <charconv>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>

#include <unistd.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/scene_file.h>
#include <hedgerow/scenes/random.h>

#include "report.h"
#include "shrink.h"

namespace hedgerow::hunter {

namespace {

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

/// What a file means: triangles by their corners, or points.
using Corners = std::array<Vec3d, 3>;
struct Geometry {
    std::vector<Corners> triangles;
    std::vector<Vec3d> points;

    friend bool operator==(const Geometry&, const Geometry&) = default;
};
/// A mesh, or points if there are no faces.
struct Elements {
    std::vector<Vec3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;

    Geometry geometry() const {
        if (faces.empty()) return {{}, vertices};
        Geometry all;
        for (const auto& [i, j, k] : faces) all.triangles.push_back({vertices[i], vertices[j], vertices[k]});
        return all;
    }
};

std::string digits_of(double x) {
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

std::vector<std::string> numbers_of(Text& text, const Vec3d& p) {
    return {text.number(p[0]), text.number(p[1]), text.number(p[2])};
}

std::string obj(const Elements& elements, const Style& style) {
    Text text(style);
    const auto put = [&](std::vector<std::string> all) {
        text.between("#");
        static constexpr const char* others[] = {
            "o a\\",      "g b c\\", "usemtl C:\\paint\\", "mtllib C:\\",   "s off", "vn 0 0 1",
            "vt 0 \\\n1", "l 1 1",   "shadow_obj \\",      "curv 0 1 \\\n1"};
        if (text.choice(names, 6) == 1) text.line(others[text.choice(names, std::size(others))]);
        for (std::size_t i = 1; i < all.size(); ++i)
            if (text.choice(joins, 5) == 1) all[i] = "\\\n" + all[i];
        text.line(text.row(all) + text.note("#"));
    };
    const auto put_faces = [&] {
        for (const auto& face : elements.faces) {
            std::vector<std::string> all{"f"};
            for (const std::uint32_t v : face) {
                const bool is_relative = !text.has(order) && text.choice(words, 3) == 1;
                const auto count = static_cast<std::int64_t>(elements.vertices.size());
                all.push_back(std::to_string(is_relative ? v - count : v + 1) +
                              std::array{"", "/1", "//1", "/1/1"}[text.choice(words, 4)]);
            }
            put(all);
        }
    };
    if (text.has(order)) put_faces();
    for (const Vec3d& p : elements.vertices) {
        std::vector<std::string> all = numbers_of(text, p);
        all.insert(all.begin(), "v");
        if (text.choice(words, 4) == 1) all.emplace_back("1");
        put(all);
    }
    if (!text.has(order)) put_faces();
    return text.written();
}

std::string off(const Elements& elements, const Style& style) {
    Text text(style);
    const std::string vertices = std::to_string(elements.vertices.size()),
                      faces = std::to_string(elements.faces.size());
    text.between("#");
    switch (text.choice(words, 5)) {
        case 0:
            text.line("OFF" + text.note("#"));
            text.line(text.row({vertices, faces, "0"}) + text.note("#"));
            break;
        case 1:
            text.line(text.row({"OFF", vertices, faces, "0"}));
            break;
        case 2:
            text.line(text.row({vertices, faces, "7"}));
            break;
        case 3:
            for (const std::string& word : {std::string("off"), vertices, faces, std::string("0")})
                text.line(word);
            break;
        default:
            text.line("OFF"), text.line(text.row({vertices, faces}));
    }
    // Several vertices may share a line.
    std::vector<std::string> all;
    const std::uint64_t a_line = 1 + text.choice(joins, 4);
    for (std::size_t i = 0; i < elements.vertices.size(); ++i) {
        const auto some = numbers_of(text, elements.vertices[i]);
        all.insert(all.end(), some.begin(), some.end());
        if ((i + 1) % a_line != 0 && i + 1 < elements.vertices.size()) continue;
        text.between("#");
        text.line(text.row(all) + text.note("#"));
        all.clear();
    }
    for (const auto& face : elements.faces) {
        text.between("#");
        all = {"3"};
        for (const std::uint32_t v : face)
            all.push_back((text.choice(joins, 5) == 1 ? "\n" : "") + std::to_string(v));
        if (text.choice(names, 3) == 1) all.insert(all.end(), {"255", "0", "0"});
        text.line(text.row(all) + text.note("#"));
    }
    return text.written();
}

/// Binary, if there is an order of bytes.
std::string ply(const Elements& elements, const Style& style, std::optional<std::endian> bytes) {
    Style of_header = style;
    if (bytes) of_header[last_end] = 0;
    Text text(of_header);
    const bool is_points = elements.faces.empty();
    const auto header_between = [&] {
        static constexpr const char* others[] = {"comment C:\\models\\", "comment element face 9",
                                                 "obj_info 1", "comment"};
        if (text.choice(comments, 4) == 1) text.line(others[text.choice(comments, std::size(others))]);
    };
    text.line("ply");
    header_between();
    text.line(std::string("format ") +
              (!bytes                          ? "ascii"
               : *bytes == std::endian::little ? "binary_little_endian"
                                               : "binary_big_endian") +
              " 1.0");
    const auto declare_vertices = [&] {
        text.line("element vertex " + std::to_string(elements.vertices.size()));
        const bool is_other = text.choice(words, 2) == 1;
        for (const char axis : {'x', 'y', 'z'}) {
            header_between();
            text.line(std::string("property ") + (is_other ? "float64 " : "double ") + axis);
        }
        if (text.has(names)) text.line("property uchar red");
    };
    const auto declare_faces = [&] {
        text.line("element face " + std::to_string(elements.faces.size()));
        text.line(std::array{"property list uchar int vertex_indices",
                             "property list uint8 int32 vertex_index",
                             "property list uchar uint vertex_indices"}[text.choice(words, 3)]);
    };
    if (text.has(order) && !is_points) declare_faces();
    declare_vertices();
    if (!text.has(order) && !is_points) declare_faces();
    text.line("end_header");
    std::string body;
    const auto put = [&](const std::vector<std::string>& all) {
        text.between("");
        std::vector<std::string> broken = all;
        for (std::size_t i = 1; i < all.size(); ++i)
            if (text.choice(joins, 5) == 1) broken[i] = "\n" + all[i];
        text.line(text.row(broken));
    };
    const auto append = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (*bytes != std::endian::native) std::reverse(raw, raw + sizeof raw);
        body.append(raw, sizeof raw);
    };
    const auto put_vertices = [&] {
        for (const Vec3d& p : elements.vertices) {
            if (bytes) {
                for (int k = 0; k < 3; ++k) append(p[k]);
                if (text.has(names)) append(std::uint8_t(10));
                continue;
            }
            std::vector<std::string> all = numbers_of(text, p);
            if (text.has(names)) all.emplace_back("10");
            put(all);
        }
    };
    const auto put_faces = [&] {
        for (const auto& [i, j, k] : elements.faces) {
            if (bytes)
                append(std::uint8_t(3)), append(i), append(j), append(k);
            else
                put({"3", std::to_string(i), std::to_string(j), std::to_string(k)});
        }
    };
    if (text.has(order)) put_faces();
    put_vertices();
    if (!text.has(order)) put_faces();
    return text.written() + body;
}

std::string stl(const Elements& elements, const Style& style) {
    Text text(style);
    const auto spelled = [&](std::string word) {
        if (text.choice(words, 3) == 1)
            for (char& letter : word) letter = static_cast<char>(std::toupper(letter));
        return word;
    };
    const auto put = [&](std::vector<std::string> all) {
        text.between("");
        all[0] = spelled(all[0]);
        if (text.choice(names, 4) == 1 && all[0] != "end") all.emplace_back("note");
        text.line(text.row(all));
    };
    const auto end = [&](const std::string& what) {
        put(text.choice(words, 4) == 1 ? std::vector<std::string>{"end", what}
                                       : std::vector<std::string>{"end" + what});
    };
    put({"solid", "a"});
    for (std::size_t i = 0; i < elements.faces.size(); ++i) {
        if (i > 0 && text.choice(order, 3) == 1) end("solid"), put({"solid", "b"});
        put({"facet", "normal", "0", "0", "1"});
        put({"outer", "loop"});
        for (const std::uint32_t v : elements.faces[i]) {
            std::vector<std::string> all = numbers_of(text, elements.vertices[v]);
            all.insert(all.begin(), "vertex");
            put(all);
        }
        end("loop"), end("facet");
    }
    end("solid");
    return text.written();
}

/// Rows of numbers: of `.csv` with a separator, of `.xyz` without.
std::string rows(const Elements& elements, const Style& style, bool is_csv) {
    Text text(style);
    const std::string separator = is_csv ? std::array{",", ";", "\t", " "}[text.choice(words, 4)]
                                         : std::string(text.choice(words, 2) == 1 ? "\t" : "");
    const bool has_commas = separator == ";" && text.has(words) && style[words] % 2 == 0;
    const bool is_counted = !is_csv && text.has(names), is_turned = is_csv && text.has(order);
    if (is_counted) text.line(std::to_string(elements.vertices.size()));
    if (is_counted && style[names] % 2 == 0) text.line("made by a program");
    text.between("#");
    if (is_turned)
        text.line(text.row({"id", "Z", "\"x\"", "y"}, separator == " " ? "" : separator));
    else if (!is_counted && text.choice(names, 2) == 1)
        text.line(text.row({"x", "y", "z"}, separator == " " ? "" : separator));
    for (const Vec3d& p : elements.vertices) {
        text.between("#");
        std::vector<std::string> all = numbers_of(text, p);
        if (is_turned) all = {"7", all[2], all[0], all[1]};
        if (has_commas)
            for (std::string& word : all) std::replace(word.begin(), word.end(), '.', ',');
        if (is_counted && style[names] % 3 == 0) all.insert(all.begin(), "Fe");
        text.line(text.row(all, separator == " " ? "" : separator));
    }
    return text.written();
}

struct Format {
    const char* file;
    bool holds_faces, holds_points;
    std::string (*write)(const Elements&, const Style&);
};
constexpr Format formats[] = {
    {"a.obj", true, true, obj},
    {"a.off", true, true, off},
    {"a.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::nullopt); }},
    {"b.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::endian::little); }},
    {"c.ply", true, true, [](const Elements& e, const Style& s) { return ply(e, s, std::endian::big); }},
    {"a.stl", true, false, stl},
    {"a.csv", false, true, [](const Elements& e, const Style& s) { return rows(e, s, true); }},
    {"a.xyz", false, true, [](const Elements& e, const Style& s) { return rows(e, s, false); }},
};

// ---- The hunt ----

/// Numbers as in German, while one lives.
class CommaLocale {
public:
    explicit CommaLocale(bool is_used) {
        if (is_used)
            std::locale::global(std::locale(std::locale(), new Commas)),
                std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
    }
    ~CommaLocale() {
        std::locale::global(before_);
        std::setlocale(LC_NUMERIC, "C");
    }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

private:
    struct Commas : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    std::locale before_;
};

Geometry read(const std::filesystem::path& path) {
    const Scene<double> scene = load_scene<double>(path);
    if (const auto* const cloud = std::get_if<PointCloud<double, 3>>(&scene)) return {{}, cloud->points};
    Geometry all;
    const auto& mesh = std::get<TriangleMesh<double>>(scene);
    for (const auto& [i, j, k] : mesh.triangles)
        all.triangles.push_back({mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]});
    return all;
}

/// Why a text does not give the geometry; empty if it does.
std::string fault_of(const Format& format, const Elements& elements, const Style& style) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("hedgerow-hunter-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const auto path = folder / format.file;
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary) << format.write(elements, style);
    std::string fault;
    try {
        const CommaLocale used(style[locale] != 0);
        if (!(read(path) == elements.geometry())) fault = "it gives another geometry";
    } catch (const std::exception& refused) {
        fault = std::string("it is refused: ") + refused.what();
    }
    std::filesystem::remove_all(folder);
    return fault;
}

Elements any_elements(Random& random, const Format& format) {
    constexpr double numbers[] = {0,    1,    -1,       0.5,  0.1,       10,      13,
                                  2573, 1e-7, -123.456, 1e10, 5412345.2, 3.0e-300};
    Elements all;
    const std::uint64_t count = 3 + random.bits() % 6;
    for (std::uint64_t i = 0; i < count; ++i) {
        Vec3d p;
        for (int k = 0; k < 3; ++k) p[k] = numbers[random.bits() % std::size(numbers)];
        all.vertices.push_back(p);
    }
    if (format.holds_points && (!format.holds_faces || random.bits() % 4 == 0)) return all;
    for (std::uint64_t n = 1 + random.bits() % 5; n > 0; --n) {
        std::array<std::uint32_t, 3> face{};
        for (auto& v : face) v = static_cast<std::uint32_t>(random.bits() % count);
        all.faces.push_back(face);
    }
    return all;
}

/// Leaves out what is not needed for the fault: traits, faces, and points that no face names.
void shrink(const Format& format, Elements& elements, Style& style) {
    const auto fails = [&](const Elements& e, const Style& s) { return !fault_of(format, e, s).empty(); };
    for (auto& trait : style) {
        const auto before = std::exchange(trait, 0);
        if (before != 0 && !fails(elements, style)) trait = before;
    }
    if (elements.faces.empty())
        elements.vertices = fewer(elements.vertices, [&](const auto& some) {
            return fails({some, {}}, style);
        });
    else
        elements.faces = fewer(elements.faces, [&](const auto& some) {
            return fails({elements.vertices, some}, style);
        });
}

std::string literal(const std::string& bytes) {
    constexpr char hex[] = "0123456789ABCDEF";
    std::string text = "\"";
    for (const char c : bytes) {
        const auto u = static_cast<unsigned char>(c);
        if (c == '\n')
            text += "\\n";
        else if (c == '\r')
            text += "\\r";
        else if (c == '"' || c == '\\')
            text += std::string("\\") + c;
        else if (c >= ' ' && c <= '~')
            text += c;
        else
            text += std::string("\\x") + hex[u >> 4] + hex[u & 15] + "\" \"";
    }
    return text + "\"";
}
std::string literal(const Vec3d& p) {
    return "Vec3d(" + digits_of(p[0]) + ", " + digits_of(p[1]) + ", " + digits_of(p[2]) + ")";
}

/// A fault as an entry of the corpus (tests/corpus.h).
std::string entry(const Format& format, const Elements& elements, const Style& style,
                  const std::string& fault) {
    const Geometry geometry = elements.geometry();
    std::string triangles, points;
    for (const Corners& t : geometry.triangles)
        triangles += (triangles.empty() ? "{" : ", {") + literal(t[0]) + ", " + literal(t[1]) + ", " +
                     literal(t[2]) + "}";
    for (const Vec3d& p : geometry.points) points += (points.empty() ? "" : ", ") + literal(p);
    const std::string bytes = format.write(elements, style);
    return "    // " + fault + "\n    all.push_back({\"" + format.file + "\", std::string(" + literal(bytes) +
           ", " + std::to_string(bytes.size()) + "), {" + triangles + "}, {" + points + "}});\n";
}

}  // namespace

Report hunt_files(std::uint64_t seed, std::uint64_t round) {
    Random random(seed, round);
    Report report;
    for (const Format& format : formats) {
        Elements elements = any_elements(random, format);
        Style style{};
        for (auto& trait : style)
            if (random.bits() % 3 == 0) trait = 1 + random.bits() % 1000003;
        ++report.questions;
        if (fault_of(format, elements, style).empty()) continue;
        shrink(format, elements, style);
        report.found.push_back("    // Seed " + std::to_string(seed) + ", round " + std::to_string(round) +
                               ".\n" + entry(format, elements, style, fault_of(format, elements, style)));
    }
    return report;
}

}  // namespace hedgerow::hunter
