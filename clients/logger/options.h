/// What plab-log is asked for, and its command line.
#pragma once

#include <optional>
#include <string>

#include "link/session.h"
#include "logger/filter.h"

namespace plab::logger
{

struct LoggerOptions
{
    link::LoggerOptions link;
    double timeout = 5;  ///< s to wait for the server at the start; 0: as long as it takes
    std::string out;     ///< file to append to; empty: standard output
    bool json = false;
    bool metrics = false, status = false;
    Filter filter;
    std::optional<std::uint64_t> count;  ///< end after so many entries
    std::optional<double> duration;      ///< end after so many s
};

/// What to print instead of running, and the exit code: 0 after --help and --version, 2 for a wrong use.
struct ParseEnd
{
    int exit_code = 0;
    std::string text;
};
std::optional<ParseEnd> parse_options(int argc, const char* const* argv, LoggerOptions& options);

}  // namespace plab::logger
