#include "simulation/transaction/saved_state.h"

#include <algorithm>

#include "world/host_columns.h"

namespace plab::simulation
{
namespace
{

bool is_part(const world::World& world, std::uint32_t of, std::uint32_t component)
{
    if (of == component) return true;
    for (const Role& role : world.table_of(of).schema().roles())
    {
        if (std::find(role.facets.begin(), role.facets.end(), Facet::Component) == role.facets.end()) continue;
        for (const Ref r : world.participants(of, role))
            if (r.facet == Facet::Component && is_part(world, r.index, component)) return true;
    }
    return false;
}

}  // namespace

bool concerns_contacts(const world::World& world, std::uint32_t component)
{
    const Facet facet = world.component(component).facet;
    if (facet != Facet::Component) return facet == Facet::Body || facet == Facet::Shape;
    if (const model::ComponentType* type = world.type_of(component); type && type->only_advances()) return false;
    for (const auto& table : world.tables())
    {
        if (!table->type().takes_part(Phase::Detect)) continue;
        for (const std::uint32_t detection : table->component_of_row())
            if (detection != kNoIndex && is_part(world, detection, component)) return true;
    }
    return false;
}

void SavedState::begin(Run& run, bool with_contacts)
{
    run_ = &run;
    const world::HostTables& host = run.world().host();
    Stepper& stepper = run.stepper();
    (void)run.world().note_in(&log_);
    if (with_contacts) contacts_ = stepper.contacts();
    materials_ = host.materials, filter_ = host.filter;
    world::for_each_column(world::kDerivedShaftColumns, [&](auto column) { shafts_.*column = host.shafts.*column; });
    work_ = stepper.work(), contact_energy_ = stepper.contact_energy();
    departed_work_ = stepper.departed_work(), requests_work_ = stepper.requests_work();
    reported_ = stepper.reported();
}

void SavedState::add_backup()
{
    if (backup_) return;
    (void)run_->world().note_in(nullptr);
    backup_ = run_->world().backup();
    // Contacts change in the rebuild after the operations, so they are still as they were at the beginning.
    if (!contacts_) contacts_ = run_->stepper().contacts();
}

void SavedState::end() { (void)run_->world().note_in(nullptr); }

void SavedState::restore_derived() const
{
    world::HostTables& host = run_->world().host();
    host.materials = materials_, host.filter = filter_;
    world::for_each_column(world::kDerivedShaftColumns, [&](auto column) { host.shafts.*column = shafts_.*column; });
}

void SavedState::restore_world(const std::set<std::uint32_t>& prepared)
{
    world::World& world = run_->world();
    if (backup_) world.restore(*backup_);
    world.take_back(log_);
    // Opaque parts (a script's compiled chunk) are prepared again from the restored parameters. That overwrites host rows and outputs with
    // values from parameters, where later ones (a body's pose) were restored.
    world::UndoLog before;
    (void)world.note_in(&before);
    for (const std::set<std::uint32_t>* made : {&prepared, &std::as_const(run_->changed_by_scripts)})
        for (const std::uint32_t i : *made)
            if (i < world.components().size() && world.component(i).alive) (void)world.prepare(i);
    world.take_back(before);
    restore_derived();
}

void SavedState::restore(const std::set<std::uint32_t>& prepared)
{
    restore_world(prepared);
    const world::World& world = run_->world();
    Stepper& stepper = run_->stepper();
    (void)run_->live.rebuild();
    restore_derived();
    if (contacts_) stepper.contacts() = *contacts_;
    stepper.work() = work_, stepper.contact_energy() = contact_energy_;
    stepper.reported() = reported_;
    stepper.reported().contradictory.resize(world.components().size(), 0);
    stepper.departed_work() = departed_work_, stepper.requests_work() = requests_work_;
}

}  // namespace plab::simulation
