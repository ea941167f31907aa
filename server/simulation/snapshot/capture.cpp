// From a run to a snapshot.
#include "simulation/simulation.h"

namespace plab::simulation
{
namespace
{

/// Heads and points of a list of pairs, apart.
template <class Out, class Pair, class Head>
Out taken_apart(const std::vector<Pair>& pairs, std::vector<Head> Out::*heads)
{
    Out out;
    (out.*heads).reserve(pairs.size());
    std::size_t points = 0;
    for (const Pair& p : pairs) points += p.count;
    out.points.reserve(points);
    for (const Pair& p : pairs)
    {
        (out.*heads).push_back(p);
        out.points.insert(out.points.end(), p.contacts.begin(), p.contacts.begin() + p.count);
    }
    return out;
}

}  // namespace

ContactsImage image_of(const ContactCache& cache)
{
    ContactsImage out;
    out.pairs = taken_apart(cache.pairs(), &ContactsImage::Pairs::heads);
    out.parked = taken_apart(cache.parked_pairs(), &ContactsImage::Pairs::heads);
    out.force_pairs = taken_apart(cache.force_pairs(), &ContactsImage::ForcePairs::heads);
    out.parked_force_pairs = taken_apart(cache.parked_force_pairs(), &ContactsImage::ForcePairs::heads);
    out.next_id = cache.next_id();
    return out;
}

Snapshot Simulation::capture() const
{
    if (!world_) return {};
    auto out = std::make_shared<SnapshotContent>();
    const StepFrame& last = stepper_->frame();
    out->world = world_->image();
    out->loaded = loaded_;
    out->contacts = image_of(stepper_->contacts());
    out->clock = {tick_, dt_, base_tick_, base_time_, paused_, steps_left_, rate_, last.tick, last.start_time, last.step};
    out->ledger = {stepper_->work(), stepper_->contact_energy(), stepper_->departed_work(), stepper_->requests_work(), kinetic_at_start_};
    out->reported = stepper_->reported(), out->split = stepper_->split();
    out->watch = watch_->memory();
    out->run = run_, out->revision = revision_;
    out->state_hash = state_hash();
    for (const Waiting& w : requests_)
        if (w.run == run_) out->waiting.push_back(w.request);
    return Snapshot(std::move(out));
}

}  // namespace plab::simulation
