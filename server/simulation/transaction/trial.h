/// One step of a part of the scene that is made and undone again: the measurement on which swaps are judged.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "simulation/requests/requests.h"
#include "simulation/transaction/trial_memento.h"

namespace plab::simulation
{

struct ObjectMotion;
/// Whether the steps that a trial has made are enough: the motion after each of them.
using CourseEnd = std::function<bool(const std::vector<std::vector<ObjectMotion>>&)>;

/// A step at a boundary, as Simulation would make it next.
struct TrialStep
{
    Tick tick = 0;
    double start = 0, h = 0;         ///< s
    int count = 1;                   ///< steps in a row; objects that others touch before the last one are not noticed
    bool course = false;             ///< also the motion after each of them
    bool energies = false;           ///< also the energy after each of them
    const CourseEnd* end = nullptr;  ///< of a trial with `course`; null: all steps are made
    std::uint64_t measure_ns = 0;    ///< time for which the first step is repeated after the trial, in place of a time until which
    bool derives = false;  ///< the scene's stepper has not been rebuilt for the present structure: the trial's own one derives from it
    bool looked = false;   ///< all detectors have looked at all bodies where these are now
};

/// How a body or a shaft moves at the end of a trial.
struct ObjectMotion
{
    Ref object;
    Vec3 position, velocity, angular_velocity;  ///< of a body: W, m, m/s, rad/s
    Quat orientation;
    double radius = 0;            ///< m, of a body
    double angle = 0, speed = 0;  ///< of a shaft: rad, rad/s
};

struct TrialResult
{
    bool given_up = false;
    std::string failure;                            ///< "" or the first event of severity Failure
    double before = 0;                              ///< J, kinetic and stored energy of the objects in the scope at the start of the step
    double moving = 0;                              ///< J, kinetic energy at that time, including prescribed objects
    double kinetic_after = 0;                       ///< J, at the end of the step
    double least = 0;                               ///< J: kinetic energy below which no motion is noticeable within one step
    StepOutcome outcome;                            ///< of the objects in the scope; without error and cost
    Spread cost;                                    ///< ns, of repeated steps; no samples: not measured
    std::vector<double> errors;                     ///< of the components that were given
    std::vector<ObjectMotion> motion;               ///< of the objects in the scope, bodies first, each in the order of host rows
    std::vector<std::vector<ObjectMotion>> course;  ///< after each step, if that was asked for
    std::vector<double> energies;                   ///< J, kinetic and stored, of the objects in the scope; after each step, if asked for
};

/// A trial uses a stepper of its own for the objects in the scope, starting from the present state of the world. All other objects are
/// fixed meanwhile, and nothing inside the scene's own stepper is touched. Only the objects in the scope, and the components that act on
/// them, are saved and restored. So the cost of a trial depends on the affected part of the scene, apart from a few passes over lists of
/// all components, and the trial cannot change a bit of the run.
class Trial
{
public:
    Trial(world::World& world, const Stepper& stepper, const TrialStep& step);
    /// Makes the step and undoes it. If an object in the scope touches one outside during the step, the scope is extended by it and the
    /// step is made again. `components`: those whose errors are wanted. `until_ns`: until then the step is repeated a limited number of
    /// times to measure its cost (0: no repetition; nor is there one of a sample). The world is left as it was, whatever the result.
    TrialResult run(TrialScope& scope, const std::vector<std::uint32_t>& components, const Interruption& deadline, Progress& progress,
                    std::uint64_t until_ns);

private:
    void set_up(Stepper& part) const;
    void choose_search(Stepper& part);
    void choose_bodies(Stepper& part, const TrialScope& scope);
    void keep_contacts(const TrialScope& scope);
    void keep_cells(const TrialScope& scope);
    void put_back();
    void end_step(Stepper& part);
    void put_back_moved();
    void load_cells();
    void prepare_again();
    bool grow(TrialScope& scope, const Stepper& part) const;
    std::vector<ObjectMotion> motion_in(const TrialScope& scope) const;
    TrialResult once(Stepper& part, const TrialScope& scope, const std::vector<std::uint32_t>& components, const Interruption& deadline);
    Spread measure(Stepper& part, const Interruption& deadline, std::uint64_t until_ns);
    static void apply_changes(void* self, std::vector<ParameterChange>& changes);

    world::World& world_;
    const Stepper& stepper_;  ///< of the scene
    TrialStep step_;
    TrialMemento host_;
    ContactCache contacts_;            ///< of the scope
    std::vector<std::uint32_t> kept_;  ///< components, in id order
    ByteWriter cells_;                 ///< their values
    std::set<std::uint32_t> prepared_;
    IndexSet moving_;                       ///< dynamic bodies of the scope
    std::uint64_t first_ns_ = 0;            ///< duration of the first step
    Stepper* part_ = nullptr;               ///< the stepper in use during a trial
    const Selection* selection_ = nullptr;  ///< its components
};

}  // namespace plab::simulation
