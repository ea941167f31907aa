#include "simulation/snapshot/compare.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "model/values.h"

namespace plab::simulation
{
namespace
{

// Two states are compared by their portraits: a list of named values for each component, in the order of ids, compared bit by bit. Indices
// of rows do not appear in it, so states of different worlds can be compared, and a difference names its component and field.

/// The kind of a value, by which a Comparison selects.
enum class Weight : std::uint8_t
{
    State,
    Param,
    Output,
    Ledger,  ///< not part of the state: the ledger, and the memory behind reported events
};

struct Fact
{
    std::string name;
    Weight weight = Weight::State;
    Value value;
};
using Facts = std::vector<Fact>;
/// By component id, or by the subject of the facts.
using Portrait = std::map<std::string, Facts>;

Weight weight_of(FieldKind kind)
{
    if (kind == FieldKind::Param) return Weight::Param;
    return kind == FieldKind::State ? Weight::State : Weight::Output;
}

Value whole(std::uint64_t n) { return Value(static_cast<std::int64_t>(n)); }

Value word(Motion motion)
{
    constexpr const char* kWords[] = {"static", "kinematic", "dynamic"};
    return Value(std::string(kWords[static_cast<int>(motion)]));
}

void add_body(const Bodies& b, std::uint32_t i, Facts& out)
{
    out.push_back({"motion", Weight::State, word(b.motion[i])});
    out.push_back({"position of the centre of mass", Weight::State, b.position[i]});
    out.push_back({"orientation", Weight::State, b.orientation[i]});
    out.push_back({"velocity of the centre of mass", Weight::State, b.velocity[i]});
    out.push_back({"angular_velocity", Weight::State, b.angular_velocity[i]});
    out.push_back({"angular_momentum", Weight::State, b.angular_momentum[i]});
    out.push_back({"mass in use", Weight::Param, b.mass[i]});
    out.push_back({"inverse_mass in use", Weight::Param, b.inverse_mass[i]});
    out.push_back({"inertia in use", Weight::Param, b.inertia_B[i]});
    out.push_back({"inverse_inertia in use", Weight::Param, b.inverse_inertia_B[i]});
    out.push_back({"center in use", Weight::Param, b.center_B[i]});
    out.push_back({"needle", Weight::Param, b.needle[i] != 0});
}

void add_shaft(const world::Image& image, std::uint32_t i, Facts& out)
{
    const Shafts& s = image.shafts;
    std::string root;
    image.for_each(
        [&](std::uint32_t, const world::Component& c, const world::Layout&)
        {
            if (c.facet == Facet::Shaft && c.host_index == s.root[i]) root = c.id;
        });
    out.push_back({"motion", Weight::State, word(s.motion[i])});
    out.push_back({"angle", Weight::State, s.angle[i]});
    out.push_back({"angular_velocity", Weight::State, s.speed[i]});
    out.push_back({"root", Weight::State, root});
    out.push_back({"ratio", Weight::State, s.ratio[i]});
    out.push_back({"anchor", Weight::State, s.anchor[i]});
    out.push_back({"root_anchor", Weight::State, s.root_anchor[i]});
    out.push_back({"inertia in use", Weight::Param, s.inertia[i]});
    out.push_back({"inverse_inertia in use", Weight::Param, s.inverse_inertia[i]});
}

Portrait components_of(const world::Image& image)
{
    Portrait out;
    ByteReader cells(image.cells);
    image.for_each(
        [&](std::uint32_t, const world::Component& c, const world::Layout& layout)
        {
            Facts& facts = out[c.id];
            facts.push_back({"type", Weight::State, layout.type});
            facts.push_back({"quarantined", Weight::State, c.quarantined});
            if (c.facet == Facet::Body) add_body(image.bodies, c.host_index, facts);
            if (c.facet == Facet::Shaft) add_shaft(image, c.host_index, facts);
            if (c.facet == Facet::Quantities)
                facts.push_back({"values", Weight::State, Value(std::in_place_type<Reals>, image.quantities.value[c.host_index])});
            for (const world::FieldLayout& field : layout.fields)
                facts.push_back({field.name, weight_of(field.kind), world::read_value(cells, field.type)});
        });
    return out;
}

/// The ids of the components between which contacts are.
class Names
{
public:
    explicit Names(const world::Image& image) : image_(&image), body_(image.bodies.size())
    {
        image.for_each(
            [&](std::uint32_t, const world::Component& c, const world::Layout&)
            {
                if (c.facet == Facet::Body) body_[c.host_index] = c.id;
            });
    }
    std::string pair(const char* what, const PairHead& p) const { return name(what, p.detector, p.a, p.b); }
    std::string pair(const char* what, const ForcePairHead& p) const { return name(what, p.detector, p.a, p.b); }

