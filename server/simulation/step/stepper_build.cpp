// Derives from a world's structure: schedule, groups, constraint graph and materials.
#include <algorithm>
#include <numeric>
#include <utility>

#include "simulation/step/stepper.h"

namespace plab::simulation
{
namespace
{

std::vector<std::uint32_t> ranks_of_shafts(const world::World& world)
{
    std::vector<std::uint32_t> ranks(world.host().shafts.size(), kNoIndex);
    for (std::uint32_t s = 0; s < ranks.size(); ++s)
        if (world.host().component_of_shaft[s] != kNoIndex) ranks[s] = world.rank(Ref{Facet::Shaft, s});
    return ranks;
}

/// Adds one-way couplings, which read `driver` and write `driven`. They do not join shafts to one group, but must not form a cycle.
void add_drives(const world::World& world, const Schedule& schedule, ConstraintGraph& graph)
{
    for (const Block& block : schedule.of(Phase::Couple))
    {
        const world::Table& table = *world.tables()[block.table];
        const Role* driver = table.schema().find_role("driver");
        const Role* driven = table.schema().find_role("driven");
        if (!driver || !driven || !driver->one || !driven->one || driver->writes) continue;
        for (const Row row : block.rows) graph.drive(table.component_of_row()[row], (*driver->one)[row], (*driven->one)[row]);
    }
}

}  // namespace

Stepper::Stepper(world::World& world, int threads) : step_(world, std::max(1, threads)), advance_(step_, motion_, book_, hard_, forces_)
{
    motion_.remember_with(&forces_);
}

Errors Stepper::run_connect(const Block& block, world::CommandCall& call)
{
    Errors errors;
    const world::Table& table = *step_.world.tables()[block.table];
    call.select(table);
    for (const Row row : block.rows)
    {
        const auto done = call.run(*block.command, Rows(&row, 1));
        if (done) continue;
        for (Error e : done.errors())
        {
            e.element = step_.world.id_of(table.component_of_row()[row]) + " (" + table.type().info.name + ")";
            errors.push_back(std::move(e));
        }
    }
    return errors;
}

void Stepper::connect_materials(Errors& errors)
{
    step_.world.host().materials.clear_pairs();
    step_.world.host().filter.clear();
    step_.graph.clear();
    world::HostTables& host = step_.world.host();
    world::CommandCall call;
    PhaseCall& to = call.arguments;
    to.materials = &host.materials, to.filter = &host.filter, to.ratios = &step_.graph;
    to.shafts = &host.shafts, to.bodies = &host.bodies, to.shapes = &host.shapes;
    for (const Block& block : step_.schedule.of(Phase::Connect))
        for (Error& e : run_connect(block, call)) errors.push_back(std::move(e));
}

void Stepper::connect_graph(Errors& errors)
{
    add_drives(step_.world, step_.schedule, step_.graph);
    const std::vector<std::uint32_t> shaft_ranks = ranks_of_shafts(step_.world);
    ShaftDirectory directory;
    directory.shaft_rank = shaft_ranks, directory.component_rank = step_.world.ranks();
    directory.shaft_id = [this](std::uint32_t s) { return step_.world.id_of(Ref{Facet::Shaft, s}); };
    directory.component_id = [this](std::uint32_t c) { return step_.world.id_of(c); };
    if (auto built = step_.graph.build(step_.world.host().shafts, directory); !built)
        errors.insert(errors.end(), built.errors().begin(), built.errors().end());
    else
        coupling_watch_.rebuild(step_.world, step_.schedule, step_.graph, directory);
}

Result<void> Stepper::rebuild()
{
    const world::Revisions now = step_.world.revisions();
    const bool only_solvers = built_from_ && now.only_solvers_since(*built_from_);
    const bool only_answers = built_from_ && now.only_answers_since(*built_from_);
    const bool no_solvers = built_from_ && now.order == built_from_->order && now.solvers == built_from_->solvers;
    built_from_.reset();
    GroupsChange change;
    if (only_solvers)
        choose_solvers();
    else if (only_answers)
        choose_answers(change);
    else if (Errors refused = derive_structure(no_solvers, change); !refused.empty())
        return refused;
    if (Errors refused = book_.rebuild(part_ == nullptr, only_solvers); !refused.empty()) return refused;
    if (only_solvers)
        advance_.solvers_changed();
    else
        set_up_motion(), advance_.rebuild(change);
    hard_.rebuild();
    forces_.rebuild();
    touches_.rebuild();
    sleeping_contacts_.rebuild();
    // It knows the sizes of bodies and the groups: a step after an exchange of solvers or answers would measure all of them again.
    if (!only_solvers && !only_answers) locator_.reset();
    saved_mark_ = nullptr;
    rebuild_costs();
    render_scene_.structure_changed();
    built_from_ = now;
    return {};
}

/// If nothing else has changed, everything but this is still what derive_structure() would make of it.
void Stepper::choose_solvers()
{
    rebuild_solvers(step_.schedule, step_.world, part_);
    simulation::choose_solvers(step_.world, step_.groups);
}

/// Responses, resolutions and managers join nothing: of what derive_structure() would make, only the schedule changes.
void Stepper::choose_answers(GroupsChange& change)
{
    step_.schedule = build_schedule(step_.world, part_);
    change.all = false;
}

/// `comparable`: ranks and solvers are those of the last rebuild, so its groups can be compared with the present ones.
Errors Stepper::derive_structure(bool comparable, GroupsChange& change)
{
    const Schedule before = std::exchange(step_.schedule, build_schedule(step_.world, part_));
    Errors errors;
    connect_materials(errors);
    connect_graph(errors);
    if (!errors.empty()) return errors;
    std::swap(step_.groups, groups_before_);
    build_groups(step_.world, step_.schedule, step_.groups, part_);
    if (comparable) change = compare_groups(groups_before_, before, step_.groups, step_.schedule);
    step_.all_groups.resize(step_.groups.all.size());
    std::iota(step_.all_groups.begin(), step_.all_groups.end(), 0u);
    return {};
}

void Stepper::set_up_motion()
{
    const std::size_t components = step_.world.components().size();
    step_.work.resize(components, 0.0), step_.contact_energy.resize(components), step_.reported.contradictory.resize(components, 0);
    const auto& detectors = book_.detectors();
    motion_.rebuild(std::any_of(detectors.begin(), detectors.end(), [](const Detector& d) { return d.locates; }),
                    part_ != nullptr && detectors.empty());
    speed_system_.configure(step_.world, step_.schedule, step_.groups, coupled_groups(), step_.graph);
}

/// Of the others no speeds are swept.
std::vector<std::uint32_t> Stepper::coupled_groups() const
{
    std::vector<std::uint32_t> out;
    for (const std::uint32_t g : step_.all_groups)
        if (step_.groups.cluster_has_couplings[step_.groups.all[g].cluster] != 0) out.push_back(g);
    return out;
}

/// Nobody asks a stepper of a part of the scene for its costs.
void Stepper::rebuild_costs()
{
    const auto& tables = step_.world.tables();
    const std::size_t components = step_.world.components().size();
    std::vector<std::uint32_t> owners;
    if (!part_)
    {
        std::vector<std::uint8_t> alone(tables.size());
        for (std::size_t t = 0; t < tables.size(); ++t) alone[t] = measured_alone(tables[t]->type().info) ? 1 : 0;
        owners.assign(components, kNoIndex);
        for (const std::uint32_t i : step_.world.in_id_order())
            if (const std::uint32_t table = step_.world.component(i).table; table != kNoIndex && alone[table] != 0) owners[i] = table;
    }
    step_.meter.accounts().fit(components, tables.size());
    cost_.rebuild(owners, tables.size());
    motion_.scratch().measure_with(step_.meter);
}

}  // namespace plab::simulation
