#include "publish/sampler.h"

#include <cmath>
#include <utility>

#include "model/numbers.h"
#include "publish/entries.h"
#include "publish/figures.h"
#include "simulation/contacts/sleeping_pairs.h"
#include "simulation/costs/component_costs.h"

namespace plab::publish
{
namespace
{

/// Over a shorter real time, a rate would measure the clock rather than the run.
constexpr Nanoseconds kShortestWindow = 100'000'000;

void fill_ledger(const simulation::Simulation& s, wire::Metrics& out)
{
    const simulation::Totals totals = s.totals();
    out.ledger = {totals.kinetic, totals.stored, totals.work, s.stepper().requests_work(), unexplained(s, totals)};
    out.momentum = totals.momentum, out.angular_momentum = totals.angular_momentum;
}

wire::InteractionMetrics metrics_of(const simulation::Simulation& s, std::uint32_t i, std::string resolved,
                                    const simulation::ComponentCost& cost, ErrorFigure error)
{
    const world::World& world = s.world();
    wire::InteractionMetrics out;
    out.component_id = world.id_of(i), out.requested = world.type_of(i)->info.name, out.resolved = std::move(resolved);
    out.cost_ns = cost.last.median;
    if (!std::isnan(error.value)) out.error = error.value;
    out.work = i < s.stepper().work().size() ? s.stepper().work()[i] : 0.0;
    out.quarantined = world.component(i).quarantined;
    out.outputs = parameters_of(world, i, world::kind_bit(FieldKind::Output));
    const auto account = [&](const char* name, std::string text, std::string unit) {
        out.outputs.push_back({name, std::move(text), std::move(unit), "account"});
    };
    account("cost_quartiles", model::format_real(cost.last.low) + " " + model::format_real(cost.last.high), "ns");
    account("cost_steps", std::to_string(cost.last.samples), "");
    account("cost_shared_by", std::to_string(cost.shared), "");
    account(std::isnan(error.value) ? "no_error" : "error", std::move(error.meaning), std::move(error.unit));
    return out;
}

}  // namespace

void Sampler::read_rate(const simulation::Simulation& s, Nanoseconds now)
{
    // A rate across a reset, a restore or a rewind is meaningless.
    if (std::exchange(run_, s.run()) != s.run()) rate_since_ = 0, real_time_factor_ = 0;
    const Nanoseconds passed = now - rate_since_;
    if (rate_since_ != 0 && passed < kShortestWindow && s.time() >= rate_from_) return;
    const bool known = rate_since_ != 0 && s.time() >= rate_from_;
    real_time_factor_ = known ? (s.time() - rate_from_) * 1e9 / static_cast<double>(passed) : 0.0;
    rate_since_ = now, rate_from_ = s.time();
}

wire::Metrics Sampler::sample(const simulation::Simulation& s, Nanoseconds now)
{
    read_rate(s, now);
    errors_.follow(s, now);
    wire::Metrics out;
    out.run = s.run(), out.revision = s.revision(), out.step = s.tick(), out.time = s.time();
    out.step_ns = s.stepper().cost().step().median;
    out.real_time_factor = real_time_factor_;
    fill_ledger(s, out);
    out.residual = s.stepper().report().worst_residual, out.deepest = s.stepper().report().deepest;
    const simulation::ContactCache& contacts = s.stepper().contacts();
    out.contacts = static_cast<std::uint32_t>(contacts.force_pairs().size());
    contacts.each_pair([&](const simulation::PairState& p) { out.contacts += p.ahead ? 0 : 1; });
    std::vector<std::string> resolved = resolved_algorithms(s);
    const simulation::ComponentCosts costs(s.world(), s.stepper().cost());
    for (const std::uint32_t i : s.world().in_id_order())
    {
        const world::Component& c = s.world().component(i);
        if (is_interaction(c)) out.interactions.push_back(metrics_of(s, i, std::move(resolved[i]), costs.of(i), errors_.of(s, i)));
    }
    return out;
}

}  // namespace plab::publish
