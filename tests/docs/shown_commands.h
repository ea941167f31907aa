/// The commands that a document shows, with what it says that they print.
#pragma once

#include <string>
#include <vector>

namespace plab::test
{

struct ShownCommand
{
    std::string text;                 ///< one line; continued lines are joined
    std::vector<std::string> output;  ///< lines shown below it
};

/// What stands together: one block of code, or one cell of a table.
struct ShownBlock
{
    std::string where;  ///< "README.md:54"
    std::vector<ShownCommand> commands;
};

/// Blocks of code in which something is typed: those with lines that begin with "$ " (all others are output), and those that begin with
/// the name of a program (every line is a command, indented ones continue the line before). And the cells of tables below the head
/// "example" that are one piece of code. Other blocks (XML, C++, what a program prints) have no commands.
std::vector<ShownBlock> shown_commands(const std::string& text, const std::string& name);

}  // namespace plab::test
