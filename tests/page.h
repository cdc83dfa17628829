/// Checks of pages: well formed, and without other files.
#pragma once

#include <string>
#include <vector>

namespace hedgerow {

/// The first fault of a page as XML: a tag that is not closed in order, or a sign that is not escaped. Empty
/// if there is none.
inline std::string ill_formed(const std::string& page) {
    std::vector<std::string> open;
    for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
        const std::size_t end = page.find('>', at);
        if (end == std::string::npos) return "a tag without an end";
        const std::string tag = page.substr(at + 1, end - at - 1);
        const std::string name = tag.substr(0, tag.find_first_of(" \n/", 1));
        if (tag.find('<') != std::string::npos) return "a '<' in a tag: " + tag;
        if (tag[0] == '/') {
            if (open.empty() || "/" + open.back() != tag) return "unexpected <" + tag + ">";
            open.pop_back();
        } else if (tag[0] != '!' && tag.back() != '/') {
            open.push_back(name);
        }
        at = end;
    }
    for (std::size_t at = page.find('&'); at != std::string::npos; at = page.find('&', at + 1))
        if (page.substr(at, 5).find(';') == std::string::npos && page.substr(at, 6) != "&quot;")
            return "a bare '&'";
    return open.empty() ? "" : "<" + open.back() + "> is not closed";
}
/// The first construct by which a page refers to another file. Empty if there is none.
inline std::string asked_for(const std::string& page) {
    for (const char* outside : {"<script", "<link", "<img", "src=", "href=", "@import", "url("})
        if (page.find(outside) != std::string::npos) return outside;
    return "";
}

}  // namespace hedgerow
