#include "arguments.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hedgerow/base/error.h>
#include <hedgerow/base/spelling.h>

namespace hedgerow::cli {

namespace {

template <class T>
bool reads_as(const std::string& text) {
    T value{};
    const char* const end = text.data() + text.size();
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [rest, error] = std::from_chars(begin, end, value);
    if constexpr (std::is_floating_point_v<T>)
        if (!(std::abs(value) <= std::numeric_limits<float>::max())) return false;  // NaN too
    return error == std::errc() && rest == end;
}

CLI::Validator number(bool good(const std::string&), const std::string& wanted) {
    return CLI::Validator(
        [good, wanted](std::string& text) {
            return good(text) ? std::string() : fmt::format("'{}' is not {}", text, wanted);
        },
        "");
}

std::vector<std::string_view> names_of(const std::vector<const CLI::App*>& verbs) {
    std::vector<std::string_view> names;
    names.reserve(verbs.size());
    for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
    return names;
}
std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

void check_arguments(CLI::App& verb) {
    for (CLI::Option* option : verb.get_options()) {
        const std::string type = option->get_type_name();
        if (type.starts_with("FLOAT"))
            option->check(number(reads_as<double>, "a finite number from -3.4e38 to 3.4e38"));
        else if (type.starts_with("UINT"))
            option->check(number(reads_as<std::uint64_t>, "a whole number from 0 to 2^64 - 1"));
        else if (type.starts_with("INT"))
            option->check(number(reads_as<std::int32_t>, "a whole number from -2^31 to 2^31 - 1"));
        else if (type.starts_with("TEXT"))
            option->check(
                number([](const std::string& text) { return !text.empty(); }, "a name: it is empty"));
    }
}

void check_verb(const CLI::App& app, int count, const char* const* arguments) {
    if (count < 2 || std::string_view(arguments[1]).starts_with('-')) return;
    const std::string_view wanted = arguments[1];
    const auto names = names_of(verbs_of(app));
    for (const auto name : names)
        if (name == wanted) return;
    throw UsageError(fmt::format("there is no verb '{}'{}; there are {}", wanted, suggestion(wanted, names),
                                 fmt::join(names, ", ")));
}

std::string unknown_argument(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    const CLI::App& verb = chosen.empty() ? app : *chosen.front();
    const auto left = app.remaining(true);
    // Choose the argument to name: the first option, else the first of all.
    std::string_view wrong = left.empty() ? std::string_view() : left.front();
    for (const std::string& argument : left)
        if (argument.starts_with('-')) {
            wrong = argument;
            break;
        }
    if (!wrong.starts_with('-'))
        return fmt::format("'{}' is one argument too many. See 'hedgerow {} --help'", wrong, verb.get_name());
    // Suggest the verb's nearest option, without the value of "--option=value".
    wrong = wrong.substr(0, wrong.find('='));
    std::vector<std::string> options;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    const std::vector<std::string_view> known(options.begin(), options.end());
    return fmt::format("'{}' has no option '{}'{}. See 'hedgerow {} --help'", verb.get_name(), wrong,
                       suggestion(wrong, known), verb.get_name());
}

}  // namespace hedgerow::cli
