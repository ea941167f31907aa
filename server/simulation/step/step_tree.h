/// The step on one page. This list is what runs, what --explain prints, and what tests look at: nobody writes it again.
///
/// Around it stands the run: requests that are due take effect before it, since rows are born and die only there; whoever publishes sees
/// a const world after it.
#pragma once

#include <string_view>

#include "simulation/step/stepper.h"

namespace plab::simulation
{

struct StepNode
{
    Stage stage;
    std::string_view name;
    std::string_view what;
    bool (Stepper::*needed)() const;  ///< a node that a scene does not need is not run
    void (Stepper::*run)();
};

inline constexpr StepNode kStepTree[] = {
    {Stage::PreStep, "save_start", "remember where the step begins", &Stepper::anything_moves, &Stepper::save_start},
    {Stage::PreStep, "drive", "scripts' drive(step); the parameter changes that they ask for", &Stepper::anything_drives, &Stepper::drive},
    {Stage::PreStep, "couple_speeds", "bring the speeds of coupled shafts together", &Stepper::anything_couples, &Stepper::couple_speeds},
    {Stage::Step, "advance", "each group by its solver over the whole step", &Stepper::anything_moves, &Stepper::advance_all},
    {Stage::PostStep, "locate", "find events inside the step; rewind, respond, go on", &Stepper::anything_collides,
     &Stepper::locate_events},
    {Stage::PostStep, "contacts", "contacts that begin, persist and end", &Stepper::anything_collides, &Stepper::finish_contacts},
    {Stage::PostStep, "finish", "outputs and history", &Stepper::anything_finishes, &Stepper::finish},
    {Stage::PostStep, "draw", "cameras of the scene, where somebody takes their pictures", &Stepper::anything_draws, &Stepper::draw},
};

}  // namespace plab::simulation
