/// Reads a program's command line with its parser: the same answers to shells, --help, --version and wrong usage in every program.
#pragma once

#include <optional>
#include <string>

#include "program/completion.h"

namespace CLI
{
class App;
}  // namespace CLI

namespace plab::program
{

/// What the parser understands. Options that the help does not show are left out.
CommandOutline outline_of(const CLI::App& app);

/// As that of completion.h, for a program with a parser.
std::optional<std::string> answer_for_shell(const CLI::App& app, int argc, const char* const* argv, const std::string& version,
                                            const ValueSource& values = {}, const std::string& more = {});

/// What to print instead of running, and the exit code: 0 after --help, --version and what shells ask for, 2 for wrong usage.
struct ParseEnd
{
    int exit_code = 0;
    std::string text;
};

/// Empty: the variables to which the parser's options are bound are set.
std::optional<ParseEnd> parse_command_line(CLI::App& app, int argc, const char* const* argv, const std::string& version,
                                           const ValueSource& values);

}  // namespace plab::program
