/// The command line of plab-web.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link/session.h"
#include "program/command_line.h"

namespace plab::web
{

struct WebOptions
{
    link::SessionOptions link;
    std::string address = "127.0.0.1";  ///< on which it listens
    int port = 0;                       ///< 0: any that is free
    std::vector<std::string> hosts;     ///< more names by which browsers reach it
    std::string page;                   ///< folder of the page; empty: the one that was built
    std::string address_file;           ///< where the page's address is written too; empty: nowhere
    std::string recordings;             ///< folder of recordings that pages make; empty: they make none
    double recordings_limit = 1000;     ///< MB, of all of them
};

/// Empty: `options` is filled.
std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, WebOptions& options);

}  // namespace plab::web
