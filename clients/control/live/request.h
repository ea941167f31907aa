/// Sends a request and prints the result.
#pragma once

#include "control/command/context.h"
#include "link/caller.h"

namespace plab::cli
{

/// --at and --revision, which every request accepts.
struct Timing
{
    std::optional<std::int64_t> at;
    std::optional<std::uint64_t> revision;
};
void add_timing(const Command& command, Timing& timing);

/// Connects unless `context` is connected, sends, waits for the reply and prints it.
Exit send(Context& context, std::vector<link::Operation> operations, const Timing& timing = {});

/// The reply for people: what was done and when; for a swap, everything that the server reports.
void print_reply(const Console& console, const std::vector<link::Operation>& operations, const link::Reply& reply);

/// A file, or standard input for "-"; at most as large as a request may be.
Result<std::string> read_text(const std::string& file);

}  // namespace plab::cli
