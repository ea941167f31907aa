// results.json. The schema is in server/docs/study.md.
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/numbers.h"
#include "study/write.h"

namespace plab::study
{
namespace
{

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

template <class T>
Json optional(const std::optional<T>& v)
{
    return v ? Json(*v) : Json(nullptr);
}

Json json_of(const Distance& d)
{
    return {{"series", number(d.series)},
            {"final", number(d.last)},
            {"series_absolute", number(d.series_absolute)},
            {"final_absolute", number(d.last_absolute)}};
}

Json json_of(const std::map<std::string, double>& values)
{
    Json out = Json::object();
    for (const auto& [name, v] : values) out[name] = number(v);
    return out;
}

Json json_of(const Vec3& v) { return {number(v.x), number(v.y), number(v.z)}; }

Json json_of(const simulation::Reply& reply)
{
    Json out{{"step", reply.step},
             {"done", reply.done},
             {"pause_ns", number(reply.pause_ns)},
             {"errors", Json::array()},
             {"swaps", Json::array()}};
    for (const Error& e : reply.errors) out["errors"].push_back(e.text());
    for (const simulation::SwapReport& s : reply.swaps)
    {
        const auto outcome = [](const simulation::StepOutcome& o)
        {
            return Json{{"energy", number(o.energy)},
                        {"momentum", json_of(o.momentum)},
                        {"error", number(o.error)},
                        {"cost_ns", number(o.cost_ns)}};
        };
        out["swaps"].push_back({{"id", s.id},
                                {"from", s.from},
                                {"to", s.to},
                                {"energy_before", number(s.energy_before)},
                                {"with_old", outcome(s.with_old)},
                                {"with_new", outcome(s.with_new)}});
    }
    return out;
}

Json parts_of(const RunRecord& x)
{
    Json out = Json::array();
    for (const PartFigures& p : x.parts)
        out.push_back({{"id", p.id},
                       {"requested", p.requested},
                       {"resolved", p.resolved},
                       {"error", number(p.error)},
                       {"outputs", json_of(p.outputs)},
                       {"largest", json_of(p.largest)}});
    return out;
}

Json energy_of(const Point& p)
{
    const EnergySeries& e = p.record.energy;
    Json out{{"drift", number(p.energy_drift)},
             {"scale", number(e.scale)},
             {"time", e.time},
             {"energy", Json::array()},
             {"drift_series", Json::array()}};
    for (const double v : e.energy) out["energy"].push_back(number(v));
    for (const double v : e.drift) out["drift_series"].push_back(number(v));
    return out;
}

Json point_of(const StudyResult& r, const Point& p)
{
    const RunRecord& x = p.record;
    Json settings = Json::object(), errors = Json::object();
    for (const Setting& s : p.combination.settings) settings[s.target] = s.value;
    for (std::size_t k = 0; k < r.quantities.size() && k < p.errors.size(); ++k)
    {
        errors[r.quantities[k].name] = json_of(p.errors[k]);
        errors[r.quantities[k].name]["resolved"] = static_cast<bool>(p.resolved[k]);
    }
    Json out{{"algorithm", p.combination.algorithm},
             {"settings", settings},
             {"dt", number(x.dt)},
             {"outcome", name_of(x.outcome)},
             {"why", x.why},
             {"reached", number(x.reached)},
             {"steps", x.steps},
             {"hash", model::hash_text(x.hash)},
             {"error", number(p.error())},
             {"final_error", number(p.final_error())},
             {"digits", number(digits(p.error()))},
             {"errors", errors}};
    out["cpu"] = {{"min", number(p.cpu_min)},
                  {"median", number(p.cpu_median)},
                  {"per_simulated_second", number(p.cpu_per_second())},
                  {"per_step", number(p.cpu_per_step())},
                  {"runs", p.timed}};
    out["energy"] = energy_of(p);
    out["momentum_change"] = number(x.momentum_change), out["angular_momentum_change"] = number(x.angular_momentum_change);
    out["shaft_momentum_change"] = number(x.shaft_momentum_change);
    out["violation"] = number(x.violation), out["penetration"] = number(x.penetration), out["residual"] = number(x.residual);
    out["impacts"] = p.contacts.known ? Json{{"expected", p.contacts.expected},
                                             {"missed", p.contacts.missed},
                                             {"extra", p.contacts.extra},
                                             {"time_error", number(p.contacts.worst_time_error)}}
                                      : Json(nullptr);
    out["evaluations"] = x.evaluations, out["allocations"] = optional(x.allocations);
    out["trials"] = x.trials, out["rewinds"] = x.rewinds, out["events"] = x.events, out["warnings"] = x.warnings,
    out["first_warning"] = x.first_warning;
    out["components"] = parts_of(x);
    out["swaps"] = Json::array();
    for (const simulation::Reply& reply : x.swaps) out["swaps"].push_back(json_of(reply));
    return out;
}

Json reference_of(const StudyResult& r)
{
    Json out{{"kind", r.reference.kind}, {"words", r.reference.words}, {"converges", r.reference.converges}, {"quantities", Json::array()}};
    for (std::size_t k = 0; k < r.quantities.size(); ++k)
        out["quantities"].push_back(
            {{"name", r.quantities[k].name},
             {"unit", r.quantities[k].unit},
             {"scale", number(r.reference.scale[k])},
             {"uncertainty", json_of(r.reference.uncertainty[k])},
             {"observed_order", number(r.reference.order[k])},
             {"converged", k < r.reference.converged.size() ? Json(bool{r.reference.converged[k]}) : Json(nullptr)}});
    return out;
}

}  // namespace

std::string results_json(const StudyResult& r)
{
    Json out{{"schema", "plab-study 1"}, {"title", r.title},         {"scene", r.scene_file},
             {"command", r.command},     {"until", number(r.until)}, {"repeat", r.repeat}};
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
