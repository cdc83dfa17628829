#include <hedgerow/measure/lists.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>

namespace hedgerow::measure {
namespace {

using View = std::string_view;

std::vector<View> parts_of(View text, char separator) {
    std::vector<View> parts;
    for (std::size_t end; (end = text.find(separator)) != View::npos; text.remove_prefix(end + 1))
        parts.push_back(text.substr(0, end));
    parts.push_back(text);
    return parts;
}

/// Parses a number with an optional suffix k, M or G. Returns nothing for other texts.
std::optional<double> number_of(View text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const View suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
    double times = 0;
    if (suffix.empty()) times = 1;
    if (suffix == "k" || suffix == "K") times = 1e3;
    if (suffix == "m" || suffix == "M") times = 1e6;
    if (suffix == "g" || suffix == "G") times = 1e9;
    if (error != std::errc() || times == 0 || !std::isfinite(value)) return std::nullopt;
    return value * times;
}

std::string text_of(double value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value, std::chars_format::general);
    return error == std::errc() ? std::string(text, end) : std::to_string(value);
}
/// Writes whole numbers in full, since an option that counts takes no exponent.
std::string value_text(double value) {
    return value == std::floor(value) && std::fabs(value) < 1e18
               ? std::to_string(static_cast<long long>(value))
               : text_of(value);
}

bool whole(double x) {
    return x == std::floor(x);
}

}  // namespace

std::vector<std::string> structures_of(View list) {
    std::vector<std::string> structures;
    for (const View part : parts_of(list, ',')) {
        if (part.empty())
            throw UsageError("'" + std::string(list) +
                             "' has an empty part; write structures as grid,bvh:builder=sweep,kdtree");
        const bool more = part.find('=') != View::npos && part.find(':') == View::npos;
        if (!more) {
            structures.emplace_back(part);
        } else if (structures.empty()) {
            throw UsageError("'" + std::string(part) +
                             "' is an option without a structure; write it as grid:" + std::string(part));
        } else {
            structures.back() +=
                (structures.back().find(':') == std::string::npos ? ":" : ",") + std::string(part);
        }
    }
    return structures;
}

Sweep sweep_of(View text) {
    const auto complain = [&](const std::string& what) {
        throw UsageError("--sweep " + std::string(text) + ": " + what +
                         "; write it as grid:resolution=8..256 or bvh:builder=binned,sweep,lbvh");
    };
    // Split the text into the structure and its options, each with its values.
    const auto colon = text.find(':');
    if (colon == View::npos || colon + 1 == text.size()) complain("no option is named");
    struct Option {
        std::string name;
        std::vector<std::string> values;
    };
    std::vector<Option> options;
    for (const View part : parts_of(text.substr(colon + 1), ',')) {
        const auto equals = part.find('=');
        if (equals == 0 || part.empty() || (equals == View::npos && options.empty()))
            complain("'" + std::string(part) + "' is no option and no value");
        if (equals != View::npos) options.push_back({std::string(part.substr(0, equals)), {}});
        const View value = equals == View::npos ? part : part.substr(equals + 1);
        if (value.find("..") == View::npos) {
            options.back().values.emplace_back(value);
        } else {
            for (const double x : range_of(value)) options.back().values.push_back(value_text(x));
        }
    }
    // Keep options of one value with the structure, and find the one that has several.
    Sweep sweep{std::string(text.substr(0, colon)), {}, {}, {}};
    for (const Option& o : options) {
        if (o.values.size() == 1) {
            sweep.structure +=
                (sweep.structure.find(':') == std::string::npos ? ":" : ",") + o.name + "=" + o.values[0];
        } else if (!sweep.option.empty()) {
            complain("'" + sweep.option + "' and '" + o.name + "' both have several values");
        } else {
            sweep.option = o.name, sweep.values = o.values;
        }
    }
    if (sweep.option.empty()) complain("no option has several values");
    // List a structure for each value.
    for (const std::string& value : sweep.values)
        sweep.structures.push_back(sweep.structure +
                                   (sweep.structure.find(':') == std::string::npos ? ":" : ",") +
                                   sweep.option + "=" + value);
    return sweep;
}

std::vector<double> range_of(View text) {
    const auto dots = text.find("..");
    const auto complain = [&] {
        throw UsageError("'" + std::string(text) + "' is no range; write two numbers that go up, as 8..256");
    };
    if (dots == View::npos) complain();
    const auto from = number_of(text.substr(0, dots)), to = number_of(text.substr(dots + 2));
    if (!from || !to || !(*from < *to)) complain();
    std::vector<double> values;
    if (*from > 0 && *to / *from >= 8) {
        // The last two steps are one if the last would be less than half a doubling, a factor of √2.
        for (double x = *from; x < *to / std::sqrt(2.0); x *= 2) values.push_back(x);
        values.push_back(*to);
    } else {
        // Step evenly; between whole ends, round to whole numbers.
        constexpr int most = 9;
        const bool count = whole(*from) && whole(*to);
        const int steps = count ? static_cast<int>(std::min<double>(most - 1, *to - *from)) : most - 1;
        for (int i = 0; i <= steps; ++i) {
            const double x = *from + (*to - *from) * i / steps;
            values.push_back(count ? std::round(x) : x);
        }
    }
    return values;
}

std::vector<std::uint64_t> sizes_of(View text) {
    std::vector<double> values;
    if (text.find("..") != View::npos) {
        values = range_of(text);
    } else {
        for (const View part : parts_of(text, ',')) values.push_back(number_of(part).value_or(-1));
    }
    std::vector<std::uint64_t> sizes;
    for (const double v : values) {
        if (!(v >= 1 && v < 1e15) || !whole(v) || (!sizes.empty() && v <= static_cast<double>(sizes.back())))
            throw UsageError("'" + std::string(text) +
                             "' are no sizes; write whole numbers that go up, as 1k,10k,100k or 1000..64000");
        sizes.push_back(static_cast<std::uint64_t>(v));
    }
    return sizes;
}

std::vector<std::string> usual_structures(int dimension, bool points, std::size_t size,
                                          std::vector<std::string>& left_out) {
    struct Variant {
        const char *structure, *options;
        std::size_t largest;
    };
    // Above `largest` primitives builds take too long: a BSP tree tests many planes a node, exact SAH
    // builders test every edge of every box.
    static constexpr std::size_t any = ~std::size_t{0};
    static constexpr Variant slow[] = {{"bsp", "", 50'000}};
    static constexpr Variant variants[] = {
        {"grid", "heuristic=roots", any},    {"kdtree", "builder=median", any},
        {"bvh", "builder=sweep", 2'000'000}, {"bvh", "builder=lbvh", any},
        {"bvh", "builder=ploc", any},        {"bvh", "reinsertion=3", 2'000'000}};
    std::vector<std::string> usual;
    const auto add = [&](const std::string& structure, std::size_t largest) {
        (size <= largest ? usual : left_out).push_back(structure);
    };
    for (const StructureInfo& s : structure_list()) {
        if (!s.holds(dimension, points)) continue;
        const auto limit = std::find_if(std::begin(slow), std::end(slow),
                                        [&](const Variant& v) { return v.structure == s.name; });
        add(std::string(s.name), limit == std::end(slow) ? any : limit->largest);
        for (const Variant& v : variants)
            if (v.structure == s.name) add(std::string(s.name) + ":" + v.options, v.largest);
    }
    return usual;
}

}  // namespace hedgerow::measure
