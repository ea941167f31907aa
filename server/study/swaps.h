/// Swaps that all runs of a study make: `--swap WHEN:ID=TYPE`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"
#include "study/run.h"

namespace plab::study
{

/// As requested. A time is valid for runs of every step length, and for those that make a reference.
struct PlannedSwap
{
    std::string text;          ///< as written
    std::optional<Tick> step;  ///< before this step of the runs, which must then all have the same step length
    double time = 0;           ///< s; of a step: known after settle_times()
    std::string id;
    std::string type;  ///< without "/": one of the kind that the component has at that time
};

/// "0.5s:solver=StoermerVerlet" (a time has a unit), "120:contact.response=Response/None" (a step has none).
Result<PlannedSwap> parse_swap(const std::string& text);

/// Converts steps to times and sorts the swaps. Refused: a step if the runs have several step lengths, a time at which a run
/// has no step, and swaps at `until` (s) or later.
Result<void> settle_times(std::vector<PlannedSwap>& swaps, const std::vector<model::StepLength>& lengths, double until);

/// Checks settled swaps in a run of `scene`, one after the other: ids, types, and whether the types can be exchanged.
Result<std::vector<SwapAt>> swaps_of(const std::vector<PlannedSwap>& settled, const model::SceneSpec& scene, model::TypeSource& types);

}  // namespace plab::study
