#include "simulation/contacts/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "world/state_hash.h"

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

/// Searches from `near` in steps that double, and then between the last two places.
const PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near) const
{
    const auto key = key_of(world, detector, a, b);
    const auto before = [&](const PairState& p, const auto& k) { return key_of(world, p) < k; };
    std::size_t first = std::min(near, pairs_.size()), end = first;
    if (first > 0 && !before(pairs_[first - 1], key))
        first = 0;
    else
        for (std::size_t stride = 1; end < pairs_.size() && before(pairs_[end], key); stride *= 2)
            first = end + 1, end = std::min(end + stride, pairs_.size());
    const auto at = std::lower_bound(pairs_.begin() + static_cast<std::ptrdiff_t>(first), pairs_.begin() + static_cast<std::ptrdiff_t>(end),
                                     key, before);
    near = static_cast<std::size_t>(at - pairs_.begin());
    return at != pairs_.end() && at->detector == detector && at->a == a && at->b == b ? &*at : nullptr;
}

PairState* ContactCache::find(std::uint32_t detector, Ref a, Ref b, const world::World& world, std::size_t& near)
{
    return const_cast<PairState*>(std::as_const(*this).find(detector, a, b, world, near));
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

void ContactCache::add_sorted(std::span<const PairState> fresh, const world::World& world)
{
    if (fresh.empty()) return;
    // Merged from the back, so that each pair moves once.
    std::size_t old = pairs_.size(), at = old + fresh.size();
    pairs_.resize(at);
    for (std::size_t next = fresh.size(); next > 0;)
    {
        const bool old_is_later = old > 0 && key_of(world, fresh[next - 1]) < key_of(world, pairs_[old - 1]);
        pairs_[--at] = old_is_later ? pairs_[--old] : fresh[--next];
    }
}

KnownContact& ContactCache::contact_of(PairState& pair, std::uint32_t feature)
{
    for (std::uint32_t i = 0; i < pair.count; ++i)
        if (pair.contacts[i].feature == feature) return pair.contacts[i];
    // If the manifold is full, its last slot is reused.
    const std::uint32_t place = std::min<std::uint32_t>(pair.count, PairState::kMostContacts - 1);
    pair.count = place + 1;
    pair.contacts[place] = {};
    pair.contacts[place].feature = feature, pair.contacts[place].id = next_id_++;
    return pair.contacts[place];
}

const KnownContact* ContactCache::find_contact(std::uint32_t detector, Ref a, Ref b, std::uint32_t feature, const world::World& world)
{
    const PairState* pair = find(detector, a, b, world);
    if (!pair) return nullptr;
    const auto end = pair->contacts.begin() + pair->count;
    const auto found = std::find_if(pair->contacts.begin(), end, [&](const KnownContact& k) { return k.feature == feature; });
    return found == end ? nullptr : &*found;
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
    const auto has_no_speculating_detector = [&](const PairState& p)
    {
        return p.ahead && std::none_of(detectors.begin(), detectors.end(),
                                       [&](const Detector& d) { return d.component == p.detector && d.speculates; });
    };
    std::erase_if(pairs_, gone);
    std::erase_if(pairs_, has_no_speculating_detector);
    for (PairState& p : pairs_)
    {
        // Without a response nothing rests: a sensor supports no body.
        const bool answered =
            std::any_of(detectors.begin(), detectors.end(),
                        [&](const Detector& d) { return d.component == p.detector && (d.responds || d.by_rows || d.by_force); });
        if (answered) continue;
        p.resting = false;
        p.bounces = {};
        for (KnownContact& k : p.contacts) k.impulse = {};
    }
    std::sort(pairs_.begin(), pairs_.end(), [&](const PairState& x, const PairState& y) { return key_of(world, x) < key_of(world, y); });
}

namespace
{

using world::hash_of, world::mix;

void copy_head(const PairHead& from, PairHead& to) { to = from; }
void copy_head(const ForcePairHead& from, ForcePairHead& to) { to = from; }

std::uint64_t hash_of_contact(const KnownContact& k)
{
    const std::uint64_t h = mix(mix(hash_of(k.impulse), k.id), std::uint64_t{k.feature});
    // The spring state is hashed only if there is one.
    if (k.stretch == Vec3{} && k.rest_depth == 0 && k.preload == 0) return h;
    return mix(mix(mix(h, hash_of(k.stretch)), k.rest_depth), k.preload);
}

std::uint64_t hash_of_pair(const world::World& world, const PairState& p)
{
    const std::uint64_t pair = std::uint64_t{world.rank(p.a)} << 32 | world.rank(p.b);
    const std::uint64_t how = (p.resting ? 1u : 0u) | (p.ahead ? 2u : 0u) | (p.overlapping ? 4u : 0u) | std::uint64_t{p.count} << 3;
    std::uint64_t h = mix(mix(hash_of(p.normal), pair), how);
    for (std::uint32_t i = 0; i < p.count; ++i) h = mix(h, hash_of_contact(p.contacts[i]));
    if (p.bounces == BounceHistory{}) return h;
    return mix(mix(mix(h, p.bounces.time), p.bounces.interval), p.bounces.previous);
}

std::uint64_t hash_of_name(const std::string& id)
{
    return world::hash_bytes(0, {reinterpret_cast<const std::uint8_t*>(id.data()), id.size()});
}

std::uint64_t hash_of_contact(const ForceContact& c)
{
    std::uint64_t h = mix(mix(0, c.id), std::uint64_t{c.feature} << 2 | (c.reported ? 1u : 0u) | (c.dormant ? 2u : 0u));
    for (const Vec3& v : {c.stretch, c.impulse, c.force}) h = mix(h, hash_of(v));
    for (const double x :
         {c.rest_depth, c.preload, c.open_depth, c.approach, c.begin, c.depth, c.peak, c.half_period, c.swing_speed, c.peak_swing_speed})
        h = mix(h, x);
    return h;
}

}  // namespace

void ContactCache::copy(const ContactCache& from)
{
    const auto copy_list = [](const auto& list, auto& to)
    {
        to.resize(list.size());
        for (std::size_t i = 0; i < list.size(); ++i)
        {
            copy_head(list[i], to[i]);
            std::copy_n(list[i].contacts.begin(), list[i].count, to[i].contacts.begin());
        }
    };
    copy_list(from.pairs_, pairs_), copy_list(from.parked_pairs_, parked_pairs_);
    copy_list(from.force_pairs_, force_pairs_), copy_list(from.parked_force_pairs_, parked_force_pairs_);
    next_id_ = from.next_id_;
}

std::uint64_t ContactCache::state_hash(const world::World& world, std::uint64_t h) const
{
    for (const PairState& p : pairs_) h = mix(h, hash_of_pair(world, p));
    for (const ForcePair& p : force_pairs_)
    {
        // By name, so that the hash of these pairs does not depend on what else is in the scene.
        h = mix(mix(h, hash_of_name(world.id_of(p.a))), hash_of_name(world.id_of(p.b)));
        for (const ForceContact& c : p.all()) h = mix(h, hash_of_contact(c));
    }
    return h;
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
    d.steps_per_contact = {world, d.response, "steps_per_contact"}, d.max_substeps = {world, d.response, "max_substeps"};
    if (!find_command(world, d.resolution, Phase::Locate)) return;
    d.speculation_acceleration = {world, d.resolution, "acceleration"}, d.max_work = {world, d.resolution, "max_work"};
    d.base_work = {world, d.resolution, "base_work"};
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
    for (std::uint32_t k = 0; k < pair.count; ++k) sum += dot(pair.contacts[k].impulse, pair.normal);
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
    const auto key = [&](const FoundContact& f)
    { return std::tuple(f.detector, world.rank(f.contact.a), world.rank(f.contact.b), f.contact.feature); };
    // Detectors mostly deliver in this order already.
    const auto before = [&](const FoundContact& x, const FoundContact& y) { return key(x) < key(y); };
    if (std::is_sorted(contacts.begin(), contacts.end(), before)) return;
    std::sort(contacts.begin(), contacts.end(), before);
}

}  // namespace plab::simulation
