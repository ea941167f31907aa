/// The stages of a simulation command (as in the paper), and the phases within them in which commands run.
#pragma once

#include <cstdint>
#include <string_view>

namespace plab
{

enum class Stage : std::uint8_t
{
    Init,
    PreStep,
    Step,
    PostStep,
    Rewind,
    Deinit,
};

/// When the host calls a command. The order is that of the step (server/simulation/step/step_tree.h has the tree).
enum class Phase : std::uint8_t
{
    Measure,    ///< Init: mass properties of a shape
    Prepare,    ///< Init, and after a parameter changed: derive host rows from parameters, check rules across fields
    Connect,    ///< Init, and after any structural change: contribute to structures that are built from all components
    View,       ///< PreStep, before the step: a viewer states from where it looks
    Decide,     ///< PreStep, before the step: what a component asks of the scene, as a client would: other levels of detail, any request
    Drive,      ///< PreStep: once per step; may change its own declared state
    Force,      ///< Step: add wrenches; a pure function of time and state, at every solver stage
    Linearize,  ///< Step: rows that tell how a force of the component changes with position and speed, where joints are held in contact
    Choose,     ///< Step: a resolution that adapts chooses how impacts of this step are found
    Couple,     ///< Step: relate speeds of shafts, at every solver stage and after impulses
    Constrain,  ///< Step: constraint rows at the present state, at every solver stage
    Touch,      ///< Step: force-based contacts add their wrenches, at every solver stage
    Advance,    ///< Step: a solver advances its group
    Solve,      ///< Step: a manager advances an island of one-sided rows and contacts
    Detect,     ///< PostStep: find contacts
    Gap,        ///< PostStep: distance of two bodies
    Locate,     ///< PostStep: choose trial times within a step that contains an event
    Respond,    ///< PostStep: apply impulses to touching bodies
    Finish,     ///< PostStep: outputs and history of a finished step
    Potential,  ///< PostStep: energy stored by a conservative force; called only when energies are read
    Draw,       ///< PostStep: draw; never changes state
    Restore,    ///< Rewind: restore the participants' saved state (done by the host; listed so that scenes can select it)
};
inline constexpr int kPhaseCount = static_cast<int>(Phase::Restore) + 1;

constexpr Stage stage_of(Phase phase)
{
    switch (phase)
    {
        case Phase::Measure:
        case Phase::Prepare:
        case Phase::Connect:
            return Stage::Init;
        case Phase::View:
        case Phase::Decide:
        case Phase::Drive:
            return Stage::PreStep;
        case Phase::Force:
        case Phase::Linearize:
        case Phase::Choose:
        case Phase::Couple:
        case Phase::Constrain:
        case Phase::Touch:
        case Phase::Advance:
        case Phase::Solve:
            return Stage::Step;
        case Phase::Restore:
            return Stage::Rewind;
        default:
            return Stage::PostStep;
    }
}

constexpr std::string_view name_of(Stage stage)
{
    constexpr std::string_view names[] = {"Init", "PreStep", "Step", "PostStep", "Rewind", "Deinit"};
    return names[static_cast<int>(stage)];
}

constexpr std::string_view name_of(Phase phase)
{
    constexpr std::string_view names[] = {"measure", "prepare", "connect",   "view",      "decide",  "drive",  "force",  "linearize",
                                          "choose",  "couple",  "constrain", "touch",     "advance", "solve",  "detect", "gap",
                                          "locate",  "respond", "finish",    "potential", "draw",    "restore"};
    return names[static_cast<int>(phase)];
}

}  // namespace plab
