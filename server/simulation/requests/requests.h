/// What can be asked of a running scene, and what is answered. The bus carries the same.
///
/// Names and values only: what a request does not name stays as it is. The operations of one request are one
/// transaction: all of them take effect at one step boundary, or none does.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "model/blueprint.h"
#include "model/scene.h"
#include "plab/context.h"
#include "simulation/costs/spread.h"

namespace plab::simulation
{

/// A value as text (parsed by the field's own rules, units allowed) or as it is.
using GivenValue = std::variant<std::string, Value>;

struct NamedValue
{
    std::string name;
    GivenValue value;
};

/// Adds compiled components; their ids must be new.
struct AddOperation
{
    model::SceneSpec fragment;
};
/// Adds what a blueprint means when the request takes effect: it may refer to what is there then.
struct AddBlueprintOperation
{
    model::Blueprint blueprint;
};
/// Removes a component, or an object with all that is in it. Refused while others refer to it.
struct RemoveOperation
{
    std::string id;
};
/// Exchanges a component for another type of its family; `values` are parameters of the new one.
struct SwapOperation
{
    std::string id;  ///< with * and ?: all of the type's family whose ids match, as they are before the request
    std::string type;
    std::vector<NamedValue> values;
};
/// Sets one parameter or state.
struct SetOperation
{
    std::string id;
    std::string name;
    GivenValue value;
};
/// An impulse: N s at a point in W (default: centre of mass) for a body; x in N m s about its axle for a shaft.
struct PushOperation
{
    std::string id;
    Vec3 impulse;
    std::optional<Vec3> point;
};
struct PauseOperation
{
};
struct ResumeOperation
{
};
/// Makes that many steps although paused, then pauses.
struct StepOperation
{
    std::int64_t steps = 1;
};
/// Real-time factor that the clock aims at; 0: as fast as it goes.
struct RateOperation
{
    double factor = 1;
};
/// Back to the scene as it was loaded; a new run begins.
struct ResetOperation
{
};
struct LoadOperation
{
    model::SceneSpec scene;
};
/// A new step length from this step on.
struct StepLengthOperation
{
    model::StepLength dt;
};
/// Keeps the state at the boundary under a name; one that was kept under it before is replaced.
struct SnapshotOperation
{
    std::string name;
};
/// Goes on from a snapshot that was kept; a new run begins. Pause and rate stay as they are.
struct RestoreOperation
{
    std::string name;
};
/// Gives up a snapshot that was kept.
struct ForgetOperation
{
    std::string name;
};
/// Back to a time of this run; a new run begins there, and what was asked at that time or later is forgotten.
struct RewindOperation
{
    double time = 0;    ///< s
    bool back = false;  ///< `time` counts back from the present
};

using Operation = std::variant<AddOperation, AddBlueprintOperation, RemoveOperation, SwapOperation, SetOperation, PushOperation,
                               PauseOperation, ResumeOperation, StepOperation, RateOperation, ResetOperation, LoadOperation,
                               StepLengthOperation, SnapshotOperation, RestoreOperation, ForgetOperation, RewindOperation>;

/// False for what only concerns the clock, or what is kept: pause, rate, snapshot, ...
bool affects_the_run(const Operation& operation);
/// reset, load, restore, rewind.
bool begins_a_run(const Operation& operation);

/// How a request is proved before it takes effect: by a trial of its first step.
struct TrialChoice
{
    enum class Budget : std::uint8_t
    {
        Unlimited,
        Automatic,  ///< the larger of ten steps' mean cost and 5 ms
        Given,
        None,  ///< no trial
    };
    Budget budget = Budget::Unlimited;
    double ns = 0;               ///< of Budget::Given
    bool must = false;           ///< without the proof it is refused
    double energy_factor = 100;  ///< a swap whose first step multiplies the energy by more is refused; infinite: none is

    bool is_wanted() const { return budget != Budget::None; }
};

struct Request
{
    std::uint64_t id = 0;
    std::vector<Operation> operations;
    std::optional<Tick> at;                 ///< takes effect before this step; one that has passed is refused as late
    std::optional<std::uint64_t> revision;  ///< refused if structural requests came between
    TrialChoice trial;
};

bool affects_the_run(const Request& request);

enum class FieldTransfer : std::uint8_t
{
    Kept,       ///< carried over, same bits
    Converted,  ///< carried over in another type
    Given,      ///< by the request
    Fresh,      ///< the new type's default
    Lost,       ///< the new type has no such field
};

struct TransferredField
{
    std::string field;
    FieldTransfer transfer = FieldTransfer::Kept;
};

/// Energy, momentum and error over the first step after a swap, beside what the old component would have given; of those whom the swap can
/// touch. NaN: not tried.
struct StepOutcome
{
    double energy = 0;  ///< J, kinetic and stored, at the end of the step
    Vec3 momentum;      ///< N s
    double error = 0;   ///< largest reported error of the component
    /// Median of their step, made again and again; NaN: not told. The old one's is told only where it differs from the new one's by more
    /// than chance (TrialReport has what was measured of both).
    double cost_ns = 0;
};

struct SwapReport
{
    std::string id, from, to;
    std::vector<TransferredField> fields;
    double energy_before = 0;  ///< J, at the boundary
    StepOutcome with_old, with_new;
};

/// What became of a request's trial.
struct TrialReport
{
    enum class Outcome : std::uint8_t
    {
        None,  ///< not wanted, or the request changes nothing that could be tried
        Made,
        WithoutOld,  ///< the old component's step took too long: only the new one was tried
        GivenUp,     ///< it took longer than its budget
    };
    Outcome outcome = Outcome::None;
    double ns = 0, budget_ns = 0;  ///< the budget is infinite where there is none
    std::size_t objects = 0;       ///< bodies, shafts and quantities that it stepped
    bool everything = false;       ///< and they are all that there are
    Spread with_old, with_new;     ///< ns, of its step in a swap: of repeats, caches warm; no samples: not measured
};

/// What requests did to the structure and to parameters, for those who keep a copy of the catalogue.
struct Changes
{
    bool everything = false;             ///< a new run
    std::vector<std::string> touched;    ///< ids that came, went or changed; may repeat
    std::set<std::uint32_t> by_scripts;  ///< components whose parameters scripts set; perhaps at each step

    bool any() const { return everything || !touched.empty() || !by_scripts.empty(); }
};

struct Reply
{
    std::uint64_t request = 0;
    bool done = false;
    bool late = false;           ///< refused: the named step has passed
    Errors errors;               ///< why it was refused; nothing has changed then
    Tick step = 0;               ///< boundary at which it took effect
    double pause_ns = 0;         ///< how long it held the loop up
    std::uint64_t revision = 0;  ///< afterwards
    std::vector<SwapReport> swaps;
    TrialReport trial;
};

}  // namespace plab::simulation
