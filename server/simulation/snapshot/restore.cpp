// From a snapshot to a run.
#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

#include "simulation/snapshot/compare.h"
#include "simulation/snapshot/snapshot.h"

namespace plab::simulation
{
namespace
{

void fill_points(PairState& pair, std::span<const KnownContact> points)
{
    pair.contacts.reserve(pair.count, 0);
    std::copy(points.begin(), points.end(), pair.contacts.begin());
}

void fill_points(ForcePair& pair, std::span<const ForceContact> points) { std::copy(points.begin(), points.end(), pair.contacts.begin()); }

/// Rebuilds the pairs with their new indices. Pairs whose detector or bodies do not exist any more are left out.
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
        fill_points(pair, std::span(list.points).subspan(at, head.count));
        at += head.count;
        if (pair.detector != kNoIndex && pair.a.valid() && pair.b.valid()) out.push_back(std::move(pair));
    }
    return out;
}

/// `old` in the order of the new indices; `now(i)` is the new index of old index i.
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
    out.start_work = rearranged(old.start_work, components, component),
    out.start_created = rearranged(old.start_created, components, component);
    out.passive = rearranged(old.passive, components, component);
    out.linear = rearranged(old.linear, bodies, body), out.spin = rearranged(old.spin, bodies, body);
    out.bodies_reported = rearranged(old.bodies_reported, bodies, body);
    out.turn = rearranged(old.turn, shafts, shaft), out.shafts_reported = rearranged(old.shafts_reported, shafts, shaft);
    out.tunnels.reported = rearranged(old.tunnels.reported, bodies, body);
    out.tunnels.sinking = rearranged(old.tunnels.sinking, bodies, body);
    return out;
}

/// Whether the snapshot knows exactly the state fields of all present types. If a type has gained a state field since, that field has its
/// default value and the hash cannot match, so it is not checked.
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
    cache.assign(put_together<PairState>(image.pairs, now), world);
    cache.parked_pairs() = put_together<PairState>(image.parked, now);
    cache.force_pairs() = put_together<ForcePair>(image.force_pairs, now);
    cache.parked_force_pairs() = put_together<ForcePair>(image.parked_force_pairs, now);
    cache.continue_ids(image.next_id);
    cache.rest().bodies = rearranged(image.rest, world.host().bodies.size(), [&](std::uint32_t b) { return now.body(b); });
    cache.rest().scene_cause = image.rest_cause;
    for (std::uint32_t b = 0; b < image.crowded_until.size(); ++b)
    {
        const std::uint32_t to = now.body(b);
        if (to == kNoIndex || !std::isfinite(image.crowded_until[b])) continue;
        cache.crowded_until().resize(world.host().bodies.size(), -HUGE_VAL);
        cache.crowded_until()[to] = image.crowded_until[b];
    }
    const auto before = [&](const auto& x, const auto& y)
    {
        const auto key = [&](const auto& p) { return std::tuple(world.rank(p.detector), world.rank(p.a), world.rank(p.b)); };
        return key(x) < key(y);
    };
    std::sort(cache.force_pairs().begin(), cache.force_pairs().end(), before);
}

/// A restored run must continue with the same bits, although its world is a new one in which components and rows may have other numbers.
/// This works because all orders of computation are derived from ids, never from indices: what is ordered by id is the same in both
/// worlds, and indices only have to be translated (world::Renumbering). The order of the steps matters:
///   1. The world is built from the snapshot's scene and gets the values of all fields; opaque values are rebuilt by their types.
///   2. The stepper derives schedule, groups and constraint graph from that world. This also initialises tables of the server,
///      such as the anchors of gear trains, so
///   3. those tables are loaded after it, and overwrite what it has initialised.
///   4. Contacts, ledgers and memories of the watches are translated and put in place.
///   5. The hash of the result is compared with the captured one. It covers all states, so a mistake in steps 1 to 4 cannot stay unnoticed.
Result<LiveScene> revive(const RunContext& context, const SnapshotContent& from)
{
    LiveScene live;
    live.world = std::make_unique<world::World>(*context.types);
    if (auto done = live.world->revive(from.world); !done) return done.errors();
    live.stepper = std::make_unique<Stepper>(*live.world, context.threads);
    Stepper& stepper = *live.stepper;
    live.levels = std::make_unique<LevelBook>(*live.world, stepper);
    if (auto built = live.rebuild(); !built) return built.errors();
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
    stepper.reported() = {from.reported.stiff, from.reported.stiff_forces, rearranged(from.reported.contradictory, components, component)};
    stepper.reported().contradictory.resize(components, 0);
    stepper.continue_split(from.split);
    stepper.continue_after(from.clock.last_tick, from.clock.last_start, from.clock.last_step);
    if (stepper.state_hash() == from.state_hash || !knows_all_states(from.world, *live.world)) return live;

    std::string where = "no component differs; the version of plabd that wrote the file may compute the hash in another way";
    const ContactsImage contacts = image_of(stepper.contacts(), *live.world);
    if (const auto difference = compare_worlds(from.world, from.contacts, live.world->image(), contacts)) where = difference->text();
    return reason("the restored state differs from the captured one: " + where);
}

void continue_from(Run& run, const SnapshotContent& from)
{
    run.clock = from.clock;
    run.kinetic_at_start = from.ledger.kinetic_at_start;
    run.watch->recall(rearranged(from.watch, world::Renumbering(from.world, run.world()), run.world()));
    // Requests that were waiting at the capture wait again. All others belong to a run that has ended.
    std::erase_if(run.waiting, [&](const WaitingRequest& w)
                  { return std::find(from.waiting.begin(), from.waiting.end(), w.request) != from.waiting.end(); });
    for (const auto& request : from.waiting) run.waiting.push_back({request, run.number});
}

}  // namespace plab::simulation
