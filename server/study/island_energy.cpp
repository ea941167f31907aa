#include "study/island_energy.h"

#include <algorithm>
#include <cmath>

#include "world/command_call.h"

namespace plab::study
{

using simulation::Simulation;

namespace
{

bool moves(const world::HostTables& host, Ref r)
{
    return r.facet == Facet::Body ? host.bodies.dynamic(r.index) : r.facet == Facet::Shaft && host.shafts.dynamic(r.index);
}

/// Adds what is stored to the objects.
template <class Rows>
class Shares final : public StoredEnergySink
{
public:
    Shares(const Rows& rows, double sign, std::vector<double>& to) : rows_(rows), sign_(sign), to_(to) {}
    /// Of two that move, both are in one island.
    void add(double joule, Ref a, Ref b) override
    {
        shared += joule, size += std::fabs(joule);
        std::uint32_t object = rows_.of(a);
        if (object == kNoIndex) object = rows_.of(b);
        if (object != kNoIndex) to_[object] += sign_ * joule;
    }
    double shared = 0, size = 0;  ///< J

private:
    const Rows& rows_;
    double sign_;
    std::vector<double>& to_;
};

}  // namespace

std::uint32_t IslandEnergies::Rows::of(Ref object) const
{
    if (!object.valid()) return kNoIndex;
    const auto& list = object.facet == Facet::Body ? body : shaft;
    const bool is_object = object.facet == Facet::Body || object.facet == Facet::Shaft;
    return is_object && object.index < list.size() ? list[object.index] : kNoIndex;
}

void IslandEnergies::begin(const Simulation& run)
{
    const world::World& world = run.world();
    ids_.clear();
    for (const std::uint32_t i : world.in_id_order())
        if (moves(world.host(), world.component(i).ref(i))) ids_.push_back(world.id_of(i));
    islands_.reset(ids_.size());
    here_ = there_ = {};
}

/// Exchanges may move rows. The ids are in the order of ids.
void IslandEnergies::find_rows(const Simulation& of, Rows& rows) const
{
    if (rows.known && rows.revision == of.revision()) return;
    rows.revision = of.revision(), rows.known = true;
    const world::HostTables& host = of.world().host();
    rows.body.assign(host.bodies.size(), kNoIndex), rows.shaft.assign(host.shafts.size(), kNoIndex);
    for (std::uint32_t k = 0; k < ids_.size(); ++k)
    {
        const std::uint32_t component = of.world().find(ids_[k]);
        if (component == kNoIndex) continue;
        const Ref object = of.world().component(component).ref(component);
        if (moves(host, object)) (object.facet == Facet::Body ? rows.body : rows.shaft)[object.index] = k;
    }
}

void IslandEnergies::join(const Simulation& of, const Rows& rows)
{
    const simulation::Groups& groups = of.stepper().groups();
    for (std::uint32_t cluster = 0; cluster < groups.clusters; ++cluster)
    {
        std::uint32_t first = kNoIndex;
        const auto add = [&](Ref object)
        {
            const std::uint32_t k = rows.of(object);
            if (k == kNoIndex) return;
            if (first != kNoIndex) islands_.join(first, k);
            first = k;
        };
        for (const std::uint32_t g : groups.of_cluster(cluster))
        {
            for (const std::uint32_t b : groups.all[g].bodies) add({Facet::Body, b});
            for (const std::uint32_t s : groups.all[g].shafts) add({Facet::Shaft, s});
        }
    }
    const world::World& world = of.world();
    const auto touch = [&](Ref a, Ref b)
    {
        if (const std::uint32_t i = rows.of(a), k = rows.of(b); i != kNoIndex && k != kNoIndex) islands_.join(i, k);
    };
    const auto body_of = [&](std::uint32_t rank)
    {
        const std::uint32_t component = world.in_id_order()[rank];
        return world.component(component).ref(component);
    };
    for (const simulation::PairKey& key : of.stepper().contacts().keys()) touch(body_of(key.a), body_of(key.b));
    for (const simulation::ForcePair& p : of.stepper().contacts().force_pairs()) touch(p.a, p.b);
}

Result<void> IslandEnergies::add_energies(Simulation& of, const Rows& rows, double sign)
{
    const world::HostTables& host = of.world().host();
    for (std::uint32_t b = 0; b < rows.body.size(); ++b)
        if (rows.body[b] != kNoIndex) excess_[rows.body[b]] += sign * host.bodies.kinetic_energy(b);
    for (std::uint32_t s = 0; s < rows.shaft.size(); ++s)
        if (rows.shaft[s] != kNoIndex) excess_[rows.shaft[s]] += sign * host.shafts.kinetic_energy(s);
    for (const simulation::Block& block : of.stepper().schedule().of(Phase::Potential))
    {
        Shares<Rows> shares(rows, sign, excess_);
        StoredEnergy stored;
        stored.sink = &shares;
        world::CommandCall call;
        call.context.time = of.time(), call.context.tick = of.tick();
        PhaseCall& to = call.arguments;
        to.bodies = &of.world().host().bodies, to.shafts = &of.world().host().shafts, to.shapes = &of.world().host().shapes;
        to.stored = &stored;
        const world::Table& table = *of.world().tables()[block.table];
        call.select(table);
        (void)call.run(*block.command, block.rows);
        constexpr double kRounding = 1e-9;
        if (std::fabs(stored.joule - shares.shared) > kRounding * (shares.size + std::fabs(stored.joule)))
            return reason(table.type().info.name +
                          " stores energy without saying whose it is (StoredEnergy::add), so a bound in W cannot be "
                          "checked in this scene");
    }
    return {};
}

Result<void> IslandEnergies::look(Simulation& run, Simulation& shadow)
{
    find_rows(run, here_), find_rows(shadow, there_);
    join(run, here_), join(shadow, there_);
    excess_.assign(ids_.size(), 0.0);
    if (auto added = add_energies(run, here_, 1); !added) return added;
    if (auto added = add_energies(shadow, there_, -1); !added) return added;
    for (std::uint32_t k = 0; k < ids_.size(); ++k)
        if (const std::uint32_t island = islands_.find(k); island != k) excess_[island] += std::exchange(excess_[k], 0.0);
    return {};
}

double IslandEnergies::excess(const Simulation& run, std::span<const Ref> objects)
{
    find_rows(run, here_);
    counted_.clear();
    double sum = 0;
    for (const Ref object : objects)
    {
        const std::uint32_t k = here_.of(object);
        if (k == kNoIndex) continue;
        const std::uint32_t island = islands_.find(k);
        if (std::find(counted_.begin(), counted_.end(), island) != counted_.end()) continue;
        counted_.push_back(island), sum += excess_[island];
    }
    return sum;
}

}  // namespace plab::study
