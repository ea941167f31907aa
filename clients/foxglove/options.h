/// The command line of plab-foxglove.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "link/session.h"
#include "program/command_line.h"

namespace plab::foxglove
{

inline constexpr int kUsualPort = 8765;  ///< where Foxglove and Lichtblick look first

struct FoxgloveOptions
{
    link::SessionOptions link;
    std::string address = "127.0.0.1";  ///< on which it listens
    int port = kUsualPort;              ///< 0: any that is free
    std::vector<std::string> hosts;     ///< more names by which clients reach it
    std::vector<std::string> origins;   ///< more pages that may connect
    bool token = false;                 ///< the address has one; always so beyond this machine
    bool read_only = false;
    std::string file;          ///< a recording to play, instead of a server; empty: none
    std::string address_file;  ///< where the address is written too; empty: nowhere
};

/// Empty: `options` is filled.
std::optional<program::ParseEnd> parse_options(int argc, const char* const* argv, FoxgloveOptions& options);

}  // namespace plab::foxglove
