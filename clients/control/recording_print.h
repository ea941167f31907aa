/// What plabctl says of recordings, for people and as JSON.
#pragma once

#include "control/console.h"
#include "control/json.h"
#include "control/recordings/diff.h"
#include "control/recordings/summary.h"
#include "idl/recording/recovery.h"

namespace plab::cli
{

void print_summary(const Console& console, const recordings::Summary& summary);
Json json_of(const recordings::Summary& summary);

/// `out`: the file that was written.
void print_recovery(const Console& console, const recording::RecoveryReport& report, const std::string& out);
Json json_of(const recording::RecoveryReport& report, const std::string& out);

void print_difference(const Console& console, const recordings::Difference& difference);
Json json_of(const recordings::Difference& difference);

}  // namespace plab::cli
