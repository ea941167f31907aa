// From a run to a snapshot.
#include "simulation/snapshot/snapshot.h"

namespace plab::simulation
{
namespace
{

/// Separates the heads and the contact points of a list of pairs.
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

ContactsImage image_of(const ContactCache& from, const world::World& world)
{
    ContactCache whole;
    if (!from.rest().islands.empty()) whole.copy(from), whole.bring_back(world);
    const ContactCache& cache = from.rest().islands.empty() ? from : whole;
    ContactsImage out;
    out.pairs = taken_apart(cache.pairs(), &ContactsImage::Pairs::heads);
    out.parked = taken_apart(cache.parked_pairs(), &ContactsImage::Pairs::heads);
    out.force_pairs = taken_apart(cache.force_pairs(), &ContactsImage::ForcePairs::heads);
    out.parked_force_pairs = taken_apart(cache.parked_force_pairs(), &ContactsImage::ForcePairs::heads);
    out.next_id = cache.next_id();
    out.rest = cache.rest().bodies, out.rest_cause = cache.rest().scene_cause;
    out.crowded_until = cache.crowded_until();
    return out;
}

/// Copies values only, no structure that follows from them, and shares the scene and the directory of ids with the run, which replaces
/// them when it changes (world/shared.h). So the cost is that of the numbers of the state, and the step thread can afford it. It is called
/// between two steps: inside a step, groups may be at different times.
Snapshot capture(const Run& run)
{
    if (!run.live.world) return {};
    auto out = std::make_shared<SnapshotContent>();
    const Stepper& stepper = run.stepper();
    const StepFrame& last = stepper.frame();
    out->world = run.world().image();
    out->loaded = run.loaded;
    out->contacts = image_of(stepper.contacts(), run.world());
    out->clock = {run.clock, last.tick, last.start_time, last.step};
    out->ledger = {stepper.work(), stepper.contact_energy(), stepper.departed_work(), stepper.requests_work(), run.kinetic_at_start};
    out->reported = stepper.reported(), out->split = stepper.split();
    out->watch = run.watch->memory();
    out->run = run.number, out->revision = run.revision;
    out->state_hash = stepper.state_hash();
    for (const WaitingRequest& w : run.waiting)
        if (w.run == run.number) out->waiting.push_back(w.request);
    return Snapshot(std::move(out));
}

}  // namespace plab::simulation
