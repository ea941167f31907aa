/// One run of one scene and all that a study wants to know about it: in this process, on the calling thread.
///
///   record_run   steps once and notes everything: courses of quantities, energy, events, outputs, allocations, hash
///   time_run     steps once and notes nothing but CPU time
///
/// Neither fails: a scene that is refused, a run that blows up or is too slow is a record that says so.
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
