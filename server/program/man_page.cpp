#include "program/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace plab::program
{
namespace
{

std::string upper(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// One line of text; troff's own signs lose their meaning.
std::string plain(const std::string& text)
{
    std::string out;
    if (text.starts_with(".") || text.starts_with("'")) out = "\\&";
    for (const char c : text)
    {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c == '\n' ? ' ' : c;
    }
    return out;
}

/// "Exit codes: 0 done" begins with a title of a few words; 0: there is none.
std::size_t title_length(const std::string& line)
{
    constexpr std::size_t kLongest = 24;
    const std::size_t colon = line.find(':');
    const bool is_title = colon != std::string::npos && colon > 1 && colon < kLongest &&
                          std::isupper(static_cast<unsigned char>(line[0])) &&
                          std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon),
                                      [](unsigned char c) { return std::isalpha(c) || c == ' '; });
    return is_title ? colon : 0;
}

/// Text for people: indented lines as they stand, others as paragraphs. Words before a colon at the margin become titles.
void write_block(std::ostringstream& out, const std::string& text, bool has_titles)
{
    std::istringstream lines(text);
    bool is_open = false;
    for (std::string line; std::getline(lines, line);)
    {
        const bool is_indented = line.starts_with(' ');
        if (is_open != is_indented && (is_open || is_indented)) out << (is_open ? ".fi\n" : ".PP\n.nf\n");
        is_open = is_indented;
        if (line.empty()) continue;
        const std::size_t title = is_indented ? 0 : title_length(line);
        if (title > 0)
        {
            out << (has_titles ? ".SH " + upper(plain(line.substr(0, title))) : ".PP\n" + plain(line.substr(0, title)) + ":") << "\n";
            line.erase(0, line.find_first_not_of(' ', title + 1));
        }
        if (!line.empty()) out << plain(line) << "\n";
    }
    if (is_open) out << ".fi\n";
}

std::string value_of(const OptionOutline& o)
{
    if (!o.words.empty())
    {
        std::string out;
        for (const std::string& word : o.words) out += (out.empty() ? "" : "|") + word;
        return out;
    }
    return o.value.empty() ? "VALUE" : o.value;
}

void write_option(std::ostringstream& out, const OptionOutline& o)
{
    out << ".TP\n";
    std::string names;
    for (const std::string& name : o.names) names += (names.empty() ? "\\fB" : ", \\fB") + plain(name) + "\\fR";
    if (o.names.empty()) names = "\\fI" + plain(o.place) + "\\fR";
    if (!o.names.empty() && o.has_value) names += " \\fI" + plain(value_of(o)) + "\\fR";
    out << names << "\n" << plain(o.help);
    if (!o.fallback.empty()) out << plain(" [" + o.fallback + "]");
    out << "\n";
}

std::string synopsis(const CommandOutline& c)
{
    std::string out;
    for (const OptionOutline& o : c.places)
    {
        std::string word = "\\fI" + plain(upper(o.place)) + "\\fR";
        if (o.most > 1) word += " ...";
        out += o.is_required ? " " + word : " [" + word + "]";
    }
    return out;
}

/// By their groups, in the order in which these come up.
void write_options(std::ostringstream& out, const CommandOutline& c)
{
    std::vector<std::string> groups;
    for (const OptionOutline& o : c.options)
        if (std::find(groups.begin(), groups.end(), o.group) == groups.end()) groups.push_back(o.group);
    for (const OptionOutline& o : c.places) write_option(out, o);
    for (const std::string& group : groups)
    {
        if (groups.size() > 1) out << ".SS " << plain(group) << "\n";
        for (const OptionOutline& o : c.options)
            if (o.group == group) write_option(out, o);
    }
}

}  // namespace

std::string man_page(const CommandOutline& program, const std::string& version, const std::string& more)
{
    std::ostringstream out;
    std::string does = program.help;
    if (does.starts_with(program.name + ": ")) does.erase(0, program.name.size() + 2);
    // No date: what is built twice is the same twice.
    out << ".TH " << upper(plain(program.name)) << " 1 \"\" \"pLab " << plain(version) << "\" \"pLab\"\n";
    out << ".SH NAME\n" << plain(program.name) << " \\- " << plain(does) << "\n";
    out << ".SH SYNOPSIS\n\\fB" << plain(program.name) << "\\fR [\\fIOPTIONS\\fR]" << synopsis(program)
        << (program.commands.empty() ? "" : " \\fICOMMAND\\fR ...") << "\n";
    out << ".SH OPTIONS\n";
    write_options(out, program);
    if (!program.commands.empty()) out << ".SH COMMANDS\n";
    for (const CommandOutline& c : program.commands)
    {
        out << ".SS \\fB" << plain(c.name) << "\\fR" << synopsis(c) << "\n" << plain(c.help) << "\n";
        CommandOutline own = c;
        std::erase_if(own.options, [](const OptionOutline& o) { return o.names.back() == "--help"; });
        for (OptionOutline& o : own.options) o.group.clear();
        write_options(out, own);
        write_block(out, c.footer, false);
    }
    write_block(out, program.footer + "\n" + more, true);
    return out.str();
}

}  // namespace plab::program
