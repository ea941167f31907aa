/// plab-log without its command line; `plabctl log` uses it too.
#pragma once

#include "logger/options.h"

namespace plab::logger
{

/// How it ended: 0, 1 (cannot write, no bus), 3 (no server), and why.
struct End
{
    int code = 0;
    Errors errors;
};

/// Joins, finds the server and writes its lines until `interrupted`, or until the number of entries or the time of `options` is
/// reached.
End follow(const LoggerOptions& options, const link::Stop& interrupted);

}  // namespace plab::logger
