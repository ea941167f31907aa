/// The options of plab-log, and its command line.
#pragma once

#include <optional>
#include <string>

#include "link/session.h"
#include "logger/filter.h"

namespace plab::program
{
struct ParseEnd;
}  // namespace plab::program

namespace plab::logger
{

struct LoggerOptions
{
    link::SessionOptions link;
    double timeout = 5;  ///< s to wait for the server at the start; 0: without limit
    std::string out;     ///< file to append to; empty: standard output
    bool json = false;
    bool metrics = false, status = false;
    Filter filter;
    std::optional<std::uint64_t> count;  ///< end after this many entries
    std::optional<double> duration;      ///< end after this time, s
};

/// What to print instead of running, and the exit code: 0 after --help and --version, 2 for wrong usage.
std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, LoggerOptions& options);

}  // namespace plab::logger
