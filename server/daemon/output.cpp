#include "daemon/output.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstring>

#include "publish/figures.h"
#include "world/host_tables.h"

namespace plab::daemon
{
namespace
{

std::string number(double v)
{
    if (!std::isfinite(v)) return "null";
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", v);
    return text;
}

std::string quoted(const std::string& s)
{
    std::string out = "\"";
    for (const char c : s)
    {
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (static_cast<unsigned char>(c) < 0x20)
        {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", c);
            out += code;
        }
        else
            out += c;
    }
    return out + "\"";
}

std::string array(const Vec3& v) { return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]"; }
std::string array(const Quat& q) { return "[" + number(q.w) + ", " + number(q.x) + ", " + number(q.y) + ", " + number(q.z) + "]"; }

/// What stands under "interactions": solvers have their groups (--explain).
bool is_listed(const world::World& world, std::uint32_t i)
{
    return publish::is_interaction(world.component(i)) && !publish::is_solver(world, i);
}

/// What has motion, or values, of its own.
bool is_told(const world::Component& c) { return publish::is_object(c) || c.facet == Facet::Quantities; }

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

std::string interaction_json(const simulation::Simulation& s, std::uint32_t i, double cost)
{
    const world::World& world = s.world();
    std::string out = "{\"type\": " + quoted(world.type_of(i)->info.name) + ", \"cost_ns_per_step\": " + number(cost) +
                      ", \"work\": " + number(s.stepper().work()[i]) + ", \"made\": " + number(s.stepper().contact_energy()[i].made) +
                      ", \"lifted\": " + number(s.stepper().contact_energy()[i].lifted) + ", \"error\": " + number(s.error_of(i));
    for (const Field& field : world.table_of(i).schema().fields())
    {
        if (field.kind != FieldKind::Output) continue;
        const Value v = world.get(i, field.name);
        if (const auto* d = std::get_if<double>(&v)) out += ", " + quoted(field.name) + ": " + number(*d);
        if (const auto* n = std::get_if<std::int64_t>(&v)) out += ", " + quoted(field.name) + ": " + std::to_string(*n);
    }
    return out + (world.component(i).quarantined ? ", \"quarantined\": true}" : "}");
}

/// A pair that touches: who, since which step, under which contact ids.
template <class Pair>
void append_pair(std::string& out, const simulation::Simulation& s, const Pair& pair, bool resting)
{
    std::string ids;
    for (std::uint32_t i = 0; i < pair.count; ++i) ids += (i == 0 ? "" : ", ") + std::to_string(pair.contacts[i].id);
    out += (out.empty() ? "" : ",") + std::string("\n    {\"detector\": ") + quoted(s.world().id_of(pair.detector)) +
           ", \"a\": " + quoted(s.world().id_of(pair.a)) + ", \"b\": " + quoted(s.world().id_of(pair.b)) +
           ", \"since\": " + std::to_string(pair.since) + ", \"resting\": " + (resting ? "true" : "false") + ", \"ids\": [" + ids + "]}";
}

/// Hard pairs, then those that are forces; the latter never rest.
std::string contacts_json(const simulation::Simulation& s)
{
    std::string out;
    for (const simulation::PairState& pair : s.stepper().contacts().pairs())
        if (!pair.ahead) append_pair(out, s, pair, pair.resting);
    for (const simulation::ForcePair& pair : s.stepper().contacts().force_pairs()) append_pair(out, s, pair, false);
    return out;
}

std::string hash_text(std::uint64_t h)
{
    char text[20];
    std::snprintf(text, sizeof text, "%016" PRIx64, h);
    return text;
}

}  // namespace

std::string end_state_json(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    const simulation::Totals totals = s.totals();
    const std::vector<double> costs = publish::cost_of_rows(s);
    std::string objects, interactions;
    for (const std::uint32_t i : world.in_id_order())
    {
        if (is_told(world.component(i)))
            objects += (objects.empty() ? "" : ",") + std::string("\n    ") + quoted(world.id_of(i)) + ": " + object_json(world, i);
        if (is_listed(world, i))
            interactions += (interactions.empty() ? "" : ",") + std::string("\n    ") + quoted(world.id_of(i)) + ": " +
                            interaction_json(s, i, publish::cost_of(costs, world.component(i)));
    }
    const auto& cost = s.stepper().cost();
    const double per_step = cost.steps == 0 ? 0 : static_cast<double>(cost.total) / static_cast<double>(cost.steps);
    std::string out = "{\n  \"time\": " + number(s.time()) + ",\n  \"step\": " + std::to_string(s.tick());
    out += ",\n  \"hash\": " + quoted(hash_text(s.state_hash()));
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
    out += ",\n  \"cost_ns_per_step\": " + number(per_step);
    out += ",\n  \"objects\": {" + objects + "\n  },\n  \"interactions\": {" + interactions + "\n  }\n}\n";
    return out;
}

Result<std::unique_ptr<Trace>> Trace::open(const std::string& file, const simulation::Simulation& s, double every)
{
    std::unique_ptr<Trace> trace(new Trace);
    trace->file_.reset(std::fopen(file.c_str(), "w"));
    if (!trace->file_) return reason("cannot write " + file + ": " + std::strerror(errno));
    trace->every_ = every;
    std::string header = "time,step,hash,energy,kinetic,momentum_x,momentum_y,momentum_z";
    for (const std::uint32_t i : s.world().in_id_order())
    {
        const world::Component& c = s.world().component(i);
        if (!is_told(c)) continue;
        if (c.facet == Facet::Quantities)
        {
            const std::size_t count = s.world().host().quantities.value[c.host_index].size();
            trace->objects_.push_back({c.id, count});
            for (std::size_t k = 1; k <= count; ++k) header += "," + c.id + ".values." + std::to_string(k);
            continue;
        }
        trace->objects_.push_back({c.id, c.facet == Facet::Shaft ? 2u : 13u});
        const char* const shaft[] = {"angle", "angular_velocity"};
        const char* const body[] = {"position.x",        "position.y",        "position.z",         "orientation.w",
                                    "orientation.x",     "orientation.y",     "orientation.z",      "linear_velocity.x",
                                    "linear_velocity.y", "linear_velocity.z", "angular_velocity.x", "angular_velocity.y",
                                    "angular_velocity.z"};
        if (c.facet == Facet::Shaft)
            for (const char* name : shaft) header += "," + c.id + "." + name;
        else
            for (const char* name : body) header += "," + c.id + "." + name;
    }
    std::fprintf(trace->file_.get(), "%s\n", header.c_str());
    return trace;
}

void Trace::sample(const simulation::Simulation& s, bool last)
{
    if (s.tick() == last_ || (!last && s.time() < next_ * (1 - 1e-12))) return;
    last_ = s.tick();
    while (every_ > 0 && next_ <= s.time() * (1 + 1e-12)) next_ += every_;
    const simulation::Totals t = s.totals();
    std::string row = number(s.time()) + "," + std::to_string(s.tick()) + "," + hash_text(s.state_hash()) + "," +
                      number(t.kinetic + t.stored) + "," + number(t.kinetic) + "," + number(t.momentum.x) + "," + number(t.momentum.y) +
                      "," + number(t.momentum.z);
    for (const auto& [id, columns] : objects_)
    {
        const std::uint32_t i = s.world().find(id);
        const bool there = i != kNoIndex && is_told(s.world().component(i));
        if (there && s.world().component(i).facet == Facet::Quantities)
        {
            const std::vector<double>& values = s.world().host().quantities.value[s.world().component(i).host_index];
            for (std::size_t k = 0; k < columns; ++k) row += "," + (k < values.size() ? number(values[k]) : std::string());
            continue;
        }
        if (!there)
        {
            row += std::string(columns, ',');  // gone: its columns stay empty
            continue;
        }
        const world::Component& c = s.world().component(i);
        if (c.facet == Facet::Shaft)
        {
            row += "," + number(s.world().host().shafts.angle[c.host_index]) + "," + number(s.world().host().shafts.speed[c.host_index]);
            continue;
        }
        const auto hosted = [&](const char* name) { return world::get_hosted(s.world().host(), Facet::Body, c.host_index, name); };
        const auto add = [&](const Vec3& v) { row += "," + number(v.x) + "," + number(v.y) + "," + number(v.z); };
        const Quat q = std::get<Quat>(hosted("orientation"));
        add(std::get<Vec3>(hosted("position")));
        row += "," + number(q.w) + "," + number(q.x) + "," + number(q.y) + "," + number(q.z);
        add(std::get<Vec3>(hosted("linear_velocity")));
        add(std::get<Vec3>(hosted("angular_velocity")));
    }
    std::fprintf(file_.get(), "%s\n", row.c_str());
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
