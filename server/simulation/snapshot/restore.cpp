// From a snapshot to a run.
#include <algorithm>
#include <tuple>

#include "simulation/simulation.h"
#include "simulation/snapshot/compare.h"
#include "simulation/snapshot/history.h"

namespace plab::simulation
{
namespace
{

/// Pairs under their new indices. Those whose detector or bodies are not there are left out.
template <class Pair, class List>
std::vector<Pair> put_together(const List& list, const world::Renumbering& now)
{
    std::vector<Pair> out;
    out.reserve(list.heads.size());
    std::size_t at = 0;
    for (const auto& head : list.heads)
    {
        Pair pair;
        static_cast<std::decay_t<decltype(head)>&>(pair) = head;
        pair.detector = now.component(head.detector), pair.a = now.ref(head.a), pair.b = now.ref(head.b);
        std::copy_n(list.points.begin() + static_cast<std::ptrdiff_t>(at), head.count, pair.contacts.begin());
        at += head.count;
        if (pair.detector != kNoIndex && pair.a.valid() && pair.b.valid()) out.push_back(pair);
    }
    return out;
}

/// `old` in the order of new indices; `now(i)` is the new index of old i.
template <class T, class Now>
std::vector<T> rearranged(const std::vector<T>& old, std::size_t size, Now now)
{
    std::vector<T> out(old.empty() ? 0 : size);
    for (std::uint32_t i = 0; i < old.size(); ++i)
        if (const std::uint32_t k = now(i); k < out.size()) out[k] = old[i];
    return out;
}

DivergenceMemory rearranged(const DivergenceMemory& old, const world::Renumbering& now, const world::World& world)
{
    const std::size_t components = world.components().size(), bodies = world.host().bodies.size(), shafts = world.host().shafts.size();
    const auto component = [&](std::uint32_t i) { return now.component(i); };
    const auto body = [&](std::uint32_t i) { return now.body(i); };
    const auto shaft = [&](std::uint32_t i) { return now.shaft(i); };
    DivergenceMemory out = old;
    out.start_work = rearranged(old.start_work, components, component), out.start_made = rearranged(old.start_made, components, component);
    out.passive = rearranged(old.passive, components, component);
    out.linear = rearranged(old.linear, bodies, body), out.spin = rearranged(old.spin, bodies, body);
    out.bodies_reported = rearranged(old.bodies_reported, bodies, body);
    out.turn = rearranged(old.turn, shafts, shaft), out.shafts_reported = rearranged(old.shafts_reported, shafts, shaft);
    out.tunnels.reported = rearranged(old.tunnels.reported, bodies, body);
    out.tunnels.sinking = rearranged(old.tunnels.sinking, bodies, body);
    return out;
}

/// Whether the states of all types are those that the snapshot knows: else a state that came to a type since has its default,
/// and no hash can be as it was.
bool knows_all_states(const world::Image& image, const world::World& world)
{
    const auto states = [](const world::Layout& layout)
    {
        std::vector<world::FieldLayout> out;
        for (const world::FieldLayout& field : layout.fields)
            if (field.kind == FieldKind::State) out.push_back(field);
        return out;
    };
    bool all = true;
    image.for_each([&](std::uint32_t, const world::Component& c, const world::Layout& layout)
                   { all = all && states(layout) == states(*world.table_of(world.find(c.id)).layout()); });
    return all;
}

}  // namespace

void restore_contacts(const ContactsImage& image, const world::Renumbering& now, const world::World& world, ContactCache& cache)
{
    cache.clear();
    cache.pairs() = put_together<PairState>(image.pairs, now);
    cache.parked_pairs() = put_together<PairState>(image.parked, now);
    cache.force_pairs() = put_together<ForcePair>(image.force_pairs, now);
    cache.parked_force_pairs() = put_together<ForcePair>(image.parked_force_pairs, now);
    cache.continue_ids(image.next_id);
    const auto before = [&](const auto& x, const auto& y)
    {
        const auto key = [&](const auto& p) { return std::tuple(world.rank(p.detector), world.rank(p.a), world.rank(p.b)); };
        return key(x) < key(y);
    };
    std::sort(cache.pairs().begin(), cache.pairs().end(), before);
    std::sort(cache.force_pairs().begin(), cache.force_pairs().end(), before);
}

Result<Simulation::Live> Simulation::revive(const SnapshotContent& from) const
{
    Live live;
    live.world = std::make_unique<world::World>(*types_);
    if (auto done = live.world->revive(from.world); !done) return done.errors();
    live.stepper = std::make_unique<Stepper>(*live.world, threads_);
    Stepper& stepper = *live.stepper;
    if (auto built = stepper.rebuild(); !built) return built.errors();
    live.world->load_host(from.world);

    const world::Renumbering now(from.world, *live.world);
    const auto component = [&](std::uint32_t i) { return now.component(i); };
    const std::size_t components = live.world->components().size();
    restore_contacts(from.contacts, now, *live.world, stepper.contacts());
    stepper.work() = rearranged(from.ledger.work, components, component);
    stepper.work().resize(components, 0.0);
    stepper.contact_energy() = rearranged(from.ledger.contact_energy, components, component);
    stepper.contact_energy().resize(components);
    stepper.departed_work() = from.ledger.departed, stepper.requests_work() = from.ledger.requests;
    stepper.reported() = {from.reported.stiff, rearranged(from.reported.contradictory, components, component)};
    stepper.reported().contradictory.resize(components, 0);
    stepper.continue_split(from.split);
    stepper.continue_after(from.clock.last_tick, from.clock.last_start, from.clock.last_step);
    if (stepper.state_hash() == from.state_hash || !knows_all_states(from.world, *live.world)) return live;

    std::string where = "no component shows where; a file of another version of plabd may have made its hash another way";
    const ContactsImage contacts = image_of(stepper.contacts());
    if (const auto difference = compare_worlds(from.world, from.contacts, live.world->image(), contacts)) where = difference->text();
    return reason("the restored state is not the one that was captured: " + where);
}

void Simulation::continue_from(const SnapshotContent& from)
{
    const ClockImage& clock = from.clock;
    tick_ = clock.tick, dt_ = clock.dt, base_tick_ = clock.base_tick, base_time_ = clock.base_time;
    paused_ = clock.paused, steps_left_ = clock.steps_left, rate_ = clock.rate;
    kinetic_at_start_ = from.ledger.kinetic_at_start;
    watch_->recall(rearranged(from.watch, world::Renumbering(from.world, *world_), *world_));
    // Whoever waited then goes on waiting. The others posted to a run that is over.
    std::erase_if(requests_,
                  [&](const Waiting& w) { return std::find(from.waiting.begin(), from.waiting.end(), w.request) != from.waiting.end(); });
    for (const auto& request : from.waiting) requests_.push_back({request, run_});
}

Result<void> Simulation::restore(const Snapshot& snapshot)
{
    if (!snapshot) return reason("there is no snapshot to restore");
    auto live = revive(*snapshot);
    if (!live) return live.errors();
    begin_run(live.take(), snapshot->loaded);
    continue_from(*snapshot);
    history_->begin(*this);
    return {};
}

}  // namespace plab::simulation
