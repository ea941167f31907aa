#include "control/recordings/swaps.h"

namespace plab::recordings
{
namespace
{

Swap swap_of(const Change& change) { return {change.run, change.step, {}, change.log_time, change.component, change.from, change.to, ""}; }

bool is_same(const Change& change, const Swap& swap)
{
    return change.run == swap.run && change.component == swap.component && change.step == swap.step;
}

}  // namespace

void Swaps::note(const Entry& entry)
{
    const auto* journal = entry.as<plab_v2_Journal>();
    if (journal == nullptr) return;
    has_journal_ = true;
    for (std::uint32_t i = 0; i < journal->operations._length; ++i)
    {
        const plab_v2_Operation& o = journal->operations._buffer[i];
        if (std::string_view(o.verb) != "swap") continue;
        swaps_.push_back({journal->run, journal->step, journal->time, entry.log_time, o.target, "", o.argument, journal->origin});
    }
}

std::vector<Swap> Swaps::all(const Things& things) const
{
    std::vector<Swap> out = swaps_;
    for (Swap& swap : out)
        for (const Change& change : things.changes())
            if (is_same(change, swap)) swap.from = change.from;
    if (has_journal_) return out;
    for (const Change& change : things.changes()) out.push_back(swap_of(change));
    return out;
}

}  // namespace plab::recordings
