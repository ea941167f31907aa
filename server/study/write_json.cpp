// results.json. The schema is in server/docs/study.md.
#include <nlohmann/json.hpp>

#include "control/replies.h"
#include "idl/json/json.h"
#include "model/numbers.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using wire::Json;
using wire::json_of;

template <class T>
Json optional(const std::optional<T>& v)
{
    return v ? Json(*v) : Json(nullptr);
}

Json distance_json(const Distance& d)
{
    return {{"series", d.series}, {"final", d.last}, {"series_absolute", d.series_absolute}, {"final_absolute", d.last_absolute}};
}

/// As plabctl prints it, without what only a server knows.
Json reply_json(const simulation::Reply& reply)
{
    Json out = json_of(control::reply_of(reply));
    for (const char* key : {"repeated", "run", "revision", "time", "waited_ns"}) out.erase(key);
    return out;
}

Json parts_of(const RunRecord& x)
{
    Json out = Json::array();
    for (const PartFigures& p : x.parts)
        out.push_back({{"id", p.id},
                       {"requested", p.requested},
                       {"resolved", p.resolved},
                       {"error", p.error},
                       {"outputs", p.outputs},
                       {"largest", p.largest}});
    return out;
}

Json energy_of(const Point& p)
{
    const EnergySeries& e = p.record.energy;
    Json out{{"drift", p.energy_drift}, {"scale", e.scale}, {"time", e.time}, {"energy", e.energy}, {"drift_series", e.drift}};
    return out;
}

Json point_of(const StudyResult& r, const Point& p)
{
    const RunRecord& x = p.record;
    Json settings = Json::object(), errors = Json::object();
    for (const Setting& s : p.combination.settings) settings[s.target] = s.value;
    for (std::size_t k = 0; k < r.quantities.size() && k < p.errors.size(); ++k)
    {
        errors[r.quantities[k].name] = distance_json(p.errors[k]);
        errors[r.quantities[k].name]["resolved"] = static_cast<bool>(p.resolved[k]);
    }
    Json out{{"algorithm", p.combination.algorithm},
             {"settings", settings},
             {"dt", x.dt},
             {"outcome", name_of(x.outcome)},
             {"why", x.why},
             {"reached", x.reached},
             {"steps", x.steps},
             {"hash", model::hash_text(x.hash)},
             {"error", p.error()},
             {"final_error", p.final_error()},
             {"digits", digits(p.error())},
             {"errors", errors}};
    out["cpu"] = {{"min", p.cpu_min},
                  {"median", p.cpu_median},
                  {"per_simulated_second", p.cpu_per_second()},
                  {"per_step", p.cpu_per_step()},
                  {"runs", p.timed}};
    out["energy"] = energy_of(p);
    out["momentum_change"] = x.momentum_change, out["angular_momentum_change"] = x.angular_momentum_change;
    out["shaft_momentum_change"] = x.shaft_momentum_change;
    out["violation"] = x.violation, out["penetration"] = x.penetration, out["residual"] = x.residual;
    out["impacts"] = p.contacts.known ? Json{{"expected", p.contacts.expected},
                                             {"missed", p.contacts.missed},
                                             {"extra", p.contacts.extra},
                                             {"time_error", p.contacts.worst_time_error}}
                                      : Json(nullptr);
    out["evaluations"] = x.evaluations, out["allocations"] = optional(x.allocations);
    out["trials"] = x.trials, out["rewinds"] = x.rewinds, out["events"] = x.events, out["warnings"] = x.warnings,
    out["first_warning"] = x.first_warning;
    out["components"] = parts_of(x);
    out["swaps"] = Json::array();
    for (const simulation::Reply& reply : x.swaps) out["swaps"].push_back(reply_json(reply));
    return out;
}

Json reference_of(const StudyResult& r)
{
    Json out{{"kind", r.reference.kind}, {"words", r.reference.words}, {"converges", r.reference.converges}, {"quantities", Json::array()}};
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
        out["quantities"].push_back(
            {{"name", r.quantities[k].name},
             {"unit", r.quantities[k].unit},
             {"scale", r.reference.scale[k]},
             {"uncertainty", distance_json(r.reference.uncertainty[k])},
             {"observed_order", r.reference.order[k]},
             {"converged", k < r.reference.converged.size() ? Json(bool{r.reference.converged[k]}) : Json(nullptr)}});
    return out;
}

}  // namespace

std::string results_json(const StudyResult& r)
{
    Json out{{"schema", "plab-study 2"}, {"title", r.title}, {"scene", r.scene_file},
             {"command", r.command},     {"until", r.until}, {"repeat", r.repeat}};
    out["machine"] = {{"processor", r.machine.processor},
                      {"system", r.machine.system},
                      {"compiler", r.machine.compiler},
                      {"flags", r.machine.flags},
                      {"version", r.machine.version}};
    out["notes"] = r.notes;
    out["findings"] = findings(r);
    out["reference"] = reference_of(r);
    out["points"] = Json::array();
    for (const Point& p : r.points) out["points"].push_back(point_of(r, p));
    return out.dump(1) + "\n";
}

}  // namespace plab::study
