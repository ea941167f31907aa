#include "simulation/transaction/trial_memento.h"

#include "world/host_columns.h"

namespace plab::simulation
{

using world::for_each_column;

void TrialMemento::save(const world::HostTables& host, const TrialScope& scope)
{
    const auto copy = [](std::span<const std::uint32_t> from, std::vector<std::uint32_t>& to) { to.assign(from.begin(), from.end()); };
    copy(scope.bodies(), moved_bodies_), copy(scope.shafts(), moved_shafts_), copy(scope.quantities(), moved_quantities_);
    copy(scope.other_bodies(), fixed_bodies_), copy(scope.other_shafts(), fixed_shafts_);
    for_each_column(world::kBodyColumns,
                    [&](auto column)
                    {
                        (bodies_.*column).clear(), (bodies_.*column).reserve(moved_bodies_.size());
                        for (const std::uint32_t b : moved_bodies_) (bodies_.*column).push_back((host.bodies.*column)[b]);
                    });
    for_each_column(world::kShaftColumns, [&](auto column) { shafts_.*column = host.shafts.*column; });
    quantities_.clear(), motion_.clear(), inverse_mass_.clear(), inverse_inertia_B_.clear();
    for (const std::uint32_t q : moved_quantities_) quantities_.push_back(host.quantities.value[q]);
    for (const std::uint32_t b : fixed_bodies_)
    {
        motion_.push_back(host.bodies.motion[b]), inverse_mass_.push_back(host.bodies.inverse_mass[b]);
        inverse_inertia_B_.push_back(host.bodies.inverse_inertia_B[b]);
    }
    materials_ = host.materials, filter_ = host.filter;
    derived_anew_ = false;
    changes_ = {};
}

void TrialMemento::take_derived(const world::HostTables& host)
{
    own_materials_ = host.materials, own_filter_ = host.filter;
    for_each_column(world::kDerivedShaftColumns, [&](auto column) { own_shafts_.*column = host.shafts.*column; });
    derived_anew_ = true;
}

void TrialMemento::fix_others(world::HostTables& host) const
{
    for (const std::uint32_t b : fixed_bodies_)
        host.bodies.motion[b] = Motion::Static, host.bodies.inverse_mass[b] = 0, host.bodies.inverse_inertia_B[b] = {};
    for (const std::uint32_t s : fixed_shafts_) host.shafts.motion[s] = Motion::Static, host.shafts.inverse_inertia[s] = 0;
}

void TrialMemento::restore_moved(world::HostTables& host) const
{
    for_each_column(world::kBodyColumns,
                    [&](auto column)
                    {
                        for (std::size_t k = 0; k < moved_bodies_.size(); ++k)
                            (host.bodies.*column)[moved_bodies_[k]] = (bodies_.*column)[k];
                    });
    for_each_column(world::kShaftColumns,
                    [&](auto column)
                    {
                        for (const std::uint32_t s : moved_shafts_) (host.shafts.*column)[s] = (shafts_.*column)[s];
                    });
    for (std::size_t k = 0; k < moved_quantities_.size(); ++k) host.quantities.value[moved_quantities_[k]] = quantities_[k];
    if (!derived_anew_) return;
    for_each_column(world::kDerivedShaftColumns,
                    [&](auto column)
                    {
                        for (const std::uint32_t s : moved_shafts_) (host.shafts.*column)[s] = (own_shafts_.*column)[s];
                    });
}

void TrialMemento::restore_derived(world::HostTables& host) const
{
    host.materials = derived_anew_ ? own_materials_ : materials_;
    host.filter = derived_anew_ ? own_filter_ : filter_;
    const Shafts& from = derived_anew_ ? own_shafts_ : shafts_;
    for_each_column(world::kDerivedShaftColumns, [&](auto column) { host.shafts.*column = from.*column; });
}

void TrialMemento::restore(world::HostTables& host) const
{
    restore_moved(host);
    host.materials = materials_, host.filter = filter_;
    for_each_column(world::kDerivedShaftColumns, [&](auto column) { host.shafts.*column = shafts_.*column; });
    for (const std::uint32_t s : fixed_shafts_)
        host.shafts.motion[s] = shafts_.motion[s], host.shafts.inverse_inertia[s] = shafts_.inverse_inertia[s];
    for (std::size_t k = 0; k < fixed_bodies_.size(); ++k)
    {
        const std::uint32_t b = fixed_bodies_[k];
        host.bodies.motion[b] = motion_[k], host.bodies.inverse_mass[b] = inverse_mass_[k];
        host.bodies.inverse_inertia_B[b] = inverse_inertia_B_[k];
    }
}

}  // namespace plab::simulation
