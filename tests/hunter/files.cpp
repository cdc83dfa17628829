/// Hunts for texts that mean the same and are read as something else. A mesh or points are written in a
/// style: with other ends of lines, comments, blanks, joined lines, orders and words than the plainest text
/// has. Every style must give the same geometry.
#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>
#include <utility>

#include <unistd.h>

#include <hedgerow/base/error.h>
#include <hedgerow/io/scene_file.h>

#include "formats.h"
#include "report.h"
#include "shrink.h"

namespace hedgerow::hunter {

namespace {

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

/// A fault as an entry of the corpus (tests/corpus/).
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
