#include "simulation/contacts/held_islands.h"

#include <algorithm>
#include <numeric>

namespace plab::simulation
{
namespace
{

/// A role of a component that names a manager.
std::uint32_t manager_role(const world::World& world, std::uint32_t component)
{
    for (const Role& role : world.table_of(component).schema().roles())
        if (role.name == "manager" && role.one) return (*role.one)[world.component(component).row].index;
    return kNoIndex;
}

}  // namespace

void HeldIslands::rebuild()
{
    known_ = known_ && contacts_.keeps_found();
    manager_of_group_.assign(step_.groups.all.size(), kNoIndex);
    any_ = std::any_of(contacts_.detectors().begin(), contacts_.detectors().end(), [](const Detector& d) { return d.by_rows; });
    holds_joints_ = false;
    yields_.assign(step_.groups.all.size(), 0);
    manager_of_island_.resize(step_.groups.all.size());
    island_of_group_.assign(step_.groups.all.size(), kNoIndex);
    yielding_groups_.clear(), numbered_.clear();
    const auto& blocks = step_.schedule.of(Phase::Constrain);
    for (std::uint32_t g = 0; g < manager_of_group_.size(); ++g)
        for (const BlockRow& row : step_.groups.all[g].rows)
        {
            const std::uint32_t component = step_.world.tables()[blocks[row.block].table]->component_of_row()[row.row];
            const std::uint32_t manager = manager_role(step_.world, component);
            if (manager == kNoIndex || manager_of_group_[g] != kNoIndex) continue;
            manager_of_group_[g] = manager;
            yielding_groups_.push_back(g);
            any_ = true;
        }
}

/// Finds the groups with joint rows that are one-sided (limits that are near) or have a bounded impulse (motors) in this step
/// (ConstraintRow::may_yield). All other groups can advance by their solver.
void HeldIslands::find_yielding_rows()
{
    holds_joints_ = false;
    for (const std::uint32_t g : yielding_groups_)
    {
        RowSystem* rows = motion_.system_for(std::span(&g, 1), {}).rows();
        StepContext context;
        context.time = step_.frame.start_time, context.dt = step_.frame.step, context.tick = step_.frame.tick;
        context.seed = step_.frame.seed;
        rows->collect(context);
        yields_[g] = rows->may_yield() ? 1 : 0;
        holds_joints_ = holds_joints_ || rows->may_yield();
    }
}

std::uint32_t HeldIslands::manager_of(const PairState& pair) const
{
    for (const Detector& d : contacts_.detectors())
        if (d.component == pair.detector) return d.by_rows ? d.manager : kNoIndex;
    return kNoIndex;
}

// Which groups are held -----------------------------------------------------------------------------------------------

/// Takes the groups out of `groups` that belong to an island with a manager: because one of its persistent contacts names the manager, or
/// a joint row that may yield does. If an island's contacts and joints name several managers, the first one by id solves all of it, since
/// an island cannot be solved in parts. All other groups advance by their solvers, with full order.
void HeldIslands::take(std::vector<std::uint32_t>& groups, DisjointSets& islands, std::span<const std::uint32_t> reached,
                       std::span<const std::uint32_t> places)
{
    held_.clear();
    if (!any_) return;
    for (const std::uint32_t g : reached) manager_of_island_[islands.find(g)] = kNoIndex;
    const auto name = [&](std::uint32_t group, std::uint32_t manager)
    {
        if (group == kNoIndex || manager == kNoIndex) return;
        std::uint32_t& known = manager_of_island_[islands.find(group)];
        if (known == kNoIndex || step_.world.rank(manager) < step_.world.rank(known)) known = manager;
    };
    for (const std::uint32_t place : places)
    {
        const PairState& p = contacts_.cache().pairs()[place];
        const std::uint32_t manager = manager_of(p);
        if (manager == kNoIndex) continue;
        for (const Ref r : {p.a, p.b})
            if (step_.world.host().bodies.dynamic(r.index)) name(step_.groups.of(r), manager);
    }
    for (const std::uint32_t g : reached)
        if (yields_[g]) name(g, manager_of_group_[g]);
    std::size_t kept = 0;
    for (const std::uint32_t g : groups)
        if (manager_of_island_[islands.find(g)] != kNoIndex)
            held_.push_back(g);
        else
            groups[kept++] = g;
    groups.resize(kept);
    std::sort(held_.begin(), held_.end());
}

void HeldIslands::make_islands(DisjointSets& islands)
{
    for (const std::uint32_t g : numbered_) island_of_group_[g] = kNoIndex;
    numbered_.clear();
    island_count_ = 0;
    for (const std::uint32_t g : held_)
    {
        const std::uint32_t root = islands.find(g);
        std::uint32_t& number = island_of_group_[root];
        if (number == kNoIndex)
        {
            number = static_cast<std::uint32_t>(island_count_++);
            if (islands_.size() < island_count_) islands_.push_back(std::make_unique<HeldIsland>());
            HeldIsland& fresh = *islands_[number];
            fresh.manager = manager_of_island_[root], fresh.has_rows = false;
            fresh.clear();
        }
        island_of_group_[g] = number;
        numbered_.push_back(root), numbered_.push_back(g);
        HeldIsland& island = *islands_[number];
        island.groups.push_back(g);
        island.has_rows = island.has_rows || !step_.groups.all[g].rows.empty();
    }
}

// The step ------------------------------------------------------------------------------------------------------------

void HeldIslands::advance(std::span<const std::uint32_t> observed, DisjointSets& islands, double from, double to, WorkBook book, bool trial,
                          bool begins)
{
    // An advance by no time, to query the start of a piece: no impulses.
    if (!(to > from)) return;
    if (book.work && book.sign < 0 && contacts_.log().on()) take_back_contacts(from);
    make_islands(islands);
    collect_contacts(from, to - from, begins);
    plain_.clear(), jointed_.clear(), plain_groups_.clear();
    for (std::size_t i = 0; i < island_count_; ++i)
    {
        HeldIsland& island = *islands_[i];
        (island.has_rows ? jointed_ : plain_).push_back(&island);
        if (!island.has_rows) plain_groups_.insert(plain_groups_.end(), island.groups.begin(), island.groups.end());
    }
    // Islands without joints share one system: their members change with every contact, but the union of all islands changes rarely, so
    // the system needs no new configuration.
    std::sort(plain_groups_.begin(), plain_groups_.end());
    if (!plain_.empty()) run(plain_, plain_groups_, observed, from, to, book, trial);
    for (HeldIsland* island : jointed_) run(std::span(&island, 1), island->groups, observed, from, to, book, trial);
}

/// Advances islands that share one system from `from` to `to`. Forces are evaluated once for all of them; then each island's manager moves
/// its bodies by HeldMotion. The work of the forces is booked afterwards at the mean velocities of the moves, which are known only then.
/// The moves of bodies that were advanced to the midpoint cover the whole step as well, so the displacement to the midpoint is subtracted.
void HeldIslands::run(std::span<HeldIsland*> islands, std::span<const std::uint32_t> groups, std::span<const std::uint32_t> observed,
                      double from, double to, WorkBook book, bool trial)
{
    GroupSystem& system = motion_.system_for(groups, observed);
    system.hold_rows(true);
    system.begin(from, to, book, trial ? nullptr : &step_);
    for (HeldIsland* island : islands) island->members.clear(), island->roots.clear(), island->bodies.clear(), island->shafts.clear();
    member_of_body_.resize(step_.world.host().bodies.size());
    for (std::uint32_t i = 0; i < system.bodies().size(); ++i)
    {
        const std::uint32_t b = system.bodies()[i], number = island_of_group_[step_.groups.group_of_body[b]];
        if (number == kNoIndex) continue;  // observed only
        member_of_body_[b] = static_cast<std::uint32_t>(islands_[number]->members.size());
        islands_[number]->members.push_back(i), islands_[number]->bodies.push_back(b);
    }
    for (std::uint32_t i = 0; i < system.roots().size(); ++i)
    {
        const std::uint32_t shaft = system.roots()[i], number = island_of_group_[step_.groups.group_of_shaft[shaft]];
        if (number == kNoIndex) continue;
        islands_[number]->roots.push_back(i), islands_[number]->shafts.push_back(shaft);
    }
    system.evaluate_midway();
    given_speed_.resize(step_.world.host().bodies.size(), 0.0);
    share(islands, [&](HeldIsland& island) { set_approach(island, system, to - from); });
    advance_to_midpoint(islands, system, to - from);
    solve(islands, system, from, to, book, trial);
    const bool given_up = step_.frame.give_up();  // then islands may be unsolved, and the booked work is discarded
    if (book.work && !given_up) book_forces(system, islands, to - from);
    midpoint_.take_back();
    system.finish_held();
    if (!given_up)
        for (const HeldIsland* island : islands) report_rows(*island, system, to - from, book);
    system.hold_rows(false);
    motion_.finish_advance(system, system.all_finite(), to, trial);
}

/// Advances islands in which a body moves along a curved surface to the midpoint of the step, where contacts and forces are evaluated
/// (midpoint_contacts.h). Islands with an impact are left out, as its impulse acts at the start of the step along the normals there; so are
/// islands with kinematic bodies.
void HeldIslands::advance_to_midpoint(std::span<HeldIsland*> islands, GroupSystem& system, double h)
{
    turning_.clear(), at_midpoint_.clear();
    for (HeldIsland* island : islands)
    {
        island->turns = island->turns && !island->meets && !island->driven;
        if (!island->turns) continue;
        midpoint_.advance_to_midpoint(system, island->members, h);
        for (const Run& run : island->runs) turning_.push_back({island, &run});
    }
    if (turning_.empty()) return;
    // Forces that depend on the state are those of the midpoint already, but for islands with contacts by force (go_midway).
    if (motion_.extra())
        system.evaluate(0, 0);
    else
        system.evaluate_kinematics();
    std::sort(turning_.begin(), turning_.end(), [](const RunOf& x, const RunOf& y) { return x.run->order < y.run->order; });
    for (const RunOf& t : turning_)
        for (const Contact& c : t.island->of(*t.run)) at_midpoint_.emplace_back(c, t.run->found->detector);
    midpoint_places_.resize(at_midpoint_.size());
    std::iota(midpoint_places_.begin(), midpoint_places_.end(), 0u);
    midpoint_.update_contacts(midpoint_places_, at_midpoint_, h);
    std::size_t at = 0;
    for (const RunOf& t : turning_)
        for (Contact& c : t.island->of(*t.run)) c = at_midpoint_[at++].contact;
}

/// Books the work of each force component: its power at the mean velocities of the moves. For this the forces are evaluated once more, at
/// the speeds of the start, as they have acted; the state is put back afterwards. At the mean velocities a damper would have another force
/// in a step with an impact or a stop.
void HeldIslands::book_forces(GroupSystem& system, std::span<HeldIsland*> islands, double h)
{
    world::HostTables& host = step_.world.host();
    Bodies& bodies = host.bodies;
    const std::size_t count = system.bodies().size();
    kept_positions_.resize(count), kept_orientations_.resize(count), kept_velocities_.resize(count), kept_spins_.resize(count);
    kept_momenta_.resize(count), kept_speeds_.clear(), kept_angles_.clear();
    const auto for_bodies = [&](const auto& one)
    {
        for_parts(&step_.workers, count, kPart,
                  [&](std::size_t begin, std::size_t end)
                  {
                      for (std::size_t i = begin; i < end; ++i) one(i, system.bodies()[i]);
                  });
    };
    for_bodies(
        [&](std::size_t i, std::uint32_t b)
        {
            kept_positions_[i] = bodies.position[b], kept_orientations_[i] = bodies.orientation[b];
            kept_velocities_[i] = bodies.velocity[b], kept_spins_[i] = bodies.angular_velocity[b];
            kept_momenta_[i] = bodies.angular_momentum[b];
        });
    for (const std::uint32_t s : system.roots()) kept_speeds_.push_back(host.shafts.speed[s]), kept_angles_.push_back(host.shafts.angle[s]);
    std::vector<double>& speeds = moved_with_;
    speeds.assign(system.speeds().begin(), system.speeds().end());
    const auto put = [&](std::size_t at, const Vec3& v) { speeds[at] = v.x, speeds[at + 1] = v.y, speeds[at + 2] = v.z; };
    for (const HeldIsland* island : islands)
    {
        const auto& means = island->motion.means();
        for (std::size_t k = 0; k < island->members.size(); ++k)
        {
            put(6 * island->members[k], means[k].velocity / h);
            put(6 * island->members[k] + 3, means[k].momentum / h);
        }
        for (std::size_t k = 0; k < island->roots.size(); ++k)
            speeds[6 * system.body_count() + island->roots[k]] = means[island->members.size() + k].shaft / h;
    }
    system.book_forces(speeds);
    for_bodies(
        [&](std::size_t i, std::uint32_t b)
        {
            bodies.position[b] = kept_positions_[i], bodies.orientation[b] = kept_orientations_[i];
            bodies.velocity[b] = kept_velocities_[i], bodies.angular_velocity[b] = kept_spins_[i];
            bodies.angular_momentum[b] = kept_momenta_[i];
        });
    for (std::size_t i = 0; i < system.roots().size(); ++i)
        host.shafts.speed[system.roots()[i]] = kept_speeds_[i], host.shafts.angle[system.roots()[i]] = kept_angles_[i];
}

}  // namespace plab::simulation
