/// Reads a program's command line with its parser: the same answers to shells, --help, --version and wrong usage in every program.
#pragma once

#include <optional>
#include <string>

#include "program/completion.h"

namespace plab::program
{

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
