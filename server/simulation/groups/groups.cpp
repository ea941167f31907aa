#include "simulation/groups/groups.h"

#include <algorithm>

namespace plab::simulation
{

void DisjointSets::reset(std::size_t n)
{
    parent_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) parent_[i] = i;
}

std::uint32_t DisjointSets::find(std::uint32_t i)
{
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

void DisjointSets::join(std::uint32_t a, std::uint32_t b)
{
    a = find(a), b = find(b);
    if (a < b)
        parent_[b] = a;
    else
        parent_[a] = b;
}

namespace
{

/// The objects that an interaction acts on and those that it only reads. `joins`: it couples the objects that it acts on.
struct Participation
{
    std::vector<Ref> acts_on, reads;
    bool joins = false;
};

/// The roles of a table's components that name objects.
struct ObjectRoles
{
    std::vector<const Role*> roles;
    bool joins = false;
};

ObjectRoles object_roles(const world::Table& table)
{
    ObjectRoles out;
    for (const Role& role : table.schema().roles())
    {
        const bool in_space = std::any_of(role.facets.begin(), role.facets.end(),
                                          [](Facet f) { return f == Facet::Body || f == Facet::Shaft || f == Facet::Quantities; });
        if (in_space) out.roles.push_back(&role), out.joins = out.joins || (role.writes && !role.independent);
    }
    return out;
}

void find_participation(const world::World& world, std::uint32_t component, const ObjectRoles& of, Participation& p)
{
    p.acts_on.clear(), p.reads.clear();
    p.joins = of.joins;
    for (const Role* role : of.roles)
        world.for_each_participant(component, *role, [&](Ref ref) { (role->writes ? p.acts_on : p.reads).push_back(ref); });
}

/// Quantities that became non-finite are quarantined and treated as static until a request sets them, just as bodies and shafts are.
Motion motion_of(const world::World& world, Ref ref)
{
    const world::HostTables& host = world.host();
    if (ref.facet == Facet::Quantities) return world.component(host.component_of(ref)).quarantined ? Motion::Static : Motion::Dynamic;
    return ref.facet == Facet::Body ? host.bodies.motion[ref.index] : host.shafts.motion[ref.index];
}

/// Which solver each object names.
class SolverLookup
{
public:
    explicit SolverLookup(const world::World& world) : world_(world)
    {
        for (const auto& table : world.tables()) roles_.push_back(solver_role(*table));
    }
    /// Directory index; kNoIndex: it names none.
    std::uint32_t of(Ref ref) const
    {
        const world::Component& c = world_.component(world_.host().component_of(ref));
        return roles_[c.table] ? (*roles_[c.table]->one)[c.row].index : kNoIndex;
    }

private:
    /// The role of a table's components that names their solver; null if there is none.
    static const Role* solver_role(const world::Table& table)
    {
        for (const Role& role : table.schema().roles())
            if (role.family == "Solver/" && role.one) return &role;
        return nullptr;
    }

    const world::World& world_;
    std::vector<const Role*> roles_;  ///< by table
};

}  // namespace

/// All groups of a cluster share one solver because their stage times must agree. If members name different solvers, the one of the
/// highest order is taken; on a tie, the first one by id.
void choose_solvers(const world::World& world, Groups& groups)
{
    const SolverLookup solvers(world);
    std::vector<std::uint32_t> best(groups.clusters, kNoIndex);
    std::vector<std::uint8_t> mixed(groups.clusters, 0);
    const auto better = [&](std::uint32_t a, std::uint32_t b)
    {
        const int pa = world.type_of(a)->info.order, pb = world.type_of(b)->info.order;
        return pa != pb ? pa > pb : world.rank(a) < world.rank(b);
    };
    const auto consider = [&](const Group& group, Ref ref)
    {
        const std::uint32_t solver = solvers.of(ref);
        std::uint32_t& chosen = best[group.cluster];
        if (solver == kNoIndex || solver == chosen) return;
        if (chosen != kNoIndex) mixed[group.cluster] = 1;
        if (chosen == kNoIndex || better(solver, chosen)) chosen = solver;
    };
    for (const Group& group : groups.all)
    {
        for (const std::uint32_t b : group.bodies) consider(group, {Facet::Body, b});
        for (const std::uint32_t s : group.shafts) consider(group, {Facet::Shaft, s});
        for (const std::uint32_t q : group.quantities) consider(group, {Facet::Quantities, q});
    }
    for (Group& group : groups.all)
    {
        group.solver = best[group.cluster];
        group.mixed_solvers = mixed[group.cluster] != 0;
    }
}

namespace
{

class Builder
{
public:
    Builder(const world::World& world, const Schedule& schedule, const Selection* part, Groups& groups)
        : world_(world), schedule_(schedule), part_(part), groups_(groups)
    {
        for (const auto& table : world.tables()) roles_.push_back(object_roles(*table));
    }

    void build()
    {
        // Sets consist of ranks in the order of ids, not of indices, so that neither load order nor row numbers affect the groups.
        sets_.reset(world_.in_id_order().size());
        for_each_interaction([&](std::uint32_t component, std::uint32_t, Row) { join_members(component); });
        make_groups();
        link_rows();
        make_clusters();
        choose_solvers(world_, groups_);
    }

private:
    /// Objects outside the part count as fixed.
    Motion motion(Ref ref) const
    {
        if (part_ && part_->flags[world_.host().component_of(ref)] == 0) return Motion::Static;
        return motion_of(world_, ref);
    }
    bool is_dynamic(Ref ref) const { return motion(ref) == Motion::Dynamic; }

    /// Calls visit(component, block, row) for each force, coupling, joint (Constrain) and graph connection, in this order.
    template <class Visit>
    void for_each_interaction(Visit visit) const
    {
        for (const Phase phase : {Phase::Force, Phase::Couple, Phase::Constrain, Phase::Connect}) for_each_row(phase, visit);
    }

    template <class Visit>
    void for_each_row(Phase phase, Visit visit) const
    {
        const auto& blocks = schedule_.of(phase);
        for (std::uint32_t b = 0; b < blocks.size(); ++b)
            for (const Row row : blocks[b].rows) visit(world_.tables()[blocks[b].table]->component_of_row()[row], b, row);
    }

    /// Only dynamic objects are joined: nothing propagates through a body whose motion does not depend on forces. So all bodies that stand
    /// on one static floor, or hang on one prescribed hook, stay independent of one another.
    void join_members(std::uint32_t component)
    {
        Participation& p = participation_;
        const ObjectRoles& roles = roles_[world_.component(component).table];
        if (!roles.joins) return;
        find_participation(world_, component, roles, p);
        std::uint32_t first = kNoIndex;
        for (const Ref ref : p.acts_on)
        {
            if (!is_dynamic(ref)) continue;
            if (first == kNoIndex) first = world_.rank(ref);
            sets_.join(first, world_.rank(ref));
        }
    }

    /// The next group of the list, empty, with the memory of what was there.
    Group& next_group()
    {
        if (count_ == groups_.all.size()) groups_.all.emplace_back();
        Group& g = groups_.all[count_++];
        for (auto* list : {&g.bodies, &g.shafts, &g.quantities, &g.prescribed_bodies, &g.prescribed_shafts, &g.upstream}) list->clear();
        g.forces.clear(), g.couplings.clear(), g.rows.clear();
        return g;
    }

    std::span<const std::uint32_t> objects() const { return part_ ? part_->components : world_.in_id_order(); }

    /// Numbers the sets in the order in which the ids of their members appear, and sorts the objects into them. Prescribed objects were
    /// joined with nothing, so each has a group of its own; static ones have none.
    void make_groups()
    {
        groups_.group_of_body.assign(world_.host().bodies.size(), kNoIndex);
        groups_.group_of_shaft.assign(world_.host().shafts.size(), kNoIndex);
        groups_.group_of_quantities.assign(world_.host().quantities.size(), kNoIndex);
        std::vector<std::uint32_t> group_of_rank(world_.in_id_order().size(), kNoIndex);
        for (const std::uint32_t i : objects())
        {
            const world::Component& c = world_.component(i);
            if (c.facet != Facet::Body && c.facet != Facet::Shaft && c.facet != Facet::Quantities) continue;
            const Ref ref = c.ref(i);
            const Motion how = motion(ref);
            if (how == Motion::Static) continue;
            std::uint32_t& g = group_of_rank[sets_.find(world_.rank(i))];
            if (g == kNoIndex)
            {
                g = static_cast<std::uint32_t>(count_);
                (void)next_group();
            }
            Group& group = groups_.all[g];
            if (c.facet == Facet::Quantities)
            {
                groups_.group_of_quantities[ref.index] = g;
                group.quantities.push_back(ref.index);
                continue;
            }
            const bool body = c.facet == Facet::Body;
            (body ? groups_.group_of_body : groups_.group_of_shaft)[ref.index] = g;
            if (how == Motion::Kinematic)
                (body ? group.prescribed_bodies : group.prescribed_shafts).push_back(ref.index);
            else
                (body ? group.bodies : group.shafts).push_back(ref.index);
        }
        groups_.all.resize(count_);
    }

    /// Gives each group the rows that act on its members, and lists the groups that those rows read. A row that acts on two objects of
    /// different groups (a field that acts on each by itself, or a force between a dynamic and a prescribed object) is listed in both.
    void link_rows()
    {
        for (const Phase phase : {Phase::Force, Phase::Couple, Phase::Constrain})
            for_each_row(phase,
                         [&](std::uint32_t component, std::uint32_t block, Row row)
                         {
                             Participation& p = participation_;
                             find_participation(world_, component, roles_[world_.component(component).table], p);
                             // A constraint row belongs to the group of the dynamic participants, which can follow it. If no participant
                             // is dynamic it stays with the prescribed ones, so that its violation can still be reported.
                             const bool something_moves =
                                 std::any_of(p.acts_on.begin(), p.acts_on.end(), [&](Ref r) { return is_dynamic(r); });
                             for (const Ref ref : p.acts_on)
                             {
                                 if (groups_.of(ref) == kNoIndex) continue;
                                 if (phase == Phase::Constrain && something_moves && !is_dynamic(ref)) continue;
                                 Group& group = groups_.all[groups_.of(ref)];
                                 auto& rows = phase == Phase::Force ? group.forces : phase == Phase::Couple ? group.couplings : group.rows;
                                 rows.push_back({block, world_.rank(component), row});
                                 // The objects that an interaction acts on are read as well: a force between two bodies depends on the
                                 // state of both.
                                 for (const auto* others : {&p.reads, &p.acts_on})
                                     if (others == &p.reads || p.joins)
                                         for (const Ref other : *others)
                                             if (groups_.of(other) != kNoIndex && groups_.of(other) != groups_.of(ref))
                                                 group.upstream.push_back(groups_.of(other));
                             }
                         });
        for (Group& group : groups_.all)
            for (auto* list : {&group.forces, &group.couplings, &group.rows})
            {
                if (list->size() < 2) continue;
                std::sort(list->begin(), list->end());
                list->erase(std::unique(list->begin(), list->end()), list->end());
            }
        for (Group& group : groups_.all)
        {
            std::sort(group.upstream.begin(), group.upstream.end());
            group.upstream.erase(std::unique(group.upstream.begin(), group.upstream.end()), group.upstream.end());
        }
    }

    /// Clusters are the connected components of the relation "reads", whatever its direction.
    void make_clusters()
    {
        DisjointSets clusters(groups_.all.size());
        for (std::uint32_t g = 0; g < groups_.all.size(); ++g)
            for (const std::uint32_t up : groups_.all[g].upstream) clusters.join(g, up);
        std::vector<std::uint32_t> number(groups_.all.size(), kNoIndex);
        groups_.clusters = 0;
        for (std::uint32_t g = 0; g < groups_.all.size(); ++g)
        {
            std::uint32_t& n = number[clusters.find(g)];
            if (n == kNoIndex) n = groups_.clusters++;
            groups_.all[g].cluster = n;
        }
        sort_by_cluster();
        groups_.cluster_has_couplings.assign(groups_.clusters, 0);
        for (const Group& group : groups_.all)
            if (!group.couplings.empty()) groups_.cluster_has_couplings[group.cluster] = 1;
    }

    void sort_by_cluster()
    {
        groups_.cluster_begin.assign(groups_.clusters + 1, 0), groups_.groups_by_cluster.resize(groups_.all.size());
        for (const Group& group : groups_.all) ++groups_.cluster_begin[group.cluster + 1];
        for (std::uint32_t c = 0; c < groups_.clusters; ++c) groups_.cluster_begin[c + 1] += groups_.cluster_begin[c];
        std::vector<std::uint32_t> next = groups_.cluster_begin;
        for (std::uint32_t g = 0; g < groups_.all.size(); ++g) groups_.groups_by_cluster[next[groups_.all[g].cluster]++] = g;
    }

    const world::World& world_;
    const Schedule& schedule_;
    const Selection* part_;
    Groups& groups_;
    std::size_t count_ = 0;  ///< of groups so far
    DisjointSets sets_;
    std::vector<ObjectRoles> roles_;  ///< by table
    Participation participation_;     ///< of the interaction that is looked at
};

}  // namespace

namespace
{

/// Whether rows of a phase can be compared by the numbers of their blocks.
bool same_blocks(const Schedule& x, const Schedule& y, Phase phase)
{
    const auto same = [](const Block& a, const Block& b) { return a.table == b.table && a.command == b.command; };
    return std::ranges::equal(x.of(phase), y.of(phase), same);
}

bool same_members(const Group& x, const Group& y)
{
    return x.bodies == y.bodies && x.shafts == y.shafts && x.quantities == y.quantities && x.prescribed_bodies == y.prescribed_bodies &&
           x.prescribed_shafts == y.prescribed_shafts && x.upstream == y.upstream && x.solver == y.solver && x.cluster == y.cluster;
}

}  // namespace

GroupsChange compare_groups(const Groups& before, const Schedule& old, const Groups& now, const Schedule& schedule)
{
    GroupsChange out;
    if (before.all.size() != now.all.size()) return out;
    const auto comparison = [&](Phase phase)
    {
        return [same = same_blocks(old, schedule, phase)](const std::vector<BlockRow>& x, const std::vector<BlockRow>& y)
        { return x == y && (same || x.empty()); };
    };
    const auto same_forces = comparison(Phase::Force), same_couplings = comparison(Phase::Couple), same_rows = comparison(Phase::Constrain);
    for (std::uint32_t g = 0; g < now.all.size(); ++g)
    {
        const Group &x = before.all[g], &y = now.all[g];
        if (!same_members(x, y)) return out;
        const bool coupled = before.cluster_has_couplings[x.cluster] != 0, couples = now.cluster_has_couplings[y.cluster] != 0;
        const bool same = same_forces(x.forces, y.forces) && same_couplings(x.couplings, y.couplings) && same_rows(x.rows, y.rows);
        if (!same || coupled != couples) out.changed.push_back(g);
    }
    out.all = false;
    return out;
}

void build_groups(const world::World& world, const Schedule& schedule, Groups& groups, const Selection* part)
{
    Builder(world, schedule, part, groups).build();
}

}  // namespace plab::simulation
