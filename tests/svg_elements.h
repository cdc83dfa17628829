/// What an SVG picture consists of.
#pragma once

#include <string>
#include <vector>

#include <expat.h>
#include <gtest/gtest.h>

#include <hedgerow/geometry/box.h>

namespace hedgerow {

/// The number of elements of an XML document whose class begins with `begins`. Fails the test if the document
/// is not well formed.
inline std::size_t elements_with_class(const std::string& xml, const std::string& begins) {
    struct Seen {
        std::string begins;
        std::size_t count = 0;
    } seen{begins};
    const auto parser = XML_ParserCreate(nullptr);
    XML_SetUserData(parser, &seen);
    XML_SetStartElementHandler(parser, [](void* data, const XML_Char*, const XML_Char** attributes) {
        auto& s = *static_cast<Seen*>(data);
        for (; *attributes != nullptr; attributes += 2)
            s.count +=
                std::string(attributes[0]) == "class" && std::string(attributes[1]).starts_with(s.begins);
    });
    const auto status = XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), 1);
    EXPECT_EQ(status, XML_STATUS_OK) << XML_ErrorString(XML_GetErrorCode(parser)) << " in line "
                                     << XML_GetCurrentLineNumber(parser);
    XML_ParserFree(parser);
    return seen.count;
}

/// The boxes of the rectangles whose class begins with `begins`.
inline std::vector<Box2d> rectangles_with_class(const std::string& svg, const std::string& begins) {
    std::vector<Box2d> all;
    for (std::size_t at = svg.find("<rect "); at != svg.npos; at = svg.find("<rect ", at + 1)) {
        const std::string element = svg.substr(at, svg.find('>', at) - at);
        if (element.find("class=\"" + begins) == element.npos) continue;
        const auto number = [&](const std::string& name) {
            return std::stod(element.substr(element.find(" " + name + "=\"") + name.size() + 3));
        };
        const Vec2d low(number("x"), number("y"));
        all.push_back({low, low + Vec2d(number("width"), number("height"))});
    }
    return all;
}

}  // namespace hedgerow
