/// The step on one page. This list is what runs, what --explain prints, and what tests look at: nobody writes it again.
///
///   requests    due requests take effect (Simulation): rows are born and die only there
///   PreStep     save_start, drive, couple_speeds
///   Step        advance_all: speeds that joints do not allow; per solver stage clear, forces(t, state), rows(t, state), couplings, rates
///   PostStep    locate_events: detect, find the first event, rewind who is touched, advance to it, respond, go on
///               finish_contacts, finish, draw
///   publish     whoever watches sees a const world
#pragma once

#include <span>
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
