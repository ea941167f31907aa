/// What a recording contains and what a recovery saved, for people and as JSON.
#pragma once

#include "control/console/console.h"
#include "control/console/json.h"
#include "control/recording/analysis/summary.h"
#include "idl/recording/recovery.h"

namespace plab::cli
{

void print_summary(const Console& console, const analysis::Summary& summary);
Json summary_json(const analysis::Summary& summary);

/// `out`: the file that was written.
void print_recovery(const Console& console, const recording::RecoveryReport& report, const std::string& out);
Json recovery_json(const recording::RecoveryReport& report, const std::string& out);

}  // namespace plab::cli
