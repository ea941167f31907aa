#include "simulation/contacts/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plab::simulation
{
namespace
{

PairKey key_of(const world::World& world, const PairState& p) { return {world, p.detector, p.a, p.b}; }

}  // namespace

std::size_t ContactCache::place_of(const PairKey& key) const
{
    return static_cast<std::size_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
}

PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world)
{
    const PairKey key(world, detector, a, b);
    const std::size_t at = place_of(key);
    return is_at(at, key) ? &pairs_[at] : nullptr;
}

/// Searches from `near` in steps that double, and then between the last two places.
const PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near) const
{
    const PairKey key(world, detector, a, b);
    std::size_t first = std::min(near, keys_.size()), end = first;
    if (first > 0 && keys_[first - 1] >= key)
        first = 0;
    else
        for (std::size_t stride = 1; end < keys_.size() && keys_[end] < key; stride *= 2)
            first = end + 1, end = std::min(end + stride, keys_.size());
    const auto from = keys_.begin();
    near = static_cast<std::size_t>(
        std::lower_bound(from + static_cast<std::ptrdiff_t>(first), from + static_cast<std::ptrdiff_t>(end), key) - from);
    return is_at(near, key) ? &pairs_[near] : nullptr;
}

PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near)
{
    return const_cast<PairState*>(std::as_const(*this).find(detector, a, b, world, near));
}

PairState& ContactCache::get_or_add(std::uint32_t detector, Ref a, Ref b, const world::World& world, Tick now, bool& added)
{
    const PairKey key(world, detector, a, b);
    const std::size_t at = place_of(key);
    added = !is_at(at, key);
    if (!added) return pairs_[at];
    PairState fresh;
    fresh.detector = detector, fresh.a = a, fresh.b = b, fresh.since = now;
    keys_.insert(keys_.begin() + static_cast<std::ptrdiff_t>(at), key);
    return *pairs_.insert(pairs_.begin() + static_cast<std::ptrdiff_t>(at), std::move(fresh));
}

void ContactCache::add_sorted(std::span<const PairState> fresh, const world::World& world)
{
    // Merged from the back, so that each pair moves once.
    std::size_t old = pairs_.size(), at = old + fresh.size();
    pairs_.resize(at), keys_.resize(at);
    for (std::size_t next = fresh.size(); next > 0; --next)
    {
        const PairKey key = key_of(world, fresh[next - 1]);
        for (; old > 0 && key < keys_[old - 1]; --old) --at, pairs_[at] = std::move(pairs_[old - 1]), keys_[at] = keys_[old - 1];
        --at, pairs_[at] = fresh[next - 1], keys_[at] = key;
    }
}

/// Keeps the first `size` pairs, and the memory of the others.
void ContactCache::shrink(std::size_t size)
{
    for (std::size_t i = size; i < pairs_.size(); ++i) pool_.recycle(pairs_[i].contacts);
    pairs_.resize(size), keys_.resize(size);
}

void ContactCache::erase(PairState& pair)
{
    drop_if([&](const PairState& p) { return &p == &pair; });
}

void ContactCache::assign(std::vector<PairState> pairs, const world::World& world)
{
    pairs_ = std::move(pairs);
    sort(world);
    may_have_rest_depth_ = true;
}

void ContactCache::sort(const world::World& world)
{
    const auto before = [&](const PairState& x, const PairState& y) { return key_of(world, x) < key_of(world, y); };
    if (!std::is_sorted(pairs_.begin(), pairs_.end(), before)) std::sort(pairs_.begin(), pairs_.end(), before);
    keys_.clear();
    for (const PairState& p : pairs_) keys_.push_back(key_of(world, p));
}

KnownContact& ContactCache::search_contact(PairState& pair, std::uint32_t feature)
{
    for (KnownContact& known : pair.all())
        if (known.feature == feature) return known;
    // If the manifold is full, its last slot is reused.
    const std::uint32_t place = std::min(pair.count, PairState::kMostContacts - 1);
    pool_.reserve(pair.contacts, place + 1, place);
    pair.count = place + 1;
    KnownContact& fresh = pair.contacts[place] = {};
    fresh.feature = feature, fresh.id = next_id_++;
    return fresh;
}

const KnownContact* ContactCache::find_contact(std::uint32_t detector, Ref a, Ref b, std::uint32_t feature, const world::World& world)
{
    const PairState* pair = find(detector, a, b, world);
    if (!pair) return nullptr;
    const std::span<const KnownContact> all = pair->all();
    const auto found = std::find_if(all.begin(), all.end(), [&](const KnownContact& k) { return k.feature == feature; });
    return found == all.end() ? nullptr : &*found;
}

void ContactCache::copy(const ContactCache& from)
{
    shrink(std::min(pairs_.size(), from.pairs_.size()));
    pairs_.resize(from.pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i)
    {
        pool_.reserve(pairs_[i].contacts, from.pairs_[i].count, 0);
        pairs_[i] = from.pairs_[i];
    }
    keys_ = from.keys_;
    parked_pairs_ = from.parked_pairs_;
    force_pairs_ = from.force_pairs_, parked_force_pairs_ = from.parked_force_pairs_;
    next_id_ = from.next_id_, may_have_rest_depth_ = from.may_have_rest_depth_;
    rest_.copy(from.rest_);
    crowded_until_ = from.crowded_until_;
}

