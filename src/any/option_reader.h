/// Reads a structure's options from text: "builder=sweep,max_leaf_size=4".
#pragma once

#include <algorithm>
#include <charconv>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <hedgerow/base/error.h>
#include <hedgerow/base/option.h>
#include <hedgerow/base/spelling.h>

namespace hedgerow::detail {

inline std::string choices(std::span<const std::string_view> all) {
    std::string text;
    for (const auto s : all) text += (text.empty() ? "" : ", ") + std::string(s);
    return text;
}

/// The options of one structure, as pairs of name and value. A struct of options that lists itself to the
/// reader (base/option.h) gets the values that were given. `finish` refuses pairs that are left over, since
/// their names are unknown. Throws UsageError for text that is no option or no valid value.
class OptionReader {
public:
    /// Reads "name" or "name:option=value,option=value".
    explicit OptionReader(std::string_view spec) : structure_(spec.substr(0, spec.find(':'))) {
        auto text = spec.substr(std::min(structure_.size() + 1, spec.size()));
        while (!text.empty()) {
            const auto comma = text.find(',');
            const std::string_view pair = text.substr(0, comma);
            text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
            const auto equals = pair.find('=');
            if (equals == std::string_view::npos)
                throw UsageError("structure '" + structure_ + "': option '" + std::string(pair) +
                                 "' lacks its '=value'");
            given_[std::string(pair.substr(0, equals))] = std::string(pair.substr(equals + 1));
        }
    }

    template <class N>
    void operator()(std::string_view name, N& value, std::type_identity_t<N> least,
                    std::type_identity_t<N> most, std::string_view) {
        const auto text = take(name);
        if (text.empty()) return;
        N read{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read);
        if (error != std::errc() || end != text.data() + text.size() || !(read >= least && read <= most))
            fail(name, text, "a number from " + OptionInfos::text(least) + " to " + OptionInfos::text(most));
        value = read;
    }
    template <class E>
    void operator()(std::string_view name, E& value, std::span<const std::string_view> names,
                    std::string_view) {
        const auto text = take(name);
        if (text.empty()) return;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == text) return void(value = static_cast<E>(i));
        fail(name, text, "one of " + choices(names) + suggestion(text, names));
    }
    void operator()(std::string_view name, bool& value, std::string_view meaning) {
        (*this)(name, value, flag_names, meaning);
    }

    const std::string& structure() const { return structure_; }
    /// Whether an option is given with another value than `standard`. The option can still be read.
    bool differs(const std::string& name, std::string_view standard) const {
        const auto found = given_.find(name);
        return found != given_.end() && found->second != standard;
    }
    void finish() const {
        for (const auto& [name, value] : given_)
            throw UsageError("structure '" + structure_ + "' has no option '" + name + "'" +
                             suggestion(name, known_) +
                             (known_.empty() ? "" : "; it has " + choices(known_)));
    }

private:
    std::string take(std::string_view name) {
        known_.push_back(name);
        const auto found = given_.find(std::string(name));
        if (found == given_.end()) return {};
        std::string value = found->second;
        given_.erase(found);
        if (value.empty()) fail(name, value, "a value");
        return value;
    }
    [[noreturn]] void fail(std::string_view name, const std::string& text, const std::string& wanted) const {
        throw UsageError("structure '" + structure_ + "': " + std::string(name) + "=" + text + " is not " +
                         wanted);
    }

    std::string structure_;
    std::map<std::string, std::string> given_;
    std::vector<std::string_view> known_;
};

}  // namespace hedgerow::detail
