/// The step on one page: its nodes in the order in which they run. This list is what Stepper::step runs, what --explain prints, and what
/// tests check; it is written nowhere else.
///
/// Requests that are due take effect before it, as components are created and removed only between steps. Publishers get a const world
/// after it.
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
    bool (Stepper::*needed)() const;  ///< a node is skipped if the scene does not need it
    void (Stepper::*run)();
};

inline constexpr StepNode kStepTree[] = {
    {Stage::PreStep, "save_start", "save the state at the start of the step", &Stepper::anything_moves, &Stepper::save_start},
    {Stage::PreStep, "drive", "scripts' drive(step), then the parameter changes that they request", &Stepper::anything_drives,
     &Stepper::drive},
    {Stage::PreStep, "couple_speeds", "make the speeds of coupled shafts consistent", &Stepper::anything_couples, &Stepper::couple_speeds},
    {Stage::Step, "advance", "advance each group by its solver over the whole step", &Stepper::anything_moves, &Stepper::advance_all},
    {Stage::PostStep, "locate", "locate events inside the step: rewind, respond, advance again", &Stepper::anything_collides,
     &Stepper::locate_events},
    {Stage::PostStep, "contacts", "update contacts that begin, persist and end", &Stepper::anything_collides, &Stepper::finish_contacts},
    {Stage::PostStep, "finish", "compute outputs and history", &Stepper::anything_finishes, &Stepper::finish},
    {Stage::PostStep, "draw", "render the cameras of the scene whose pictures are used", &Stepper::anything_draws, &Stepper::draw},
};

}  // namespace plab::simulation
