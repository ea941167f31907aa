// What a stepper derives from a world's structure: schedule, groups, constraint graph, materials, batches.
#include <algorithm>
#include <limits>

#include "simulation/stepper.h"

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
}

Result<void> Stepper::rebuild()
{
    schedule_ = build_schedule(world_);
    Errors errors;
    connect_materials(errors);
    connect_graph(errors);
    if (!errors.empty()) return errors;
    groups_ = build_groups(world_, schedule_);
    detectors_ = find_detectors(world_, schedule_);
    cache_.refresh(world_, detectors_);
    measure_bodies();
    island_all_.resize(groups_.all.size());
    for (std::uint32_t g = 0; g < island_all_.size(); ++g) island_all_[g] = g;
    speed_system_.configure(world_, schedule_, groups_, island_all_, graph_);
    rewinds_possible_ = std::any_of(detectors_.begin(), detectors_.end(), [](const Detector& d) { return d.locates; });
    work_.resize(world_.components().size(), 0.0);
    cost_.by_table.resize(world_.tables().size());
    segment_begin_.assign(groups_.all.size(), 0.0);
    found_.clear();
    for (Cached& c : cached_systems_) c.groups.clear(), c.shadows.clear(), c.system.reset();
    batches_ready_ = false;
    sight_.structure_changed();
    start_.save(world_.host()), segment_.save(world_.host()), end_.save(world_.host());
    return {};
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

void Stepper::plan_batches()
{
    // One batch for each thread, in whole clusters: what reads another group must share its stage times. Groups with
    // resting contacts advance by themselves. Partition never shows in the state: groups do not feel one another.
    const auto threads = static_cast<std::size_t>(workers_.threads());
    std::vector<std::size_t> weight(groups_.clusters, 0);
    std::size_t total = 0;
    for (const Group& g : groups_.all)
    {
        weight[g.cluster] += g.bodies.size() + g.shafts.size() + 1;
        total += g.bodies.size() + g.shafts.size() + 1;
    }
    struct Slot
    {
        std::uint32_t solver;
        std::size_t load;
        std::vector<std::uint32_t> groups;
    };
    std::vector<Slot> slots;
    std::vector<std::size_t> slot_of_cluster(groups_.clusters, SIZE_MAX);
    for (std::uint32_t g = 0; g < groups_.all.size(); ++g)
    {
        const Group& group = groups_.all[g];
        std::size_t& slot = slot_of_cluster[group.cluster];
        if (slot == SIZE_MAX)
        {
            for (slot = 0; slot < slots.size(); ++slot)
                if (slots[slot].solver == group.solver && slots[slot].load * threads < total) break;
            if (slot == slots.size()) slots.push_back({group.solver, 0, {}});
            slots[slot].load += weight[group.cluster];
        }
        slots[slot].groups.push_back(g);
    }
    batches_.clear();
    for (Slot& slot : slots) batches_.push_back(std::move(slot.groups));
    while (batch_systems_.size() < batches_.size()) batch_systems_.push_back(std::make_unique<GroupSystem>());
    batch_fine_.assign(batches_.size(), 1);
    batch_work_.assign(batches_.size(), std::vector<double>(work_.size(), 0.0));
}

}  // namespace plab::simulation