namespace
{

/// The first command of a phase that is selected; null if there is none.
const CommandInfo* find_command(const world::World& world, std::uint32_t component, Phase phase)
{
    if (component == kNoIndex || world.component(component).quarantined) return nullptr;
    const auto& c = world.component(component);
    const auto& commands = world.type_of(component)->info.commands;
    for (std::size_t k = 0; k < commands.size(); ++k)
        if (commands[k].phase == phase && commands[k].run && (c.commands & (1ull << k))) return &commands[k];
    return nullptr;
}

std::uint32_t manager_of(const world::World& world, std::uint32_t response)
{
    for (const Role& role : world.table_of(response).schema().roles())
        if (role.name == "manager" && role.one) return (*role.one)[world.component(response).row].index;
    return kNoIndex;
}

/// Fills in what the types of the detector's resolution and response declare.
void describe(Detector& d, const world::World& world)
{
    d.responds = find_command(world, d.response, Phase::Respond) != nullptr;
    // The gap command is used whenever a resolution needs it, whatever the stage lists select.
    for (const CommandInfo& command : world.type_of(d.component)->info.commands)
        if (command.phase == Phase::Gap && command.run) d.gap = &command;
    if (d.response != kNoIndex && !world.component(d.response).quarantined)
    {
        const TypeInfo& response = world.type_of(d.response)->info;
        d.by_rows = response.by_rows, d.by_force = response.by_force;
        if (d.by_rows) d.manager = manager_of(world, d.response);
    }
    d.friction = {world, d.response, "friction"}, d.restitution = {world, d.response, "restitution"};
    d.rolling_friction = {world, d.response, "rolling_friction"}, d.spinning_friction = {world, d.response, "spinning_friction"};
    d.steps_per_contact = {world, d.response, "steps_per_contact"}, d.steps_among_many = {world, d.response, "steps_among_many"};
    d.max_substeps = {world, d.response, "max_substeps"};
    if (!find_command(world, d.resolution, Phase::Locate)) return;
    d.speculation_acceleration = {world, d.resolution, "acceleration"}, d.max_work = {world, d.resolution, "max_work"};
    d.base_work = {world, d.resolution, "base_work"};
    d.max_bodies = {world, d.resolution, "max_bodies"}, d.max_points = {world, d.resolution, "max_points"};
    d.dwell = {world, d.resolution, "dwell"};
    const TypeInfo& resolution = world.type_of(d.resolution)->info;
    d.adapts = resolution.adapts && !d.by_force;
    d.speculates = resolution.speculates;
    d.locates = resolution.locates && !d.by_force;
    d.local = d.locates && resolution.local;
    d.certifies = d.local && resolution.certifies && d.gap;
}

}  // namespace

DeclaredNumber::DeclaredNumber(const world::World& world, std::uint32_t component, std::string_view name)
{
    if (component == kNoIndex) return;
    const Field* field = world.table_of(component).schema().find_field(name);
    if (!field) return;
    row_ = world.component(component).row;
    real_ = dynamic_cast<const Column<double>*>(field->column);
    whole_ = dynamic_cast<const Column<std::int64_t>*>(field->column);
}

std::vector<Detector> find_detectors(const world::World& world, const Schedule& schedule)
{
    std::vector<Detector> out;
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
            describe(d, world);
            out.push_back(d);
        }
    std::sort(out.begin(), out.end(),
              [&](const Detector& x, const Detector& y) { return world.rank(x.component) < world.rank(y.component); });
    return out;
}

double pressed_with(const PairState& pair)
{
    double sum = 0;
    for (const KnownContact& k : pair.all()) sum += dot(k.impulse, pair.normal);
    return sum;
}

bool pressed(const PairState& pair) { return pair.resting && pressed_with(pair) > 0; }

double mobility_at(const Bodies& bodies, std::uint32_t b, const Vec3& p, const Vec3& n)
{
    if (!bodies.dynamic(b)) return 0;
    const Vec3 lever = cross(p - bodies.position[b], n);
    return bodies.inverse_mass[b] + dot(lever, bodies.inverse_inertia_W(b) * lever);
}

double least_gyration(const Bodies& bodies, std::span<const std::uint32_t> some)
{
    double least = std::numeric_limits<double>::infinity();  // of 2 i^2
    for (const std::uint32_t b : some)
    {
        if (!bodies.dynamic(b)) continue;
        const Mat3& inertia = bodies.inertia_B[b];
        least = std::min(least, (inertia(0, 0) + inertia(1, 1) + inertia(2, 2)) * bodies.inverse_mass[b]);
    }
    return std::isfinite(least) ? std::sqrt(0.5 * least) : 0.0;
}

void sort_contacts(std::vector<FoundContact>& contacts, const world::World& world)
{
    const auto before = [&](const FoundContact& x, const FoundContact& y) { return precedes(x, y, world); };
    // Detectors mostly deliver in this order already.
    if (std::is_sorted(contacts.begin(), contacts.end(), before)) return;
    std::sort(contacts.begin(), contacts.end(), before);
}

}  // namespace plab::simulation
