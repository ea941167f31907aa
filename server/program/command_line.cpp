#include "program/command_line.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace plab::program
{

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
