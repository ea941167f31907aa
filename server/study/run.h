/// One run of one scene and all that a study wants to know about it: in this process, on the calling thread.
///
///   record_run   steps once and records everything: time series of quantities, energy, events, outputs, allocations, hash
///   time_run     steps once and records only CPU time
///
/// Neither fails: a scene that is refused, or a run that diverges or is too slow, gives a record with that outcome.
#pragma once

#include "model/type_registry.h"
#include "study/run_record.h"

namespace plab::study
{

RunRecord record_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options);
Timing time_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options);

/// Estimated cost of a whole run, s of CPU time, from its first steps: 5 ms of them, at least two. Later changes in the scene
/// and the cost of observing it are not included. A scene that does not load costs nothing.
double seconds_of_a_run(model::TypeSource& types, const model::SceneSpec& scene, const RunOptions& options);

/// CPU time of the calling thread, s (CLOCK_THREAD_CPUTIME_ID).
double thread_cpu_seconds();

}  // namespace plab::study
