/// The records in the rows of a snapshot file's sections, and their columns. Each column is named once, for writing and for reading.
/// Components are referred to by their row in the section "components".
#pragma once

#include <algorithm>
#include <cmath>

#include "simulation/snapshot/sections.h"
#include "simulation/snapshot/snapshot.h"

namespace plab::simulation::records
{

// The columns of each record: visit(name, member) for each. -----------------------------------------------------------------
// The names are part of the file format and stay as they were first written ("told" is what has been reported, "way" the linear motion,
// "lively" a speed of oscillation, "made" and "lifted" the energy that contacts and their position correction created), because a reader
// refuses files with columns that it does not know.

template <class V>
void columns(ClockImage& c, V visit)
{
    visit("tick", c.tick), visit("dt", c.dt.seconds), visit("dt_numerator", c.dt.numerator), visit("dt_denominator", c.dt.denominator);
    visit("base_tick", c.base_tick), visit("base_time", c.base_time);
    visit("paused", c.paused), visit("steps_left", c.steps_left), visit("rate", c.rate);
    visit("last_tick", c.last_tick), visit("last_start", c.last_start), visit("last_step", c.last_step);
}

/// Values of the run as a whole, apart from its clock.
struct RunRow
{
    std::string build;
    std::uint64_t run = 0, revision = 0, state_hash = 0, next_contact = 1;
    double departed_work = 0, requests_work = 0, kinetic_at_start = 0;
    bool reported_stiff = false, reported_stiff_forces = false, loaded_is_scene = false;
};
template <class V>
void columns(RunRow& r, V visit)
{
    visit("build", r.build), visit("run", r.run), visit("revision", r.revision), visit("state_hash", r.state_hash);
    visit("next_contact", r.next_contact), visit("departed_work", r.departed_work), visit("requests_work", r.requests_work);
    visit("kinetic_at_start", r.kinetic_at_start), visit("told_stiff", r.reported_stiff),
        visit("told_stiff_forces", r.reported_stiff_forces);
    visit("loaded_is_scene", r.loaded_is_scene);
}

struct Settings
{
    model::SceneSettings settings;
    std::string file;
};
template <class V>
void columns(Settings& s, V visit)
{
    model::SceneSettings& m = s.settings;
    visit("dt", m.dt.seconds), visit("dt_numerator", m.dt.numerator), visit("dt_denominator", m.dt.denominator);
    visit("seed", m.seed), visit("solver", m.solver), visit("solver_type", m.solver_type), visit("title", m.title);
    visit("file", s.file);
}

template <class V>
void columns(model::Camera& c, V visit)
{
    visit("name", c.name), visit("position", c.position), visit("look_at", c.look_at), visit("up", c.up);
    visit("field_of_view", c.field_of_view);
}

template <class V>
void columns(model::ComponentSpec& c, V visit)
{
    visit("id", c.id), visit("name", c.name), visit("type", c.type), visit("parent", c.parent), visit("alias_of", c.alias_of);
    visit("explicit_commands", c.explicit_commands), visit("generated", c.generated);
    visit("made_by", c.made_by);
    visit("file", c.where.file), visit("line", c.where.line), visit("column", c.where.column);
}

/// A text that belongs to a row of another section: a member of a group, a command, a member of a role.
struct Item
{
    std::uint32_t of = 0;
    std::string text;
};
template <class V>
void columns(Item& i, V visit)
{
    visit("of", i.of), visit("text", i.text);
}

struct GivenField
{
    std::uint32_t component = 0;
    std::string name;
    Value value;
};
template <class V>
void columns(GivenField& f, V visit)
{
    visit("component", f.component), visit("name", f.name), visit("value", f.value);
}

struct GivenRole
{
    std::uint32_t component = 0;
    std::string name;
    bool everyone = false;
};
template <class V>
void columns(GivenRole& r, V visit)
{
    visit("component", r.component), visit("name", r.name), visit("everyone", r.everyone);
}

/// Values that every component has, whatever its type.
struct Life
{
    bool quarantined = false, contradictory = false, passive = false;
    double work = 0, start_work = 0;
    double created = 0, start_created = 0, by_correction = 0;
};
template <class V>
void columns(Life& l, V visit)
{
    visit("quarantined", l.quarantined), visit("contradictory", l.contradictory), visit("passive", l.passive);
    visit("work", l.work), visit("start_work", l.start_work);
    visit("made", l.created), visit("start_made", l.start_created), visit("lifted", l.by_correction);
}

struct Body
{
    std::uint32_t component = 0;
    Motion motion = Motion::Static;
    Vec3 position, velocity, angular_velocity, angular_momentum;
    Quat orientation;
    double mass = 0, inverse_mass = 0;
    bool needle = false;
    Mat3 inertia, inverse_inertia;
    Vec3 center;
    DivergenceMemory::Growth linear, spin;
    bool reported = false, reported_missed = false;
    TunnelMemory::Sinking sinking;
};
template <class V>
void columns(Body& b, V visit)
{
    visit("component", b.component), visit("motion", b.motion), visit("position", b.position), visit("orientation", b.orientation);
    visit("velocity", b.velocity), visit("angular_velocity", b.angular_velocity), visit("angular_momentum", b.angular_momentum);
    visit("mass", b.mass), visit("inverse_mass", b.inverse_mass), visit("needle", b.needle);
    visit("inertia", b.inertia), visit("inverse_inertia", b.inverse_inertia), visit("center", b.center);
    visit("way_reference", b.linear.reference), visit("way_doublings", b.linear.doublings), visit("way_age", b.linear.age);
    visit("spin_reference", b.spin.reference), visit("spin_doublings", b.spin.doublings), visit("spin_age", b.spin.age);
    visit("told_diverged", b.reported), visit("told_missed", b.reported_missed);
    visit("sunk_last", b.sinking.last), visit("sunk_steps", b.sinking.steps);
}

struct Shaft
{
    std::uint32_t component = 0;
    Motion motion = Motion::Static;
    double angle = 0, speed = 0, inertia = 0, inverse_inertia = 0;
    std::uint32_t root = 0;  ///< component
    double ratio = 1, anchor = 0, root_anchor = 0;
    DivergenceMemory::Growth turn;
    bool reported = false;
};
template <class V>
void columns(Shaft& s, V visit)
{
    visit("component", s.component), visit("motion", s.motion), visit("angle", s.angle), visit("speed", s.speed);
    visit("inertia", s.inertia), visit("inverse_inertia", s.inverse_inertia), visit("root", s.root), visit("ratio", s.ratio);
    visit("anchor", s.anchor), visit("root_anchor", s.root_anchor);
    visit("turn_reference", s.turn.reference), visit("turn_doublings", s.turn.doublings), visit("turn_age", s.turn.age);
    visit("told_diverged", s.reported);
}

struct Quantity
{
    std::uint32_t component = 0;
    Reals values;
};
template <class V>
void columns(Quantity& q, V visit)
{
    visit("component", q.component), visit("values", q.values);
}

template <class V>
void columns(PairHead& p, V visit)
{
    visit("detector", p.detector), visit("a", p.a), visit("b", p.b), visit("since", p.since);
    visit("resting", p.resting), visit("ahead", p.ahead), visit("overlapping", p.overlapping), visit("normal", p.normal);
    visit("points", p.count), visit("bounce_time", p.bounces.time), visit("bounce_interval", p.bounces.interval);
    visit("bounce_previous", p.bounces.previous), visit("impacts", p.impacts), visit("impacts_tick", p.impacts_tick);
    visit("paradox_tick", p.paradox_tick);
}

template <class V>
void columns(KnownContact& k, V visit)
{
    visit("feature", k.feature), visit("id", k.id), visit("impulse", k.impulse), visit("stretch", k.stretch);
    visit("rest_depth", k.rest_depth), visit("preload", k.preload);
}

template <class V>
void columns(ForcePairHead& p, V visit)
{
    visit("detector", p.detector), visit("a", p.a), visit("b", p.b), visit("since", p.since);
    visit("law_type", p.law_type), visit("law", p.law), visit("normal", p.normal), visit("points", p.count);
    visit("released", p.released);
}

template <class V>
void columns(ForceContact& c, V visit)
{
    visit("feature", c.feature), visit("id", c.id), visit("stretch", c.stretch), visit("rest_depth", c.rest_depth);
    visit("preload", c.preload), visit("open_depth", c.open_depth), visit("approach", c.approach), visit("begin", c.begin);
    visit("depth", c.depth), visit("peak", c.peak), visit("half_period", c.half_period);
    visit("normal_rate", c.rates.normal), visit("tangential_rate", c.rates.tangential), visit("damping_rate", c.rates.damping);
    visit("mobility", c.rates.mobility), visit("share_a", c.rates.share_a);
    visit("lively", c.swing_speed), visit("liveliest", c.peak_swing_speed), visit("impulse", c.impulse), visit("force", c.force);
    visit("asked", c.asked), visit("slack", c.slack), visit("told", c.reported), visit("dormant", c.dormant);
}

/// How long a body has been at rest, and whether it sleeps. Bodies that have just moved have no row.
struct Rest
{
    std::uint32_t component = 0;
    BodyRest body;
    std::uint64_t scene_cause = 0;  ///< the same in each row
};
template <class V>
void columns(Rest& r, V visit)
{
    visit("component", r.component), visit("quiet", r.body.quiet), visit("asleep", r.body.asleep), visit("cause", r.body.cause);
    visit("moved", r.body.moved), visit("moved_before", r.body.moved_before);
    visit("turned", r.body.turned), visit("turned_before", r.body.turned_before), visit("scene_cause", r.scene_cause);
}

/// Until when a body has been in an island that is too large to locate its impacts. Others have no row.
struct Crowded
{
    std::uint32_t component = 0;
    double until = 0;
};
template <class V>
void columns(Crowded& c, V visit)
{
    visit("component", c.component), visit("until", c.until);
}

/// The divergence watch, without what it keeps by component, body and shaft.
struct Watch
{
    bool counting = false, reported = false, sealed = false;
    double start_energy = 0, last_kinetic = 0, start_other_work = 0;
    Tick gaining_since = -1;
    std::int64_t gaining_steps = 0;
    bool knows_bodies = false, knows_shafts = false, knows_work = false, knows_missed = false;  ///< whether those lists exist
};
template <class V>
void columns(Watch& w, V visit)
{
    visit("counting", w.counting), visit("told", w.reported), visit("sealed", w.sealed), visit("start_energy", w.start_energy);
    visit("last_kinetic", w.last_kinetic), visit("start_other_work", w.start_other_work), visit("gaining_since", w.gaining_since);
    visit("gaining_steps", w.gaining_steps), visit("knows_bodies", w.knows_bodies), visit("knows_shafts", w.knows_shafts);
    visit("knows_work", w.knows_work), visit("knows_missed", w.knows_missed);
}

struct Number
{
    std::uint32_t value = 0;
};
template <class V>
void columns(Number& n, V visit)
{
    visit("value", n.value);
}

struct Note
{
    std::string name, text;
};
template <class V>
void columns(Note& n, V visit)
{
    visit("name", n.name), visit("text", n.text);
}

// From records to sections and back. ----------------------------------------------------------------------------------------

/// Conversion between a member and an element of a column.
template <class T>
struct Stored
{
    using Type = T;
    static const T& out(const T& v) { return v; }
    static bool in(const T& stored, T& v) { return v = stored, true; }
};
template <class T, class As>
struct StoredAs
{
    using Type = As;
    static As out(T v) { return static_cast<As>(v); }
    static bool in(As stored, T& v) { return v = static_cast<T>(stored), static_cast<As>(v) == stored; }
};
template <>
struct Stored<std::uint64_t> : StoredAs<std::uint64_t, std::int64_t>
{
};
template <>
struct Stored<std::uint8_t> : StoredAs<std::uint8_t, std::uint32_t>
{
};
template <>
struct Stored<int> : StoredAs<int, std::int64_t>
{
};
template <>
struct Stored<Motion>
{
    using Type = std::string;
    static constexpr std::string_view kWords[] = {"static", "kinematic", "dynamic"};
    static std::string out(Motion m) { return std::string(kWords[static_cast<std::size_t>(m)]); }
    static bool in(const std::string& word, Motion& m)
    {
        const auto at = std::find(std::begin(kWords), std::end(kWords), word);
        m = static_cast<Motion>(at == std::end(kWords) ? 0 : at - std::begin(kWords));
        return at != std::end(kWords);
    }
};
/// A body: a host row in memory, a component row in the file. The callers translate.
template <>
struct Stored<Ref>
{
    using Type = std::uint32_t;
    static std::uint32_t out(Ref r) { return r.index; }
    static bool in(std::uint32_t stored, Ref& r) { return r = {Facet::Body, stored}, true; }
};

template <class T>
Section section_of(std::string name, std::vector<T>& rows)
{
    Section out;
    out.name = std::move(name), out.rows = rows.size();
    T empty{};
    columns(empty,
            [&]<class M>(const char* column, M&) {
                out.columns.push_back({column, ColumnData(std::in_place_type<std::vector<typename Stored<M>::Type>>)});
            });
    for (T& row : rows)
    {
        std::size_t k = 0;
        columns(row, [&]<class M>(const char*, M& member)
                { std::get<std::vector<typename Stored<M>::Type>>(out.columns[k++].data).push_back(Stored<M>::out(member)); });
    }
    return out;
}

/// Reads the rows of a section. A column that is missing leaves its default; one that is unknown or of another type is refused.
template <class T>
Result<std::vector<T>> rows_of(const Section& section)
{
    const auto where = [&](std::string_view column)
    { return "the snapshot's section '" + section.name + "', column '" + std::string(column) + "' "; };
    Errors errors;
    std::vector<const NamedColumn*> found;
    T spare{};
    columns(spare,
            [&]<class M>(const char* name, M&)
            {
                const NamedColumn* column = section.find(name);
                found.push_back(column);
                if (column && !std::holds_alternative<std::vector<typename Stored<M>::Type>>(column->data))
                    errors.push_back(reason(where(name) + "has another type in this build"));
            });
    for (const NamedColumn& c : section.columns)
        if (std::find(found.begin(), found.end(), &c) == found.end()) errors.push_back(reason(where(c.name) + "is unknown to this build"));
    if (!errors.empty()) return errors;

    std::vector<T> out(section.rows);
    for (std::size_t row = 0; row < out.size() && errors.empty(); ++row)
    {
        std::size_t k = 0;
        columns(out[row],
                [&]<class M>(const char* name, M& member)
                {
                    const NamedColumn* column = found[k++];
                    if (!column || Stored<M>::in(std::get<std::vector<typename Stored<M>::Type>>(column->data)[row], member)) return;
                    errors.push_back(reason(where(name) + "is out of range in row " + std::to_string(row)));
                });
    }
    if (!errors.empty()) return errors;
    return out;
}

}  // namespace plab::simulation::records
