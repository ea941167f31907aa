#include "docs/shown_commands.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace plab::test
{
namespace
{

constexpr std::string_view kFence = "```";

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::string trimmed(const std::string& text)
{
    const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

/// "plabctl servers", "build/bin/plabd ..", "DOCKER_HOST=.. docker-compose up".
bool is_typed(const std::string& line)
{
    constexpr std::string_view kPrograms[] = {"build/",       "server/", "tests/", "plabctl ", "plabd ", "plab-", "docker ", "podman ",
                                              "DOCKER_HOST=", "cmake ",  "ctest ", "idlc ",    "cc ",    "git ",  "./"};
    return std::any_of(std::begin(kPrograms), std::end(kPrograms), [&](std::string_view p) { return line.starts_with(p); });
}

/// `more` goes on the command of the line before.
void append(std::string& command, const std::string& more)
{
    if (command.ends_with('\\')) command.pop_back();
    command += " " + trimmed(more);
}

ShownBlock block_of(const std::vector<std::string>& lines, std::string where)
{
    ShownBlock out;
    out.where = std::move(where);
    const bool is_session = std::any_of(lines.begin(), lines.end(), [](const std::string& l) { return l.starts_with("$ "); });
    if (!is_session && (lines.empty() || !is_typed(lines.front()))) return out;
    for (const std::string& line : lines)
    {
        if (trimmed(line).empty()) continue;
        const bool goes_on = !out.commands.empty() && (is_session ? out.commands.back().text.ends_with('\\') : line.starts_with(' '));
        if (goes_on)
            append(out.commands.back().text, line);
        else if (!is_session)
            out.commands.push_back({line, {}});
        else if (line.starts_with("$ "))
            out.commands.push_back({line.substr(2), {}});
        else if (!out.commands.empty())
            out.commands.back().output.push_back(line);
    }
    return out;
}

std::vector<std::string> cells_of(const std::string& row)
{
    std::vector<std::string> out;
    std::string cell;
    for (std::size_t i = 1; i < row.size(); ++i)
    {
        const bool is_bar = row[i] == '|' && row[i - 1] != '\\';
        if (is_bar)
            out.push_back(trimmed(cell)), cell.clear();
        else
            cell += row[i];
    }
    return out;
}

/// The first piece of code in a cell: "`plabctl rate 0.1`; without a value: .." is "plabctl rate 0.1".
std::string code_in(const std::string& cell)
{
    if (!cell.starts_with('`')) return {};
    return cell.substr(1, cell.find('`', 1) - 1);
}

/// Tables with a head "example".
void add_table(const std::vector<std::string>& lines, std::size_t head, const std::string& name, std::vector<ShownBlock>& out)
{
    const std::vector<std::string> names = cells_of(lines[head]);
    const auto found = std::find(names.begin(), names.end(), "example");
    if (found == names.end()) return;
    const auto column = static_cast<std::size_t>(found - names.begin());
    for (std::size_t i = head + 2; i < lines.size() && lines[i].starts_with('|'); ++i)
    {
        const std::vector<std::string> cells = cells_of(lines[i]);
        const std::string code = column < cells.size() ? code_in(cells[column]) : "";
        if (is_typed(code)) out.push_back({name + ":" + std::to_string(i + 1), {{code, {}}}});
    }
}

}  // namespace

std::vector<ShownBlock> shown_commands(const std::string& text, const std::string& name)
{
    std::vector<ShownBlock> out;
    const std::vector<std::string> lines = lines_of(text);
    for (std::size_t i = 0; i < lines.size(); ++i)
    {
        const bool is_head = lines[i].starts_with('|') && (i == 0 || !lines[i - 1].starts_with('|'));
        if (is_head) add_table(lines, i, name, out);
        const std::size_t indent = lines[i].find_first_not_of(' ');
        if (indent == std::string::npos || lines[i].compare(indent, kFence.size(), kFence) != 0) continue;
        std::vector<std::string> inside;
        const std::size_t begin = i + 1;
        for (++i; i < lines.size() && lines[i].compare(std::min(indent, lines[i].size()), kFence.size(), kFence) != 0; ++i)
            inside.push_back(lines[i].size() > indent ? lines[i].substr(indent) : "");
        ShownBlock block = block_of(inside, name + ":" + std::to_string(begin));
        if (!block.commands.empty()) out.push_back(std::move(block));
    }
    return out;
}

}  // namespace plab::test
