#include "study/observe.h"

#include <algorithm>
#include <cmath>

#include "model/values.h"
#include "publish/figures.h"

namespace plab::study
{
namespace
{

/// Limit, so that a chattering contact cannot exhaust the memory.
constexpr std::size_t kMostContacts = 20'000;

/// The components whose algorithms a study compares.
bool is_of_interest(const std::string& type)
{
    for (const char* kind : {"Solver/", "Manager/", "Response/", "Resolution/", "Constraint/", "CDetection/", "Script/"})
        if (type.starts_with(kind)) return true;
    return false;
}

std::optional<double> number_of(const Value& v)
{
    if (const auto* d = std::get_if<double>(&v)) return *d;
    if (const auto* n = std::get_if<std::int64_t>(&v)) return static_cast<double>(*n);
    return {};
}

void grow(double& largest, double value)
{
    if (value > largest || std::isnan(value)) largest = value;
}

}  // namespace

double unstored_work(const simulation::Simulation& s)
{
    const simulation::Stepper& stepper = s.stepper();
    double work = stepper.departed_work() + stepper.requests_work();
    for (const std::uint32_t i : s.world().in_id_order())
    {
        const model::ComponentType* type = s.world().type_of(i);
        if (i < stepper.work().size() && type && !type->takes_part(Phase::Potential)) work += stepper.work()[i];
    }
    return work;
}

bool energy_goes_unseen(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    const auto real = [&](std::uint32_t i, const char* name) { return number_of(world.get(i, name)); };
    for (const std::uint32_t i : world.in_id_order())
    {
        const model::ComponentType* type = world.type_of(i);
        if (!type) continue;
        // Within a step, impulses and rows take back what forces added: only the sum of their works is meaningful.
        const bool stores = type->takes_part(Phase::Potential);
        if (type->info.name.starts_with("Response/") && (stores || type->info.name != "Response/None")) return true;
        if (!stores) continue;
        for (const char* name : {"damping", "damping_ratio", "dissipation"})
            if (real(i, name).value_or(0) > 0) return true;
    }
    return false;
}

double unexplained_energy(const simulation::Simulation& s, const simulation::Totals& t, bool by_work)
{
    return by_work ? t.kinetic - t.work : t.kinetic + t.stored - unstored_work(s);
}

Observation::Observation(const simulation::Simulation& s, RunRecord& out)
    : simulation_(&s),
      out_(&out),
      start_(s.totals()),
      by_work_(energy_goes_unseen(s)),
      unexplained_at_start_(unexplained_energy(s, start_, by_work_))
{
    for (const std::uint32_t i : s.world().in_id_order())
    {
        const model::ComponentType* type = s.world().type_of(i);
        if (!type || !is_of_interest(type->info.name)) continue;
        PartFigures part;
        part.id = s.world().id_of(i), part.requested = type->info.name;
        out.parts.push_back(std::move(part));
    }
}

void Observation::note(const Event& e)
{
    ++out_->events[e.kind];
    // A manager that does not converge reports this each time, and continues: for a study, that is a result.
    if (e.severity != Severity::Info || e.kind.ends_with("not_converged"))
    {
        if (out_->warnings.empty()) out_->first_warning = e.kind + (e.message.empty() ? "" : ": " + e.message);
        ++out_->warnings[e.kind];
    }
    if (e.kind != "contact.begin" && e.kind != "contact.impact") return;
    if (out_->contacts.size() >= kMostContacts)
    {
        out_->contacts_cut = true;
        return;
    }
    out_->contacts.push_back({e.kind, simulation_->world().id_of(e.a), simulation_->world().id_of(e.b), e.time});
}

void Observation::step()
{
    for (const Event& e : simulation_->events()) note(e);
    const simulation::StepReport& report = simulation_->stepper().report();
    grow(out_->penetration, report.deepest);
    grow(out_->residual, report.worst_residual);
    out_->trials += static_cast<std::uint64_t>(report.trials);
    out_->rewinds += static_cast<std::uint64_t>(report.rewinds);
    out_->evaluations += report.evaluations;
}

void Observation::sample_energy(const simulation::Totals& t)
{
    EnergySeries& e = out_->energy;
    e.time.push_back(simulation_->time()), e.energy.push_back(t.kinetic + t.stored);
    e.drift.push_back(unexplained_energy(*simulation_, t, by_work_) - unexplained_at_start_);
    grow(e.scale, std::max(t.kinetic, std::fabs(t.stored - start_.stored)));
}

void Observation::sample_momenta(const simulation::Totals& t)
{
    grow(out_->momentum_change, length(t.momentum - start_.momentum));
    grow(out_->angular_momentum_change, length(t.angular_momentum - start_.angular_momentum));
    grow(out_->shaft_momentum_change, std::fabs(t.shaft_momentum - start_.shaft_momentum));
    grow(out_->momentum_scale, length(t.momentum));
    grow(out_->angular_momentum_scale, length(t.angular_momentum));
}

void Observation::sample_parts()
{
    for (PartFigures& part : out_->parts)
    {
        const std::uint32_t i = simulation_->world().find(part.id);
        if (i == kNoIndex) continue;
        grow(part.error, simulation_->error_of(i));
        if (part.requested.starts_with("Constraint/")) grow(out_->violation, simulation_->error_of(i));
        for (const Field& f : simulation_->world().table_of(i).schema().fields())
        {
            if (f.kind != FieldKind::Output || f.type != FieldType::Integer) continue;
            grow(part.largest[f.name], *number_of(simulation_->world().get(i, f.name)));
        }
    }
}

void Observation::sample()
{
    out_->times.push_back(simulation_->time());
    for (std::size_t k = 0; k < out_->quantities.size(); ++k) read(simulation_->world(), out_->quantities[k], out_->time_series[k].values);
    const simulation::Totals totals = simulation_->totals();
    sample_energy(totals);
    sample_momenta(totals);
    sample_parts();
}

void Observation::finish()
{
    const std::vector<std::string> words = publish::resolved_algorithms(*simulation_);
    for (PartFigures& part : out_->parts)
    {
        const std::uint32_t i = simulation_->world().find(part.id);
        if (i == kNoIndex) continue;
        part.resolved = words[i];
        for (const Field& f : simulation_->world().table_of(i).schema().fields())
        {
            if (f.kind != FieldKind::Output) continue;
            const Value v = simulation_->world().get(i, f.name);
            if (const auto x = number_of(v)) part.outputs[f.name] = *x;
            if (const auto* text = std::get_if<std::string>(&v); text && f.name == "resolved" && part.resolved.empty())
                part.resolved = *text;
        }
    }
}

}  // namespace plab::study
