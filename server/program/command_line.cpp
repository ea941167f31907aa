#include "program/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

namespace plab::program
{
namespace
{

/// "TEXT:{none,lz4,zstd}" is a value out of a list.
std::vector<std::string> words_in(const std::string& type)
{
    const std::size_t begin = type.find('{'), end = type.find('}');
    std::vector<std::string> out;
    if (begin == std::string::npos || end == std::string::npos || end < begin) return out;
    std::string word;
    for (const char c : type.substr(begin + 1, end - begin - 1) + ",")
        if (c != ',')
            word += c;
        else if (!word.empty())
            out.push_back(word), word.clear();
    return out;
}

OptionOutline outline_of(const CLI::Option& option)
{
    OptionOutline out;
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    if (option.get_positional()) out.place = option.get_name(true, false).substr(0, option.get_name(true, false).find(','));
    const std::string type = option.get_type_name();
    out.has_value = option.get_items_expected_max() != 0;
    // What a check adds behind a colon is no name of a value; "CLIENT:NUMBER" is.
    const bool has_check = type.find('{') != std::string::npos || type.find(" in [") != std::string::npos;
    if (out.has_value) out.value = has_check ? type.substr(0, type.find(':')) : type;
    if (out.has_value) out.words = words_in(type);
    out.help = option.get_description(), out.group = option.get_group(), out.fallback = option.get_default_str();
    out.is_required = option.get_required();
    // Of an option that may be repeated each takes one value.
    const bool takes_more = option.get_items_expected_max() > 1 && (option.get_allow_extra_args() || option.get_positional());
    out.most = !takes_more ? 1 : option.get_items_expected_max();
    return out;
}

}  // namespace

CommandOutline outline_of(const CLI::App& app)
{
    CommandOutline out;
    out.name = app.get_name(), out.help = app.get_description(), out.footer = app.get_footer();
    for (const CLI::Option* option : app.get_options())
    {
        if (option->get_group().empty()) continue;
        OptionOutline o = outline_of(*option);
        (o.names.empty() ? out.places : out.options).push_back(std::move(o));
    }
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) out.commands.push_back(outline_of(*command));
    return out;
}

std::optional<std::string> answer_for_shell(const CLI::App& app, int argc, const char* const* argv, const std::string& version,
                                            const ValueSource& values, const std::string& more)
{
    return answer_for_shell(outline_of(app), argc, argv, version, values, more);
}

std::optional<ParseEnd> parse_command_line(CLI::App& app, int argc, const char* const* argv, const std::string& version,
                                           const ValueSource& values)
{
    if (auto answer = answer_for_shell(app, argc, argv, version, values)) return ParseEnd{0, *answer};
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError& e)
    {
        // CLI11 has an exit code for each kind of error; ours say only that the usage was wrong.
        std::ostringstream text;
        const int code = app.exit(e, text, text);
        return ParseEnd{code == 0 ? 0 : 2, text.str()};
    }
    return {};
}

}  // namespace plab::program
