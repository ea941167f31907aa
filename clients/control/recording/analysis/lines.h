/// Events and collisions of a recording as the lines that plab-log writes.
#pragma once

#include "control/recording/analysis/log.h"
#include "logger/filter.h"
#include "program/text_out.h"

namespace plab::analysis
{

struct LineOptions
{
    logger::Filter filter = {};
    bool json = false;
    std::optional<std::uint64_t> count = {};  ///< end after this many entries
    Span span = {};
};

/// An error: a kind or an object that does not occur in the whole recording.
Result<void> check_names(const Log& log, const logger::Filter& filter);

/// In order of time, with a line for each new run, and for missing entries.
Result<Troubles> write_lines(const Log& log, const LineOptions& options, program::TextOut& out);

}  // namespace plab::analysis
