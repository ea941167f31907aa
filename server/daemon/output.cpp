#include "daemon/output.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "daemon/figures_text.h"
#include "model/exact_text.h"
#include "publish/error_probe.h"
#include "publish/figures.h"
#include "world/host_tables.h"

namespace plab::daemon
{
namespace
{

/// Numbers are written by number(), with 17 significant digits; text is escaped as nlohmann does it.
std::string quoted(const std::string& s) { return nlohmann::json(s).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace); }

std::string array(const Vec3& v) { return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]"; }
std::string quartiles(const simulation::Spread& s)
{
    if (s.samples == 0) return "null";
    return "[" + number(s.low) + ", " + number(s.median) + ", " + number(s.high) + "]";
}
std::string array(const Quat& q) { return "[" + number(q.w) + ", " + number(q.x) + ", " + number(q.y) + ", " + number(q.z) + "]"; }

std::string object_json(const world::World& world, std::uint32_t i)
{
    const world::Component& c = world.component(i);
    if (c.facet == Facet::Quantities)
    {
        std::string values;
        for (const double v : world.host().quantities.value[c.host_index]) values += (values.empty() ? "" : ", ") + number(v);
        return "{\"values\": [" + values + "]}";
    }
    if (c.facet == Facet::Shaft)
        return "{\"angle\": " + number(world.host().shafts.angle[c.host_index]) +
               ", \"angular_velocity\": " + number(world.host().shafts.speed[c.host_index]) + "}";
    const auto hosted = [&](const char* name) { return world::get_hosted(world.host(), Facet::Body, c.host_index, name); };
    return "{\"position\": " + array(std::get<Vec3>(hosted("position"))) +
           ", \"orientation\": " + array(std::get<Quat>(hosted("orientation"))) +
           ", \"linear_velocity\": " + array(std::get<Vec3>(hosted("linear_velocity"))) +
           ", \"angular_velocity\": " + array(std::get<Vec3>(hosted("angular_velocity"))) + "}";
}

std::string interaction_json(const simulation::Simulation& s, std::uint32_t i, const publish::Cost& cost)
{
    const world::World& world = s.world();
    const publish::ErrorFigure error = publish::own_error(s, i);
    std::string out = "{\"type\": " + quoted(world.type_of(i)->info.name) + ", \"cost_ns_per_step\": " + number(cost.mean) +
                      ", \"cost_quartiles_ns\": " + quartiles(cost.last) + ", \"cost_shared_by\": " + std::to_string(cost.shared) +
                      ", \"work\": " + number(s.stepper().work()[i]) + ", \"made\": " + number(s.stepper().contact_energy()[i].made) +
                      ", \"lifted\": " + number(s.stepper().contact_energy()[i].lifted) + ", \"error\": " + number(error.value) +
                      ", \"error_unit\": " + quoted(error.unit) + ", \"error_meaning\": " + quoted(error.meaning);
    for (const Field& field : world.table_of(i).schema().fields())
    {
        if (field.kind != FieldKind::Output) continue;
        const Value v = world.get(i, field.name);
        if (const auto* d = std::get_if<double>(&v)) out += ", " + quoted(field.name) + ": " + number(*d);
        if (const auto* n = std::get_if<std::int64_t>(&v)) out += ", " + quoted(field.name) + ": " + std::to_string(*n);
    }
    return out + (world.component(i).quarantined ? ", \"quarantined\": true}" : "}");
}

/// A pair in contact: its components, since which step, and the contact ids.
template <class Pair>
void append_pair(std::string& out, const simulation::Simulation& s, const Pair& pair, bool resting)
{
    std::string ids;
    for (std::uint32_t i = 0; i < pair.count; ++i) ids += (i == 0 ? "" : ", ") + std::to_string(pair.contacts[i].id);
    out += (out.empty() ? "" : ",") + std::string("\n    {\"detector\": ") + quoted(s.world().id_of(pair.detector)) +
           ", \"a\": " + quoted(s.world().id_of(pair.a)) + ", \"b\": " + quoted(s.world().id_of(pair.b)) +
           ", \"since\": " + std::to_string(pair.since) + ", \"resting\": " + (resting ? "true" : "false") + ", \"ids\": [" + ids + "]}";
}

/// Pairs with rigid contact first, then those with contact forces; the latter never rest.
std::string contacts_json(const simulation::Simulation& s)
{
    std::string out;
    for (const simulation::PairState& pair : s.stepper().contacts().pairs())
        if (!pair.ahead) append_pair(out, s, pair, pair.resting);
    for (const simulation::ForcePair& pair : s.stepper().contacts().force_pairs()) append_pair(out, s, pair, false);
    return out;
}

}  // namespace

std::string end_state_json(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    const simulation::Totals totals = s.totals();
    const publish::Costs costs(s);
    std::string objects, interactions;
    for (const std::uint32_t i : world.in_id_order())
    {
        if (is_shown(world.component(i)))
            objects += (objects.empty() ? "" : ",") + std::string("\n    ") + quoted(world.id_of(i)) + ": " + object_json(world, i);
        if (is_listed(world, i))
            interactions += (interactions.empty() ? "" : ",") + std::string("\n    ") + quoted(world.id_of(i)) + ": " +
                            interaction_json(s, i, costs.of(i));
    }
    const simulation::CostBook& cost = s.stepper().cost();
    std::string out = "{\n  \"time\": " + number(s.time()) + ",\n  \"step\": " + std::to_string(s.tick());
    out += ",\n  \"hash\": " + quoted(model::hash_text(s.state_hash()));
    out += ",\n  \"energy\": " + number(totals.kinetic + totals.stored);
    out += ",\n  \"momentum\": " + array(totals.momentum);
    out += ",\n  \"angular_momentum\": " + array(totals.angular_momentum);
    out += ",\n  \"shaft_momentum\": " + number(totals.shaft_momentum);
    out += ",\n  \"ledger\": {\"kinetic\": " + number(totals.kinetic) + ", \"stored\": " + number(totals.stored) +
           ", \"work\": " + number(totals.work) + ", \"kinetic_at_start\": " + number(s.kinetic_at_start()) +
           ", \"work_of_requests\": " + number(s.stepper().requests_work()) +
           ", \"work_of_removed\": " + number(s.stepper().departed_work()) +
           ", \"unexplained\": " + number(publish::unexplained(s, totals)) + "}";
    out += ",\n  \"contacts\": [" + contacts_json(s) + "\n  ]";
    out += ",\n  \"cost_ns_per_step\": " + number(cost.mean()) + ",\n  \"cost_quartiles_ns\": " + quartiles(cost.step()) +
           ",\n  \"cost_of_server_ns_per_step\": " + number(cost.mean_of_host());
    out += ",\n  \"objects\": {" + objects + "\n  },\n  \"interactions\": {" + interactions + "\n  }\n}\n";
    return out;
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

}  // namespace plab::daemon
