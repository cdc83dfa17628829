/// The names of structures, from the library's table of them.
#pragma once

#include <string>
#include <vector>

#include <hedgerow/any_index.h>

namespace hedgerow {

/// All structures that answer rays over sets of P, with their default options, and others by their specs.
template <class P>
std::vector<std::string> structures_for(std::vector<std::string> others = {}) {
    std::vector<std::string> names;
    for (const auto& s : structure_list())
        if (s.rays && s.holds(P::dimension, PointSet<ViewOf<P>>)) names.emplace_back(s.name);
    names.insert(names.end(), others.begin(), others.end());
    return names;
}
/// These structures by each of their builders: "bvh:builder=sweep".
template <class P>
std::vector<std::string> builders_for() {
    std::vector<std::string> names;
    for (const auto& s : structure_list()) {
        if (!s.rays || !s.holds(P::dimension, PointSet<ViewOf<P>>)) continue;
        const std::size_t before = names.size();
        for (const auto& option : s.options)
            if (option.name == "builder")
                for (const auto builder : option.choices)
                    names.push_back(std::string(s.name) + ":builder=" + std::string(builder));
        if (names.size() == before) names.emplace_back(s.name);
    }
    return names;
}

}  // namespace hedgerow