    const std::string& body(std::uint32_t b) const { return body_[b]; }

private:
    std::string name(const char* what, std::uint32_t detector, Ref a, Ref b) const
    {
        return std::string(what) + " " + image_->component(detector).id + " " + body_[a.index] + " " + body_[b.index];
    }
    const world::Image* image_;
    std::vector<std::string> body_;
};

void add_point(const KnownContact& k, const std::string& at, Facts& out)
{
    out.push_back({at + "feature", Weight::State, whole(k.feature)});
    out.push_back({at + "id", Weight::State, whole(k.id)});
    out.push_back({at + "impulse", Weight::State, k.impulse});
    out.push_back({at + "stretch", Weight::State, k.stretch});
    out.push_back({at + "rest_depth", Weight::State, k.rest_depth});
    out.push_back({at + "preload", Weight::State, k.preload});
}

void add_point(const ForceContact& c, const std::string& at, Facts& out)
{
    out.push_back({at + "feature", Weight::State, whole(c.feature)});
    out.push_back({at + "id", Weight::State, whole(c.id)});
    for (const auto& [name, value] : {std::pair{"stretch", c.stretch}, {"impulse", c.impulse}, {"force", c.force}})
        out.push_back({at + name, Weight::State, value});
    for (const auto& [name, value] : {std::pair{"rest_depth", c.rest_depth},
                                      {"preload", c.preload},
                                      {"open_depth", c.open_depth},
                                      {"approach", c.approach},
                                      {"begin", c.begin},
                                      {"depth", c.depth},
                                      {"peak", c.peak},
                                      {"half_period", c.half_period},
                                      {"swing_speed", c.swing_speed},
                                      {"peak_swing_speed", c.peak_swing_speed},
                                      {"normal_rate", c.rates.normal},
                                      {"tangential_rate", c.rates.tangential},
                                      {"damping_rate", c.rates.damping},
                                      {"mobility", c.rates.mobility},
                                      {"share_a", c.rates.share_a}})
        out.push_back({at + name, Weight::State, value});
    for (const auto& [name, value] : {std::pair{"slack", c.slack}, {"reported", c.reported}, {"dormant", c.dormant}})
        out.push_back({at + name, Weight::State, value});
    out.push_back({at + "asked", Weight::State, Value(std::int64_t{c.asked})});
}

void add_head(const PairHead& p, Facts& out)
{
    for (const auto& [name, value] : {std::pair{"resting", p.resting}, {"ahead", p.ahead}, {"overlapping", p.overlapping}})
        out.push_back({name, Weight::State, value});
    out.push_back({"since", Weight::State, Value(std::int64_t{p.since})});
    out.push_back({"normal", Weight::State, p.normal});
    out.push_back({"bounces", Weight::State, Vec3{p.bounces.time, p.bounces.interval, p.bounces.previous}});
}

void add_head(const ForcePairHead& p, Facts& out)
{
    out.push_back({"since", Weight::State, Value(std::int64_t{p.since})});
    out.push_back({"normal", Weight::State, p.normal});
    out.push_back({"law", Weight::State, whole(p.law)});
    out.push_back({"released", Weight::State, p.released});
}

void add_rest(const BodyRest& r, Facts& out)
{
    out.push_back({"asleep", Weight::State, r.asleep});
    out.push_back({"quiet steps", Weight::State, whole(r.quiet)});
    out.push_back({"cause", Weight::State, whole(r.cause)});
    for (const auto& [name, value] :
         {std::pair{"moved", r.moved}, {"moved before", r.moved_before}, {"turned", r.turned}, {"turned before", r.turned_before}})
        out.push_back({name, Weight::State, value});
}

template <class List>
void add_pairs(const char* what, const List& list, const Names& names, Portrait& out)
{
    std::size_t at = 0;
    for (const auto& head : list.heads)
    {
        Facts& facts = out[names.pair(what, head)];
        add_head(head, facts);
        facts.push_back({"contacts", Weight::State, whole(head.count)});
        for (std::uint32_t k = 0; k < head.count; ++k) add_point(list.points[at++], "contact " + std::to_string(k) + " ", facts);
    }
}

Portrait contacts_of(const world::Image& image, const ContactsImage& contacts)
{
    const Names names(image);
    Portrait out;
    add_pairs("pair", contacts.pairs, names, out);
    add_pairs("spring pair", contacts.force_pairs, names, out);
    add_pairs("parked pair", contacts.parked, names, out);
    add_pairs("parked spring pair", contacts.parked_force_pairs, names, out);
    out["contacts"].push_back({"next id", Weight::State, whole(contacts.next_id)});
    for (std::uint32_t b = 0; b < contacts.rest.size(); ++b)
        if (const BodyRest& r = contacts.rest[b]; !(r == BodyRest{})) add_rest(r, out["rest of " + names.body(b)]);
    for (std::uint32_t b = 0; b < contacts.crowded_until.size(); ++b)
        if (const double until = contacts.crowded_until[b]; std::isfinite(until))
            out["crowd of " + names.body(b)].push_back({"crowded until", Weight::State, until});
    return out;
}

Portrait rest_of(const SnapshotContent& s)
{
    Portrait out;
    Facts& clock = out["clock"];
    clock.push_back({"tick", Weight::State, Value(std::int64_t{s.clock.tick})});
    clock.push_back({"dt", Weight::State, s.clock.dt.seconds});
    clock.push_back({"base_tick", Weight::State, Value(std::int64_t{s.clock.base_tick})});
    clock.push_back({"base_time", Weight::State, s.clock.base_time});
    clock.push_back({"length of the last step", Weight::State, s.clock.last_step});
    clock.push_back({"start of the last step", Weight::State, s.clock.last_start});
    Facts& ledger = out["ledger"];
    ledger.push_back({"work of removed components", Weight::Ledger, s.ledger.departed});
    ledger.push_back({"work of requests", Weight::Ledger, s.ledger.requests});
    ledger.push_back({"kinetic energy at the start", Weight::Ledger, s.ledger.kinetic_at_start});
    Facts& memory = out["memory of events"];
    memory.push_back({"stiff contacts reported", Weight::Ledger, s.reported.stiff});
    memory.push_back({"stiff forces reported", Weight::Ledger, s.reported.stiff_forces});
    memory.push_back({"energy is counted", Weight::Ledger, s.watch.counting});
    memory.push_back({"energy gain reported", Weight::Ledger, s.watch.reported});
    memory.push_back({"energy at the start", Weight::Ledger, s.watch.start_energy});
    memory.push_back({"largest kinetic energy", Weight::Ledger, s.watch.last_kinetic});
    memory.push_back({"steps that gained energy", Weight::Ledger, Value(s.watch.gaining_steps)});
    s.world.for_each(
        [&](std::uint32_t i, const world::Component& c, const world::Layout&)
        {
            Facts& facts = out["ledger of " + c.id];
            if (i < s.ledger.work.size()) facts.push_back({"work", Weight::Ledger, s.ledger.work[i]});
            if (i < s.ledger.contact_energy.size())
                facts.push_back({"created by contacts", Weight::Ledger, s.ledger.contact_energy[i].created}),
                    facts.push_back({"created by position correction", Weight::Ledger, s.ledger.contact_energy[i].by_correction});
            if (i < s.watch.start_work.size()) facts.push_back({"work when counting began", Weight::Ledger, s.watch.start_work[i]});
            if (i < s.watch.start_created.size())
                facts.push_back({"energy created when counting began", Weight::Ledger, s.watch.start_created[i]});
            if (c.facet == Facet::Body && c.host_index < s.watch.linear.size())
                facts.push_back({"reference speed of growth", Weight::Ledger, s.watch.linear[c.host_index].reference});
        });
    return out;
}

class Search
{
public:
    Search(const Comparison& how, std::vector<Difference>& out) : how_(how), out_(out) {}

