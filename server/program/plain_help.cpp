#include "program/plain_help.h"

#include <string_view>

#include "program/completion.h"

namespace plab::program
{
namespace
{

CommandOutline with_help_and_version(CommandOutline program)
{
    const OptionOutline own[] = {flag("--help", "Print this help message and exit"),
                                 flag("--version", "Display program version information and exit")};
    program.options.insert(program.options.begin(), std::begin(own), std::end(own));
    return program;
}

/// Two columns, as the parser of the other programs prints them.
std::string help_line(const std::string& name, const std::string& help)
{
    constexpr std::size_t kColumn = 30;
    std::string out = "  " + name;
    out += out.size() < kColumn ? std::string(kColumn - out.size(), ' ') : "\n" + std::string(kColumn, ' ');
    return out + help + "\n";
}

}  // namespace

OptionOutline flag(std::string name, std::string help)
{
    OptionOutline out;
    out.names = {std::move(name)}, out.help = std::move(help), out.group = "Options";
    return out;
}

OptionOutline option_with(std::string name, std::string value, std::string help)
{
    OptionOutline out = flag(std::move(name), std::move(help));
    out.value = std::move(value), out.has_value = true;
    return out;
}

OptionOutline place_of_file(std::string name, std::string help)
{
    OptionOutline out;
    out.place = std::move(name), out.value = "FILE", out.help = std::move(help), out.group = "Positionals";
    out.has_value = out.is_required = true;
    return out;
}

std::string help_text(const CommandOutline& program)
{
    const CommandOutline whole = with_help_and_version(program);
    std::string out = whole.help + "\nUsage: " + whole.name + " [OPTIONS]";
    for (const OptionOutline& o : whole.places) out += " " + o.place;
    out += "\n\n";
    if (!whole.places.empty()) out += "Positionals:\n";
    for (const OptionOutline& o : whole.places) out += help_line(o.place, o.help);
    out += whole.places.empty() ? "Options:\n" : "\nOptions:\n";
    for (const OptionOutline& o : whole.options) out += help_line(o.names.back() + (o.has_value ? " " + o.value : ""), o.help);
    return out + "\n" + whole.footer + "\n";
}

std::optional<std::string> answer_about(const CommandOutline& program, const std::string& version, int argc, const char* const* argv)
{
    const std::string_view word = argc > 1 ? argv[1] : "";
    if (argc == 2 && word == "--help") return help_text(program);
    if (argc == 2 && word == "--version") return program.name + " " + version + "\n";
    const auto files = [](const Wanted&) { return Values{{}, true, false}; };
    return answer_for_shell(with_help_and_version(program), argc, argv, version, files);
}

}  // namespace plab::program
