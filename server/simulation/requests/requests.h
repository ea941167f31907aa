/// The requests that can be made to a running scene, and their replies. The bus transmits the same contents.
///
/// Requests hold names and values only, and what a request does not name stays unchanged. The operations of one request form a
/// transaction: either all of them take effect at one step boundary, or none does.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "model/blueprint.h"
#include "model/scene.h"
#include "plab/context.h"
#include "simulation/costs/spread.h"
#include "world/shared.h"

namespace plab::simulation
{

/// A value, or a text that is parsed by the field's own rules (units allowed).
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
/// What a blueprint adds to a scene, compiled in advance: on any thread, for a scene that may have changed by the time it is used.
struct PreparedAddition
{
    std::weak_ptr<const model::SceneSpec> present;  ///< the scene for which it was compiled
    /// The present scene followed by what is added; or why it cannot be added.
    Result<world::Shared<model::SceneSpec>> whole = Error{};

    /// Whether `scene` is still the one for which it was compiled. A scene that was lent never changes; a changed one has another address.
    bool fits(const model::SceneSpec& scene) const { return present.lock().get() == &scene; }
};

/// Adds the components of a blueprint. It may refer to components that exist when the request takes effect: if nothing fitting was
/// prepared, it is compiled then.
struct AddBlueprintOperation
{
    explicit AddBlueprintOperation(model::Blueprint of) : blueprint(std::make_shared<const model::Blueprint>(std::move(of))) {}

    std::shared_ptr<const model::Blueprint> blueprint;  ///< shared with copies of the request: the history, snapshots
    std::shared_ptr<const PreparedAddition> prepared;   ///< null: nothing
};
/// Removes a component, or an object with everything inside it. Refused while other components refer to it.
struct RemoveOperation
{
    std::string id;
};
/// Replaces a component by one of another type of its family; `values` are parameters of the new one.
struct SwapOperation
{
    std::string id;  ///< may contain * and ?: then all components of the type's family whose ids match, as they are before the request
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
/// Makes this many steps although the simulation is paused, then pauses again.
struct StepOperation
{
    std::int64_t steps = 1;
};
/// Target real-time factor; 0: as fast as possible.
struct RateOperation
{
    double factor = 1;
};
/// Returns to the scene as it was loaded; a new run begins.
struct ResetOperation
{
};
struct LoadOperation
{
    model::SceneSpec scene;
};
/// Sets the step length, beginning with the next step.
struct StepLengthOperation
{
    model::StepLength dt;
};
/// Keeps the present state as a snapshot under a name, replacing an earlier snapshot of that name.
struct SnapshotOperation
{
    std::string name;
};
/// Continues from a named snapshot; a new run begins. Pause and rate stay as they are.
struct RestoreOperation
{
    std::string name;
};
/// Deletes a named snapshot.
struct ForgetOperation
{
    std::string name;
};
/// Returns to an earlier time of this run. A new run begins there, and requests made at that time or later are dropped.
struct RewindOperation
{
    double time = 0;    ///< s
    bool back = false;  ///< `time` is measured backwards from the present
};

using Operation = std::variant<AddOperation, AddBlueprintOperation, RemoveOperation, SwapOperation, SetOperation, PushOperation,
                               PauseOperation, ResumeOperation, StepOperation, RateOperation, ResetOperation, LoadOperation,
                               StepLengthOperation, SnapshotOperation, RestoreOperation, ForgetOperation, RewindOperation>;

/// False for operations on the clock or on named snapshots only: pause, rate, snapshot, ...
bool affects_the_run(const Operation& operation);
/// True for reset, load, restore and rewind.
bool begins_a_run(const Operation& operation);

/// How a request is tried before it takes effect: by a trial of its first step.
struct TrialChoice
{
    enum class Budget : std::uint8_t
    {
        Unlimited,
        Automatic,  ///< the larger of 5 ms and ten times the mean cost of a step
        Given,
        None,  ///< no trial
    };
    Budget budget = Budget::Unlimited;
    double ns = 0;               ///< of Budget::Given
    bool must = false;           ///< refuse the request if the trial cannot be completed
    bool everything = false;     ///< step the whole scene instead of what the request can affect, for comparison
    std::size_t most = 0;        ///< objects that a swap is tried on, see TrialReport::sample_of; 0: as many as the budget is for
    double energy_factor = 100;  ///< a swap whose first step multiplies the kinetic energy by more is refused; infinite: no limit

    bool is_wanted() const { return budget != Budget::None; }
};

struct Request
{
    std::uint64_t id = 0;
    std::vector<Operation> operations;
    std::optional<Tick> at;                 ///< takes effect before this step; one that has passed is refused as late
    std::optional<std::uint64_t> revision;  ///< refused if other structural requests were carried out in between
    TrialChoice trial;
    std::string made_by;  ///< id of the component that makes the request; empty: a client
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

/// Energy, momentum and error after the first step with a component, of the objects that the swap can affect. A swap reports them for the
/// old and for the new component. NaN: not tried.
struct StepOutcome
{
    double energy = 0;  ///< J, kinetic and stored, at the end of the step
    Vec3 momentum;      ///< N s
    double error = 0;   ///< largest reported error of the component
    /// Median time of that step over several repetitions; NaN: not given. For the old component it is given only where it differs
    /// significantly from that of the new one (TrialReport has both measurements).
    double cost_ns = 0;
};

struct SwapReport
{
    std::string id, from, to;
    std::vector<TransferredField> fields;
    double energy_before = 0;  ///< J, at the boundary
    StepOutcome with_old, with_new;
};

/// The result of a request's trial.
struct TrialReport
{
    enum class Outcome : std::uint8_t
    {
        None,  ///< not wanted, or the request changes nothing that can be tried
        Made,
        WithoutOld,  ///< the old component's step took too long, so only the new one was tried
        GivenUp,     ///< it took longer than its budget
    };
    Outcome outcome = Outcome::None;
    double ns = 0, budget_ns = 0;  ///< the budget is infinite if there is no limit
    std::size_t objects = 0;       ///< number of bodies, shafts and quantities in the trial step
    bool everything = false;       ///< these are all objects of the scene
    /// These are a sample of the objects on which the request acts; 0: no sample. `held`: what touches the sample was held still.
    std::size_t sample_of = 0;
    bool held = false;
    Spread with_old, with_new;  ///< ns, of repeated trial steps of a swap, with warm caches; no samples: not measured
};

/// Changes that requests made to the structure and to parameters, for observers that keep a copy of the catalogue.
struct Changes
{
    bool everything = false;             ///< a new run
    std::vector<std::string> touched;    ///< ids that were added, removed or changed; may contain duplicates
    std::set<std::uint32_t> by_scripts;  ///< components whose parameters scripts set, or whose inputs were set, possibly in each step

    bool any() const { return everything || !touched.empty() || !by_scripts.empty(); }
};

struct Reply
{
    std::uint64_t request = 0;
    bool done = false;
    bool late = false;           ///< refused: the named step has passed
    Errors errors;               ///< why it was refused; then nothing has changed
    Tick step = 0;               ///< boundary at which it took effect
    double pause_ns = 0;         ///< how long the step loop was stopped for it
    std::uint64_t revision = 0;  ///< afterwards
    std::vector<SwapReport> swaps;
    TrialReport trial;
    /// Of a request that the simulation made itself: it is in no client's name. Null: a client, or the command line, asked.
    std::shared_ptr<const Request> made;
    /// The component that decided it; a replay decides the same again. "": a measurement, which a replay takes from the recording.
    std::string decided_by;
};

}  // namespace plab::simulation
