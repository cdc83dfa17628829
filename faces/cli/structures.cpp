/// hedgerow structures: lists the structures that can be built, and their options.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hedgerow/any_index.h>
#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

#include "verbs.h"

namespace hedgerow::cli {

namespace {

const StructureInfo& structure_named(const std::string& name) {
    std::vector<std::string_view> names;
    std::string list;
    for (const StructureInfo& s : structure_list()) {
        if (s.name == name) return s;
        names.push_back(s.name);
        list += (list.empty() ? "" : ", ") + std::string(s.name);
    }
    throw UsageError(
        fmt::format("no structure is called '{}'{}; there are {}", name, suggestion(name, names), list));
}

nlohmann::ordered_json json_of(const StructureInfo& s) {
    auto options = nlohmann::ordered_json::array();
    for (const OptionInfo& o : s.options)
        options.push_back(
            {{"name", o.name}, {"values", o.values}, {"standard", o.standard}, {"meaning", o.meaning}});
    return {{"name", s.name}, {"description", s.description}, {"options", options}};
}

int show_all(bool json) {
    auto all = nlohmann::ordered_json::array();
    for (const StructureInfo& s : structure_list()) {
        all.push_back(json_of(s));
        if (!json) fmt::print("{:14} {}\n", s.name, s.description);
    }
    if (json)
        print_json(all);
    else
        fmt::print(
            "\nhedgerow structures NAME lists its options; they stand behind a colon, as "
            "bvh:builder=sweep,bins=8.\n");
    return 0;
}

int show_one(const StructureInfo& s, bool json) {
    if (json) {
        print_json(json_of(s));
        return 0;
    }
    fmt::print("{}: {}\n", s.name, s.description);
    for (const OptionInfo& o : s.options)
        fmt::print("  {}={} [{}]: {}\n", o.name, o.values, o.standard, o.meaning);
    if (s.options.empty()) fmt::print("  It has no options.\n");
    return 0;
}

}  // namespace

Run add_structures(CLI::App& verb) {
    struct Arguments {
        std::string name;
        bool json = false;
    };
    auto a = std::make_shared<Arguments>();
    verb.add_option("name", a->name, "a structure, to see its options");
    verb.add_flag("--json", a->json, "results as JSON");
    return [a] { return a->name.empty() ? show_all(a->json) : show_one(structure_named(a->name), a->json); };
}

}  // namespace hedgerow::cli
