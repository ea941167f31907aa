#include "simulation/contacts.h"

#include <algorithm>
#include <tuple>

namespace plab::simulation
{
namespace
{

auto key_of(const world::World& world, std::uint32_t detector, Ref a, Ref b)
{
    return std::tuple(world.rank(detector), world.rank(a), world.rank(b));
}

auto key_of(const world::World& world, const PairState& p) { return key_of(world, p.detector, p.a, p.b); }

std::vector<PairState>::iterator position_of(std::vector<PairState>& pairs, const world::World& world, std::uint32_t detector, Ref a, Ref b)
{
    const auto key = key_of(world, detector, a, b);
    return std::lower_bound(pairs.begin(), pairs.end(), key, [&](const PairState& p, const auto& k) { return key_of(world, p) < k; });
}

}  // namespace

PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world)
{
    const auto at = position_of(pairs_, world, detector, a, b);
    return at != pairs_.end() && at->detector == detector && at->a == a && at->b == b ? &*at : nullptr;
}

PairState& ContactCache::get_or_add(std::uint32_t detector, Ref a, Ref b, const world::World& world, Tick now, bool& added)
{
    auto at = position_of(pairs_, world, detector, a, b);
    added = !(at != pairs_.end() && at->detector == detector && at->a == a && at->b == b);
    if (!added) return *at;
    PairState fresh;
    fresh.detector = detector, fresh.a = a, fresh.b = b, fresh.since = now;
    return *pairs_.insert(at, fresh);
}

KnownContact& ContactCache::contact_of(PairState& pair, std::uint32_t feature)
{
    for (std::uint32_t i = 0; i < pair.count; ++i)
        if (pair.contacts[i].feature == feature) return pair.contacts[i];
    // A full manifold gives its last place away: ids beyond it are of no use to anybody.
    const std::uint32_t place = std::min<std::uint32_t>(pair.count, PairState::kMostContacts - 1);
    pair.count = place + 1;
    pair.contacts[place] = {feature, next_id_++, {}};
    return pair.contacts[place];
}

void ContactCache::refresh(const world::World& world, const std::vector<Detector>& detectors)
{
    const auto gone = [&](const PairState& p)
    {
        const bool has_detector =
            std::any_of(detectors.begin(), detectors.end(), [&](const Detector& d) { return d.component == p.detector; });
        const auto lives = [&](Ref r) { return world.host().component_of(r) != kNoIndex; };
        return !has_detector || !lives(p.a) || !lives(p.b);
    };
    std::erase_if(pairs_, gone);
    for (PairState& p : pairs_)
    {
        // Where nobody responds any more nothing stands: a sensor holds no body up.
        const bool answered =
            std::any_of(detectors.begin(), detectors.end(), [&](const Detector& d) { return d.component == p.detector && d.responds; });
        if (answered) continue;
        p.resting = false;
        for (KnownContact& k : p.contacts) k.impulse = {};
    }
    std::sort(pairs_.begin(), pairs_.end(), [&](const PairState& x, const PairState& y) { return key_of(world, x) < key_of(world, y); });
}

void ContactCache::save(const world::World& world, ByteWriter& out) const
{
    for (const PairState& p : pairs_)
    {
        write(out, world.rank(p.a));
        write(out, world.rank(p.b));
        write(out, p.resting);
        write(out, p.overlapping);
        write(out, p.normal);
        for (std::uint32_t i = 0; i < p.count; ++i)
        {
            write(out, p.contacts[i].feature);
            write(out, p.contacts[i].id);
            write(out, p.contacts[i].impulse);
        }
    }
}

std::vector<Detector> find_detectors(const world::World& world, const Schedule& schedule)
{
    std::vector<Detector> out;
    const auto runs = [&](std::uint32_t component, Phase phase)
    {
        if (component == kNoIndex || world.component(component).quarantined) return false;
        const auto& c = world.component(component);
        const auto& commands = world.type_of(component)->info.commands;
        for (std::size_t k = 0; k < commands.size(); ++k)
            if (commands[k].phase == phase && commands[k].run && (c.commands & (1ull << k))) return true;
        return false;
    };
    for (const Block& block : schedule.of(Phase::Detect))
        for (const Row row : block.rows)
        {
            const world::Table& table = *world.tables()[block.table];
            Detector d;
            d.component = table.component_of_row()[row], d.table = block.table, d.row = row, d.command = block.command;
            for (const Role& role : table.schema().roles())
            {
                if (role.name == "resolution" && role.one) d.resolution = (*role.one)[row].index;
                if (role.name == "response" && role.one) d.response = (*role.one)[row].index;
            }
            d.responds = runs(d.response, Phase::Respond);
            d.locates = runs(d.resolution, Phase::Locate) && world.type_of(d.resolution)->info.locates;
            d.local = d.locates && world.type_of(d.resolution)->info.local;
            out.push_back(d);
        }
    std::sort(out.begin(), out.end(),
              [&](const Detector& x, const Detector& y) { return world.rank(x.component) < world.rank(y.component); });
    return out;
}

void sort_contacts(std::vector<FoundContact>& contacts, const world::World& world)
{
    const auto key = [&](const FoundContact& f)
    { return std::tuple(f.detector, world.rank(f.contact.a), world.rank(f.contact.b), f.contact.feature); };
    std::sort(contacts.begin(), contacts.end(), [&](const FoundContact& x, const FoundContact& y) { return key(x) < key(y); });
}

}  // namespace plab::simulation
