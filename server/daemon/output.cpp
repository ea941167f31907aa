#include "daemon/output.h"

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "idl/json/json.h"
#include "model/numbers.h"
#include "publish/error_probe.h"
#include "publish/figures.h"
#include "simulation/costs/component_costs.h"
#include "world/host_tables.h"

namespace plab::daemon
{
namespace
{

using wire::Json;
using wire::json_of;

Json quartiles_json(const simulation::Spread& s) { return s.samples == 0 ? Json(nullptr) : Json{s.low, s.median, s.high}; }

Json object_json(const world::World& world, std::uint32_t i)
{
    const world::Component& c = world.component(i);
    const world::HostTables& host = world.host();
    if (c.facet == Facet::Quantities) return {{"values", host.quantities.value[c.host_index]}};
    if (c.facet == Facet::Shaft) return {{"angle", host.shafts.angle[c.host_index]}, {"angular_velocity", host.shafts.speed[c.host_index]}};
    Json out;
    for (const char* name : {"position", "orientation", "linear_velocity", "angular_velocity"})
    {
        const Value value = world::get_hosted(host, Facet::Body, c.host_index, name);
        if (const auto* v = std::get_if<Vec3>(&value)) out[name] = json_of(*v);
        if (const auto* q = std::get_if<Quat>(&value)) out[name] = json_of(*q);
    }
    return out;
}

Json interaction_json(const simulation::Simulation& s, std::uint32_t i, const simulation::ComponentCost& cost)
{
    const world::World& world = s.world();
    const publish::ErrorFigure error = publish::own_error(s, i);
    Json out = {{"type", world.type_of(i)->info.name},
                {"cost_ns_per_step", cost.mean},
                {"cost_quartiles_ns", quartiles_json(cost.last)},
                {"cost_shared_by", cost.shared},
                {"work", s.stepper().work()[i]},
                {"created", s.stepper().contact_energy()[i].created},
                {"created_by_correction", s.stepper().contact_energy()[i].by_correction},
                {"error", error.value},
                {"error_unit", error.unit},
                {"error_meaning", error.meaning}};
    for (const Field& field : world.table_of(i).schema().fields())
    {
        if (field.kind != FieldKind::Output) continue;
        const Value v = world.get(i, field.name);
        if (const auto* d = std::get_if<double>(&v)) out[field.name] = *d;
        if (const auto* n = std::get_if<std::int64_t>(&v)) out[field.name] = *n;
    }
    if (world.component(i).quarantined) out["quarantined"] = true;
    return out;
}

/// A pair in contact: its components, since which step, and the contact ids.
template <class Pair>
Json pair_json(const world::World& world, const Pair& pair, bool resting)
{
    Json ids = Json::array();
    for (std::uint32_t i = 0; i < pair.count; ++i) ids.push_back(pair.contacts[i].id);
    return {{"detector", world.id_of(pair.detector)},
            {"a", world.id_of(pair.a)},
            {"b", world.id_of(pair.b)},
            {"since", pair.since},
            {"resting", resting},
            {"ids", std::move(ids)}};
}

/// Pairs with rigid contact first, then those with contact forces; the latter never rest.
Json contacts_json(const simulation::Simulation& s)
{
    Json out = Json::array();
    simulation::ContactCache all = s.stepper().contacts();
    all.bring_back(s.world());
    for (const simulation::PairState& pair : std::as_const(all).pairs())
        if (!pair.ahead) out.push_back(pair_json(s.world(), pair, pair.resting));
    for (const simulation::ForcePair& pair : s.stepper().contacts().force_pairs()) out.push_back(pair_json(s.world(), pair, false));
    return out;
}

Json ledger_json(const simulation::Simulation& s, const simulation::Totals& totals)
{
    return {{"kinetic", totals.kinetic},
            {"stored", totals.stored},
            {"work", totals.work},
            {"kinetic_at_start", s.kinetic_at_start()},
            {"work_of_requests", s.stepper().requests_work()},
            {"work_of_removed", s.stepper().departed_work()},
            {"unexplained", publish::unexplained(s, totals)}};
}

Json totals_json(const simulation::Simulation& s)
{
    const simulation::Totals totals = s.totals();
    const simulation::CostBook& cost = s.stepper().cost();
    return {{"time", s.time()},
            {"step", s.tick()},
            {"hash", model::hash_text(s.state_hash())},
            {"energy", totals.kinetic + totals.stored},
            {"momentum", json_of(totals.momentum)},
            {"angular_momentum", json_of(totals.angular_momentum)},
            {"shaft_momentum", totals.shaft_momentum},
            {"ledger", ledger_json(s, totals)},
            {"contacts", contacts_json(s)},
            {"cost_ns_per_step", cost.mean()},
            {"cost_quartiles_ns", quartiles_json(cost.step())},
            {"cost_of_server_ns_per_step", cost.mean_of_host()}};
}

/// Each member on a line of its own, and each object, interaction and contact, so that line tools can find and compare them.
/// nlohmann writes all on one line, or each number on a line of its own; this layout is between the two, of values that it wrote.
std::string in_lines(const Json& document)
{
    const auto text = [](const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); };
    std::string out = "{";
    for (const auto& [key, value] : document.items())
    {
        out += (out.size() == 1 ? "\n  " : ",\n  ") + text(key) + ": ";
        const bool is_list = value.is_array() && !value.empty() && value.front().is_object();
        const bool is_map = value.is_object() && !value.empty() && value.front().is_object();
        if (!is_list && !is_map)
        {
            out += text(value);
            continue;
        }
        const char* separator = is_list ? "[\n    " : "{\n    ";
        for (const auto& [name, member] : value.items())
        {
            out += separator + (is_map ? text(name) + ": " : std::string()) + text(member);
            separator = ",\n    ";
        }
        out += is_list ? "\n  ]" : "\n  }";
    }
    return out + "\n}\n";
}

}  // namespace

std::string end_state_json(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    const simulation::ComponentCosts costs(s.world(), s.stepper().cost());
    Json objects = Json::object(), interactions = Json::object();
    // Pairs are appended: looking for the key, as `[]` does in an ordered object, would make this quadratic.
    const auto append = [&](Json& to, std::uint32_t i, Json value)
    { to.get_ref<Json::object_t&>().Container::emplace_back(world.id_of(i), std::move(value)); };
    for (const std::uint32_t i : world.in_id_order())
    {
        if (is_shown(world.component(i))) append(objects, i, object_json(world, i));
        if (is_listed(world, i)) append(interactions, i, interaction_json(s, i, costs.of(i)));
    }
    Json out = totals_json(s);
    out["objects"] = std::move(objects);
    out["interactions"] = std::move(interactions);
    return in_lines(out);
}

bool write_end_state(const simulation::Simulation& s, const std::string& file)
{
    const std::string text = end_state_json(s);
    if (file == "-")
    {
        const bool fine = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
        if (!fine) spdlog::error("cannot write the end state to standard output");
        return fine;
    }
    std::FILE* f = std::fopen(file.c_str(), "w");
    const bool written = f && std::fputs(text.c_str(), f) >= 0;
    const bool closed = f && std::fclose(f) == 0;
    if (!written || !closed) spdlog::error("cannot write {}", file);
    return written && closed;
}

std::string number(double v) { return model::exact_text(v, "null"); }

bool is_shown(const world::Component& c) { return publish::is_object(c) || c.facet == Facet::Quantities; }

bool is_listed(const world::World& world, std::uint32_t i)
{
    return publish::is_interaction(world.component(i)) && !publish::is_solver(world, i);
}

}  // namespace plab::daemon
