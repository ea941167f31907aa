/// What a phase function may ask of the host: time, who is being advanced, events.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "plab/interruption.h"
#include "plab/ref.h"
#include "plab/value.h"

namespace plab
{

using Tick = std::int64_t;

enum class Severity : std::uint8_t
{
    Info,
    Warning,
    Failure,  ///< the component is quarantined; the rest of the scene goes on
};

/// Something that happened in a step, in order of occurrence.
struct Event
{
    Tick tick = 0;     ///< step in which it happened
    double time = 0;   ///< s, exact within the step
    std::string kind;  ///< "contact.begin", "script.error", ... : a dotted word
    Severity severity = Severity::Info;
    std::uint32_t component = kNoIndex;  ///< directory index of whom it is about
    Ref a, b;                            ///< participants, where there are any
    std::string message;                 ///< for people; may be empty
    std::vector<double> values;          ///< e.g. a contact's point and normal, a script's figures
};

class EventSink
{
public:
    virtual ~EventSink() = default;
    virtual void emit(Event event) = 0;
};

/// A parameter change that a script asks for in drive; the host applies it when the drive phase is over.
struct ParameterChange
{
    std::string component;  ///< id
    std::string name;
    Value value;
};

/// Of a long list of participants, those that are being advanced: so that a field over ten thousand bodies costs a group
/// of one no more than one.
struct Shortlist
{
    const RefList* all = nullptr;
    RefList active;
};

/// Time and scope of one call. `time` is the solver stage's own.
struct StepContext
{
    double time = 0;  ///< s
    double dt = 0;    ///< s, length of the step (or of the part that is advanced)
    Tick tick = 0;
    std::uint64_t seed = 0;
    EventSink* events = nullptr;
    std::vector<ParameterChange>* changes = nullptr;  ///< drive phase only
    const Interruption* interruption = nullptr;       ///< what may take long asks interrupted() now and then

    std::span<const std::uint32_t> component_of_row;  ///< directory index of each row of this table
    std::span<const std::uint32_t> facet_of_row;      ///< host table index of each row, where the type has a facet
    std::span<const std::uint8_t> active_bodies;      ///< empty: all
    std::span<const std::uint8_t> active_shafts;

    std::span<const Shortlist> shortlists;  ///< by address of `all`

    /// The participants of a list that is a column's cell, or those of them that may be active, in the same order.
    std::span<const Ref> among(const RefList& all) const
    {
        const auto before = [](const Shortlist& s, const RefList* list) { return std::less<>()(s.all, list); };
        const auto found = std::lower_bound(shortlists.begin(), shortlists.end(), &all, before);
        return found != shortlists.end() && found->all == &all ? found->active : all;
    }
    /// Whether r is being advanced now. Forces on others are wasted work; adding them does no harm.
    bool active(Ref r) const
    {
        if (r.facet == Facet::Body) return active_bodies.empty() || active_bodies[r.index] != 0;
        if (r.facet == Facet::Shaft) return active_shafts.empty() || active_shafts[r.index] != 0;
        return true;
    }
    /// The step is given up: whoever is at work leaves off, with whatever numbers there are. Nobody will see them.
    bool interrupted() const { return interruption && interruption->due(); }
    /// An event about the component of `row`.
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
