/// The command line of plab-log.
#pragma once

#include <optional>
#include <string>

#include "link/session.h"

namespace plab::logger
{

enum class Severity : unsigned char
{
    Info,
    Warning,
    Failure,
};
/// Words that are none of the three count as failures: what is not understood is better seen.
Severity severity_of(std::string_view word);

struct Options
{
    link::Options link;
    double timeout = 5;  ///< s to wait for the server at the start; 0: as long as it takes
    std::string out;     ///< file to append to; empty: standard output
    bool json = false;
    bool metrics = false, status = false;
    std::string kind;  ///< beginning of the kinds that are logged, "collision.impact", "script."
    Severity severity = Severity::Info;
    std::optional<std::uint64_t> count;  ///< end after so many entries
    std::optional<double> duration;      ///< end after so many s
};

/// What to print instead of running, and the exit code: 0 after --help and --version, 2 for a wrong use.
struct ParseEnd
{
    int exit_code = 0;
    std::string text;
};
std::optional<ParseEnd> parse_options(int argc, const char* const* argv, Options& options);

}  // namespace plab::logger
