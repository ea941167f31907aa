#include "program/command_outline.h"

#include <CLI/CLI.hpp>
#include <algorithm>

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

const CommandOutline* CommandOutline::find(const std::string& command) const
{
    const auto at = std::find_if(commands.begin(), commands.end(), [&](const CommandOutline& c) { return c.name == command; });
    return at == commands.end() ? nullptr : &*at;
}

const OptionOutline* CommandOutline::option(const std::string& wanted) const
{
    for (const OptionOutline& o : options)
        if (std::find(o.names.begin(), o.names.end(), wanted) != o.names.end()) return &o;
    return nullptr;
}

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

}  // namespace plab::program
