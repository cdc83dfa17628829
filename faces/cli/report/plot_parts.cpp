#include <fmt/format.h>

#include <hedgerow/measure/quantity.h>

#include "plot_parts.h"
#include "xml.h"

namespace hedgerow::cli {

namespace plot_parts {

const char* colour_of(std::size_t i) {
    static constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#b3589a", "#c48a00",
                                              "#3d9bd1", "#7a3b10", "#555555", "#6a51a3", "#a50f15"};
    return colours[i % std::size(colours)];
}
const char* dash_of(std::size_t i) {
    return i < 10 ? "" : " stroke-dasharray=\"6 3\"";
}

std::string tick_text(double value, Unit unit) {
    switch (unit) {
        case Unit::seconds:
            return measure::seconds_text(value);
        case Unit::bytes:
            return measure::bytes_text(value);
        case Unit::percent:
            return fmt::format("{:g}%", 100 * value);
        case Unit::number:
            break;
    }
    const double k = value >= 1e9 ? 1e9 : value >= 1e6 ? 1e6 : value >= 1e4 ? 1e3 : 1;
    return fmt::format("{:g}{}", value / k, k == 1e9 ? "G" : k == 1e6 ? "M" : k == 1e3 ? "k" : "");
}

std::string opened(const std::string& title, double wide, double high) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "role=\"img\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<title>{2}</title>\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<text x=\"4\" y=\"18\" font-size=\"14\" font-weight=\"bold\">{2}</text>\n",
        wide, high, escaped(title));
}
std::string text(double x, double y, const char* anchor, const std::string& words, const char* colour) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y,
                       anchor, colour, escaped(words));
}
std::string line(double x1, double y1, double x2, double y2, const char* colour) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1,
                       y1, x2, y2, colour);
}
std::string dot(double x, double y, double radius, const char* colour) {
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, radius, colour);
}

}  // namespace plot_parts
}  // namespace hedgerow::cli
