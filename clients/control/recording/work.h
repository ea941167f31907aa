/// What the commands on recordings share: their arguments, and long work that shows how far it is, and ends at Ctrl-C.
///
///   Work work(context, "export run.mcap");
///   auto log = Log::open("run.mcap", work.watch());
///   ...
///   if (context.stopped()) return work.interrupted("tables.csv is not written");
#pragma once

#include "control/command/context.h"
#include "control/recording/analysis/log.h"
#include "idl/recording/source.h"
#include "program/progress.h"

namespace plab::cli
{

class Work
{
public:
    /// `streams`: it prints while it reads, so that a progress line on a terminal would get in between.
    Work(const Context& context, std::string what, bool streams = false);

    /// For the code that reads a recording; the work must outlive it.
    recording::Watch watch();
    /// Call before anything is printed.
    void end() { progress_.clear(); }
    /// Reports how far it got and what that means; returns Exit::Interrupted.
    Exit interrupted(const std::string& consequence);

private:
    const Context* context_;
    program::Progress progress_;
    std::string what_;
    double share_ = 0;
    int pass_ = 1;  ///< number of the pass over the file: some work reads it more than once
};

void add_file(const Command& command, std::string& file);
/// --from and --to.
void add_span(const Command& command, analysis::Span& span);
/// Reports what could not be read. Failed if there is anything: the result is incomplete.
Exit warn(const Context& context, const analysis::Troubles& troubles);

}  // namespace plab::cli
