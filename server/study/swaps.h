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

/// As it was asked for. A time holds for runs of every step length, and for those that a reference is made of.
struct PlannedSwap
{
    std::string text;          ///< as written
    std::optional<Tick> step;  ///< before this step of the runs, which must then have one step length
    double time = 0;           ///< s; of a step: known after settle_times()
    std::string id;
    std::string type;  ///< without "/": one of the kind that the component has then
};

/// "0.5s:solver=StoermerVerlet" (a time has a unit), "120:contact.response=Response/None" (a step has none).
Result<PlannedSwap> parse_swap(const std::string& text);

/// Turns steps into times and puts the swaps in their order. Refused: a step where the runs have several step lengths, a time
/// at which a run has no step, and what comes at `until` (s) or later.
Result<void> settle_times(std::vector<PlannedSwap>& swaps, const std::vector<model::StepLength>& lengths, double until);

/// What a run of `scene` makes of settled swaps, one after the other: ids, types and what they can be exchanged for are checked.
Result<std::vector<SwapAt>> swaps_of(const std::vector<PlannedSwap>& settled, const model::SceneSpec& scene, model::TypeSource& types);

}  // namespace plab::study
