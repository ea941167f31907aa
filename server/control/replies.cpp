#include "control/replies.h"

#include "simulation/requests/request_words.h"

namespace plab::control
{
namespace
{

wire::StepOutcome outcome_of(const simulation::StepOutcome& from)
{
    wire::StepOutcome out;
    for_each_member([](const char*, auto& to, const auto& value) { to = value; }, out, from);
    return out;
}

}  // namespace

wire::SwapReport report_of(const simulation::SwapReport& swap)
{
    wire::SwapReport out{swap.id, swap.from, swap.to, {}, swap.energy_before, outcome_of(swap.with_old), outcome_of(swap.with_new)};
    for (const simulation::TransferredField& f : swap.fields) out.fields.push_back({f.field, simulation::name_of(f.transfer)});
    return out;
}

wire::Reply reply_of(const simulation::Reply& reply)
{
    wire::Reply out;
    out.outcome = reply.done ? "done" : reply.late ? "late" : "refused";
    for (const Error& e : reply.errors) out.reasons.push_back(e.text());
    out.revision = reply.revision, out.step = reply.step, out.pause_ns = reply.pause_ns;
    out.trial = simulation::text_of(reply.trial);
    for (const simulation::SwapReport& swap : reply.swaps) out.swaps.push_back(report_of(swap));
    return out;
}

}  // namespace plab::control