    void run(const Portrait& first, const Portrait& second)
    {
        auto a = first.begin(), b = second.begin();
        while ((a != first.end() || b != second.end()) && !full())
        {
            if (b == second.end() || (a != first.end() && a->first < b->first))
                add(a++->first, "presence", "there", "-");
            else if (a == first.end() || b->first < a->first)
                add(b++->first, "presence", "-", "there");
            else
                compare(a->first, a->second, b->second), ++a, ++b;
        }
    }

private:
    bool full() const { return out_.size() >= how_.most; }
    bool counts(Weight weight) const
    {
        return weight == Weight::State || (weight == Weight::Param && how_.params) || (weight == Weight::Output && how_.outputs) ||
               (weight == Weight::Ledger && how_.ledger);
    }
    void add(const std::string& component, const std::string& field, std::string first, std::string second)
    {
        if (!full()) out_.push_back({component, field, std::move(first), std::move(second)});
    }
    static const Fact* find(const Facts& facts, const std::string& name)
    {
        const auto at = std::find_if(facts.begin(), facts.end(), [&](const Fact& f) { return f.name == name; });
        return at == facts.end() ? nullptr : &*at;
    }
    void compare(const std::string& component, const Facts& first, const Facts& second)
    {
        for (const Fact& a : first)
        {
            if (!counts(a.weight)) continue;
            const Fact* b = find(second, a.name);
            if (!b)
                add(component, a.name, model::format_value(a.value), "-");
            else if (!world::same_bits(a.value, b->value))
                add(component, a.name, model::format_value(a.value), model::format_value(b->value));
        }
        for (const Fact& b : second)
            if (counts(b.weight) && !find(first, b.name)) add(component, b.name, "-", model::format_value(b.value));
    }

    const Comparison& how_;
    std::vector<Difference>& out_;
};

}  // namespace

std::string Difference::text() const { return component + ": " + field + " is " + first + " and " + second; }

std::vector<Difference> differences(const SnapshotContent& first, const SnapshotContent& second, const Comparison& how)
{
    std::vector<Difference> out;
    Search search(how, out);
    search.run(components_of(first.world), components_of(second.world));
    search.run(contacts_of(first.world, first.contacts), contacts_of(second.world, second.contacts));
    search.run(rest_of(first), rest_of(second));
    return out;
}

std::optional<Difference> compare_worlds(const world::Image& first, const ContactsImage& first_contacts, const world::Image& second,
                                         const ContactsImage& second_contacts)
{
    std::vector<Difference> out;
    const Comparison how;
    Search search(how, out);
    search.run(components_of(first), components_of(second));
    search.run(contacts_of(first, first_contacts), contacts_of(second, second_contacts));
    return out.empty() ? std::nullopt : std::optional(out.front());
}

}  // namespace plab::simulation
