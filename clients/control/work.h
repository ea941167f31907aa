/// Long work of a command on files: shows how far it is, and ends at Ctrl-C.
///
///   Work work(context, "export run.mcap");
///   auto log = Log::open("run.mcap", work.watch());
///   ...
///   if (context.stopped()) return work.interrupted("tables.csv is not written");
#pragma once

#include "control/context.h"
#include "idl/recording/source.h"
#include "program/progress.h"

namespace plab::cli
{

class Work
{
public:
    /// `streams`: it prints while it reads; on a terminal a line of progress would stand among that.
    Work(const Context& context, std::string what, bool streams = false);

    /// For whatever reads a recording; the work must outlive it.
    recording::Watch watch();
    /// Before anything is printed.
    void end() { progress_.clear(); }
    /// Says how far it came and what that means; Exit::Interrupted.
    Exit interrupted(const std::string& consequence);

private:
    const Context* context_;
    program::Progress progress_;
    std::string what_;
    double share_ = 0;
    int pass_ = 1;  ///< over the file: some work reads it more than once
};

}  // namespace plab::cli
