/// What a phase function can ask of the host: time, the set of objects being advanced, events.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plab/interruption.h"
#include "plab/ref.h"
#include "plab/value.h"
#include "plab/workers.h"

namespace plab
{

using Tick = std::int64_t;

enum class Severity : std::uint8_t
{
    Info,
    Warning,
    Failure,  ///< the component is quarantined; the rest of the scene continues
};

/// Where two bodies met, and the impulse between them. In W, SI units.
struct EventContact
{
    Vec3 point;        ///< m
    Vec3 normal;       ///< unit, from a to b
    Vec3 impulse;      ///< N s, on b; zero where the kind of event has none
    double depth = 0;  ///< m, of the overlap; < 0: a gap
};

/// Something that happened in a step; events are in order of occurrence.
struct Event
{
    Tick tick = 0;     ///< step in which it happened
    double time = 0;   ///< s, exact within the step
    std::string kind;  ///< "contact.begin", "script.error", ...: words separated by a dot
    Severity severity = Severity::Info;
    std::uint32_t component = kNoIndex;   ///< directory index of the component concerned
    Ref a, b;                             ///< participants, where there are any
    std::string message;                  ///< human-readable; may be empty
    std::optional<EventContact> contact;  ///< of the kinds "contact.begin", "impact", "rest", "release", "paradox"
    std::vector<double> values;           ///< other figures, such as those of a script; a meaning for each kind
};

class EventSink
{
public:
    virtual ~EventSink() = default;
    virtual void emit(Event event) = 0;
};

/// A parameter change requested by a script in the drive phase; the host applies it at the end of that phase.
struct ParameterChange
{
    std::string component;  ///< id
    std::string name;
    Value value;
};

/// The other components of the scene, for commands that keep an id as their state, or that follow the inputs of a participant.
class Lookup
{
public:
    virtual ~Lookup() = default;
    virtual std::string_view id_of(Ref ref) const = 0;
    /// The object or component with this id; not valid if there is none.
    virtual Ref find(std::string_view id) const = 0;
    /// The present value of a field; no value if there is no such field. Inputs and parameters do not change within a step; what another
    /// component changes in the same phase may have changed already or not, by the order of types.
    virtual Value value_of(Ref ref, std::string_view field) const = 0;

    // The components as a whole, for those that look for others by what they are.
    /// Directory indices of all components with a type, in the order of their ids.
    virtual std::span<const std::uint32_t> components() const { return {}; }
    /// Another number whenever components, or parameters that requests set, may have changed.
    virtual std::uint64_t structure() const { return 0; }
    virtual std::string_view id_of(std::uint32_t /*component*/) const { return {}; }
    virtual std::string_view type_of(std::uint32_t /*component*/) const { return {}; }
    virtual Ref ref_of(std::uint32_t /*component*/) const { return {}; }
    virtual std::uint32_t component_of(Ref /*ref*/) const { return kNoIndex; }
    /// Whether there is a component, or a group, with this id.
    virtual bool exists(std::string_view /*id*/) const { return false; }
    /// Whether the text fits one of the patterns, which are separated by blanks: * is any text, ? any character.
    virtual bool matches(std::string_view /*patterns*/, std::string_view /*text*/) const { return false; }
    /// The first participant in a role; not valid if there is none.
    virtual Ref participant(std::uint32_t /*component*/, std::string_view /*role*/) const { return {}; }
};

/// The members of a long list of participants that are being advanced, so that the cost of a field over ten thousand bodies is
/// proportional to the group that is advanced.
struct Shortlist
{
    const RefList* all = nullptr;
    RefList active;
};

/// Time and scope of one call. `time` is that of the solver's stage.
struct StepContext
{
    double time = 0;  ///< s
    double dt = 0;    ///< s, length of the step (or of the part that is advanced)
    Tick tick = 0;
    std::uint64_t seed = 0;
    EventSink* events = nullptr;
    std::vector<ParameterChange>* changes = nullptr;  ///< drive phase only
    const Interruption* interruption = nullptr;       ///< long computations should check interrupted() now and then
    Workers* workers = nullptr;                       ///< null: the call has its own thread alone
    const Lookup* lookup = nullptr;                   ///< phases Drive, Decide and Finish only

    std::span<const std::uint32_t> component_of_row;  ///< directory index of each row of this table
    std::span<const std::uint32_t> facet_of_row;      ///< host table index of each row, where the type has a facet
    std::span<const std::uint8_t> active_bodies;      ///< empty: all
    std::span<const std::uint8_t> active_shafts;

    std::span<const Shortlist> shortlists;  ///< by address of `all`

    /// The participants in a list (a column's cell), or only those that may be active, in the same order.
    std::span<const Ref> among(const RefList& all) const
    {
        const auto before = [](const Shortlist& s, const RefList* list) { return std::less<>()(s.all, list); };
        const auto found = std::lower_bound(shortlists.begin(), shortlists.end(), &all, before);
        return found != shortlists.end() && found->all == &all ? found->active : all;
    }
    /// Whether r is being advanced now. Forces on other objects have no effect, so computing them is wasted work.
    bool active(Ref r) const
    {
        if (r.facet == Facet::Body) return active_bodies.empty() || active_bodies[r.index] != 0;
        if (r.facet == Facet::Shaft) return active_shafts.empty() || active_shafts[r.index] != 0;
        return true;
    }
    /// The step has been interrupted: return at once, whatever the values are. The host discards them.
    bool interrupted() const { return interruption && interruption->due(); }
    /// Emits an event about the component of `row`.
    void emit(Row row, std::string kind, Severity severity, std::string message, std::vector<double> values = {}) const
    {
        if (!events) return;
        Event e;
        e.tick = tick, e.time = time, e.kind = std::move(kind), e.severity = severity;
        e.component = row < component_of_row.size() ? component_of_row[row] : kNoIndex;
        e.message = std::move(message), e.values = std::move(values);
        events->emit(std::move(e));
    }
};

}  // namespace plab
