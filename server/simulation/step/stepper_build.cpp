// What a stepper derives from a world's structure: schedule, groups, constraint graph, materials, batches.
#include <algorithm>
#include <limits>

#include "simulation/contacts/contact_rules.h"
#include "simulation/contacts/island_step.h"
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

/// One-way couplings: those that read `driver` and own `driven`. They join nothing but must not close a circle.
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

Stepper::Stepper(world::World& world, int threads) : world_(world), workers_(std::max(1, threads)) {}

Errors Stepper::run_connect(const Block& block, PhaseCall call)
{
    Errors errors;
    world::Table& table = *world_.tables()[block.table];
    StepContext context;
    context.component_of_row = table.component_of_row(), context.facet_of_row = table.host_of_row();
    call.context = &context;
    for (const Row row : block.rows)
    {
        call.rows = Rows(&row, 1);
        const auto done = block.command->run(call, table.rows());
        if (done) continue;
        for (Error e : done.errors())
        {
            e.element = world_.id_of(table.component_of_row()[row]) + " (" + table.type().info.name + ")";
            errors.push_back(std::move(e));
        }
    }
    return errors;
}

void Stepper::connect_materials(Errors& errors)
{
    world_.host().materials.clear_pairs();
    PhaseCall call;
    call.materials = &world_.host().materials;
    graph_.clear();
    call.ratios = &graph_;
    call.shafts = &world_.host().shafts, call.bodies = &world_.host().bodies, call.shapes = &world_.host().shapes;
    for (const Block& block : schedule_.of(Phase::Connect))
        for (Error& e : run_connect(block, call)) errors.push_back(std::move(e));
}

void Stepper::connect_graph(Errors& errors)
{
    add_drives(world_, schedule_, graph_);
    const std::vector<std::uint32_t> shaft_ranks = ranks_of_shafts(world_);
    std::vector<std::uint32_t> component_ranks(world_.components().size(), kNoIndex);
    for (const std::uint32_t i : world_.in_id_order()) component_ranks[i] = world_.rank(i);
    ShaftDirectory directory;
    directory.shaft_rank = shaft_ranks, directory.component_rank = component_ranks;
    directory.shaft_id = [this](std::uint32_t s) { return world_.id_of(Ref{Facet::Shaft, s}); };
    directory.component_id = [this](std::uint32_t c) { return world_.id_of(c); };
    if (auto built = graph_.build(world_.host().shafts, directory); !built)
        errors.insert(errors.end(), built.errors().begin(), built.errors().end());
    else
        coupling_watch_.rebuild(world_, schedule_, graph_, directory);
}

Result<void> Stepper::rebuild()
{
    schedule_ = build_schedule(world_, takes_part_);
    Errors errors;
    connect_materials(errors);
    connect_graph(errors);
    if (!errors.empty()) return errors;
    groups_ = build_groups(world_, schedule_);
    detectors_ = find_detectors(world_, schedule_);
    if (Errors refused = check_contacts(world_, detectors_); !refused.empty()) return refused;
    cache_.refresh(world_, detectors_);
    locator_.reset();
    if (!held_) held_ = std::make_shared<HeldIslands>(*this);
    held_->rebuild();
    measure_bodies();
    forces_.rebuild();
    island_all_.resize(groups_.all.size());
    for (std::uint32_t g = 0; g < island_all_.size(); ++g) island_all_[g] = g;
    speed_system_.configure(world_, schedule_, groups_, island_all_, graph_);
    rewinds_possible_ = std::any_of(detectors_.begin(), detectors_.end(), [](const Detector& d) { return d.locates; });
    work_.resize(world_.components().size(), 0.0);
    contact_energy_.resize(world_.components().size());
    told_.contradictory.resize(world_.components().size(), 0);
    rebuild_costs();
    segment_begin_.assign(groups_.all.size(), 0.0);
    found_.clear();
    pool_.clear(world_);
    batches_ready_ = false;
    split_.assign(groups_.clusters, 0);
    row_reports_.clear(world_.components().size());
    sight_.structure_changed();
    start_.save(world_.host()), segment_.save(world_.host()), end_.save(world_.host());
    return {};
}

void Stepper::rebuild_costs()
{
    std::vector<std::uint32_t> owners(world_.components().size(), kNoIndex);
    for (const std::uint32_t i : world_.in_id_order())
        if (const model::ComponentType* type = world_.type_of(i); type && measured_alone(type->info)) owners[i] = world_.component(i).table;
    meter_.accounts().fit(owners.size(), world_.tables().size());
    cost_.rebuild(owners, world_.tables().size());
    pool_.scratch().measure_with(meter_);
}

void Stepper::measure_bodies()
{
    const world::HostTables& host = world_.host();
    const auto radius_of = [&](const Geometry& g)
    {
        double r = 0;
        if (g.kind == GeometryKind::Plane) return std::numeric_limits<double>::infinity();
        if (g.kind == GeometryKind::Sphere) r = g.size.x;
        if (g.kind == GeometryKind::Box) r = length(g.size);
        if (g.kind == GeometryKind::Capsule) r = g.size.x + g.size.z;
        if (g.kind == GeometryKind::Cylinder) r = std::hypot(g.size.x, g.size.z);
        for (const Vec3& v : g.vertices) r = std::max(r, length(v));
        return r;
    };
    radius_of_body_.assign(host.bodies.size(), 0.0);
    for (std::size_t b = 0; b < radius_of_body_.size(); ++b)
        for (const Ref shape : host.bodies.shapes[b])
        {
            const Geometry& g = host.shapes.geometry[shape.index];
            radius_of_body_[b] = std::max(radius_of_body_[b], length(g.pose.p - host.bodies.center_B[b]) + radius_of(g));
        }
}

}  // namespace plab::simulation
