#include "simulation/advance/batches.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace plab::simulation
{
namespace
{

/// A solver that chooses its algorithm may declare this command in addition to its own. It either advances several groups together without
/// changing a bit of the result, or refuses (by an error) and leaves the state at the start of the advance. Then the groups are split, if
/// necessary down to single clusters.
constexpr std::string_view kTogether = "Solver/AdvanceTogether";

bool is_together(const CommandInfo& command) { return command.phase == Phase::Advance && command.name == kTogether; }

const CommandInfo* together_command(const world::World& world, std::uint32_t solver)
{
    if (solver == kNoIndex) return nullptr;
    const auto& commands = world.type_of(solver)->info.commands;
    const auto found = std::find_if(commands.begin(), commands.end(), is_together);
    return found == commands.end() ? nullptr : &*found;
}

struct Cluster
{
    std::uint32_t number = 0;
    std::span<const std::uint32_t> groups;
    std::size_t load = 0;
    std::uint32_t solver = kNoIndex;
};

/// The clusters, in the order of their first group.
std::vector<Cluster> clusters_of(const Groups& groups)
{
    std::vector<Cluster> out(groups.clusters);
    for (std::uint32_t c = 0; c < groups.clusters; ++c)
    {
        out[c].number = c, out[c].groups = groups.of_cluster(c);
        for (const std::uint32_t g : out[c].groups)
        {
            const Group& group = groups.all[g];
            out[c].solver = group.solver;
            out[c].load += group.bodies.size() + group.shafts.size() + group.quantities.size() + 1;
        }
    }
    return out;
}

/// Takes half of the clusters out of a part that has several, and returns them; empty if it has one.
std::vector<std::uint32_t> half_of(const Groups& groups, std::vector<std::uint32_t>& part)
{
    std::vector<std::uint32_t> clusters;
    for (const std::uint32_t g : part) clusters.push_back(groups.all[g].cluster);
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    if (clusters.size() < 2) return {};
    const std::uint32_t middle = clusters[clusters.size() / 2];
    const auto stays = [&](std::uint32_t g) { return groups.all[g].cluster < middle; };
    std::vector<std::uint32_t> taken;
    std::copy_if(part.begin(), part.end(), std::back_inserter(taken), [&](std::uint32_t g) { return !stays(g); });
    std::erase_if(part, [&](std::uint32_t g) { return !stays(g); });
    return taken;
}

/// A solver takes a part through all of its stages before the next one. So many objects, and the scripts and forces that act on them,
/// stay in the cache of a core meanwhile.
constexpr std::size_t kMostInPart = 128;

/// The latest part that clusters may share, as an index: by batch, solver, and split_ (kNoIndex where sharing changes no bit).
using SharedParts = std::map<std::tuple<const Batch*, std::uint32_t, std::uint32_t>, std::size_t>;

/// Adds a cluster to the latest part of its kind, or to a new one if that is full. `split`: its value of split_; kNoIndex: it always
/// shares.
void share(Batch& batch, const Cluster& cluster, std::uint32_t split, SharedParts& shared)
{
    const std::tuple key(&batch, cluster.solver, split);
    std::size_t& place = shared.try_emplace(key, batch.parts.size()).first->second;
    if (place < batch.parts.size() && batch.parts[place].load + cluster.load > kMostInPart) place = batch.parts.size();
    if (place == batch.parts.size()) batch.add_part(cluster.solver);
    Batch::Part& part = batch.parts[place];
    part.load += cluster.load;
    part.groups.insert(part.groups.end(), cluster.groups.begin(), cluster.groups.end());
}

}  // namespace

void BatchedAdvance::rebuild(const GroupsChange& change)
{
    if (divides_as_before(change)) return follow(change);
    batches_.clear();
    divide_again();
}

/// Whether the clusters would be divided as they are: they have the same members and solvers, share systems as before, and none is split.
bool BatchedAdvance::divides_as_before(const GroupsChange& change) const
{
    if (!ready_ || change.all || std::ranges::any_of(split_, [](std::uint32_t part) { return part != 0; })) return false;
    const auto shares_as_before = [&](std::uint32_t g)
    {
        const std::uint32_t cluster = step_.groups.all[g].cluster;
        return sharing_of(step_.groups.of_cluster(cluster)) == sharing_[cluster];
    };
    return std::ranges::all_of(change.changed, shares_as_before);
}

/// Sets up the systems of groups that have changed, and of those that cannot follow the change.
void BatchedAdvance::follow(const GroupsChange& change)
{
    std::vector<std::uint8_t> changed(step_.groups.all.size(), 0);
    for (const std::uint32_t g : change.changed) changed[g] = 1;
    for (Batch& batch : batches_)
    {
        batch.scratch->fit(step_.world);
        batch.meter.accounts().fit(step_.world.components().size(), step_.world.tables().size());
        batch.work.assign(step_.work.size(), 0.0);
        for (Batch::Part& part : batch.parts)
            if (std::ranges::any_of(part.groups, [&](std::uint32_t g) { return changed[g] != 0; }) || !part.system->follow(step_.frame))
                part.system->configure(step_.frame, part.groups);
    }
}

BatchedAdvance::Sharing BatchedAdvance::sharing_of(std::span<const std::uint32_t> groups) const
{
    const auto any = [&](auto holds) { return std::ranges::any_of(groups, [&](std::uint32_t g) { return holds(step_.groups.all[g]); }); };
    if (!any([&](const Group& g) { return motion_.goes_alone(g); })) return Sharing::Always;
    const bool held = any([](const Group& g) { return !g.rows.empty(); });
    return !held && together_command(step_.world, step_.groups.all[groups.front()].solver) ? Sharing::UnlessRefused : Sharing::Alone;
}

void BatchedAdvance::divide_again()
{
    ready_ = false;
    split_.assign(step_.groups.clusters, 0);
}

void BatchedAdvance::continue_split(const std::vector<std::uint32_t>& split)
{
    split_ = split, split_.resize(step_.groups.clusters, 0);
    ready_ = false;
}

std::uint64_t BatchedAdvance::take_evaluations()
{
    std::uint64_t sum = 0;
    for (Batch& batch : batches_)
        if (batch.scratch) sum += std::exchange(batch.scratch->evaluations, 0), batch.scratch->held_bodies = 0;
    return sum;
}

std::uint64_t BatchedAdvance::held_bodies() const
{
    std::uint64_t sum = 0;
    for (const Batch& batch : batches_)
        if (batch.scratch) sum += batch.scratch->held_bodies;
    return sum;
}

void BatchedAdvance::plan()
{
    std::vector<Batch> batches;
    divide(batches);
    set_up(batches);
    batches_ = std::move(batches);
}

/// One batch for each thread, in whole clusters: a group that reads another one must share its stage times.
void BatchedAdvance::divide(std::vector<Batch>& batches)
{
    std::vector<Cluster> clusters = clusters_of(step_.groups);
    std::size_t total = 0;
    sharing_.clear();
    for (const Cluster& c : clusters) sharing_.push_back(sharing_of(c.groups)), total += c.load;
    std::stable_sort(clusters.begin(), clusters.end(),
                     [&](const Cluster& a, const Cluster& b) { return sharing_[a.number] < sharing_[b.number]; });
    batches.reserve(static_cast<std::size_t>(step_.workers.threads()));  // pointers to batches must stay valid
    SharedParts shared;
    std::map<std::uint32_t, std::size_t> home;
    for (const Cluster& c : clusters)
    {
        // A solver that keeps state between advances serves its clusters one after the other, in a fixed order.
        const bool keeps = c.solver != kNoIndex && !step_.world.type_of(c.solver)->info.elementwise;
        const auto known = keeps ? home.find(c.solver) : home.end();
        Batch& batch = known != home.end() ? batches[known->second] : lightest_batch(batches, total);
        if (keeps) home.emplace(c.solver, static_cast<std::size_t>(&batch - batches.data()));
        batch.load += c.load;
        if (sharing_[c.number] == Sharing::Alone)
            batch.add_part(c.solver).groups.assign(c.groups.begin(), c.groups.end());
        else
            share(batch, c, sharing_[c.number] == Sharing::Always ? kNoIndex : split_[c.number], shared);
    }
}

/// Gives the parts their systems. One that the batches so far have for the same groups serves again.
void BatchedAdvance::set_up(std::vector<Batch>& batches)
{
    std::vector<Batch::Part*> part_before(step_.groups.all.size(), nullptr);  // by the first of its groups: each group is in one part
    for (Batch& batch : batches_)
        for (Batch::Part& part : batch.parts) part_before[part.groups.front()] = &part;
    for (std::size_t b = 0; b < batches.size(); ++b)
    {
        Batch& batch = batches[b];
        if (b < batches_.size())
            batch.scratch = std::move(batches_[b].scratch);
        else
            batch.scratch = std::make_unique<StageScratch>(), batch.scratch->fit(step_.world);
        batch.meter.accounts().fit(step_.world.components().size(), step_.world.tables().size());
        batch.scratch->measure_with(batches.size() == 1 ? step_.meter : batch.meter);
        batch.work.assign(step_.work.size(), 0.0);
        for (Batch::Part& part : batch.parts)
        {
            std::sort(part.groups.begin(), part.groups.end());  // once: a part may have gathered thousands of clusters
            Batch::Part* before = part_before[part.groups.front()];
            if (before && before->groups == part.groups)
            {
                part.system = std::move(before->system);
                part.system->borrow(*batch.scratch);
                continue;
            }
            part.system = std::make_unique<GroupSystem>(*batch.scratch);
            part.system->configure(step_.frame, part.groups);
        }
    }
}

Batch& BatchedAdvance::lightest_batch(std::vector<Batch>& batches, std::size_t total_load) const
{
    const auto threads = static_cast<std::size_t>(step_.workers.threads());
    for (Batch& batch : batches)
        if (batch.load * threads < total_load) return batch;
    if (batches.size() < threads) return batches.emplace_back();
    return *std::min_element(batches.begin(), batches.end(), [](const Batch& x, const Batch& y) { return x.load < y.load; });
}

Batch::Part& Batch::add_part(std::uint32_t solver)
{
    Part& part = parts.emplace_back();
    part.solver = solver;
    return part;
}

void BatchedAdvance::run_batch(Batch& batch, std::vector<double>& work)
{
    for (std::size_t i = 0; i < batch.parts.size(); ++i)
    {
        // The frame changes in each step; the pointers in it stay the same.
        batch.parts[i].system->set_frame(step_.frame);
        while (!run_solver(batch.parts[i], work, batch.events))
        {
            Batch::Part& rest = batch.add_part(batch.parts[i].solver);
            rest.groups = half_of(step_.groups, batch.parts[i].groups);
            for (const std::uint32_t g : rest.groups) split_[step_.groups.all[g].cluster] = step_.groups.all[rest.groups.front()].cluster;
            batch.split = true;
            rest.system = std::make_unique<GroupSystem>(*batch.scratch);
            rest.system->configure(step_.frame, rest.groups);
            batch.parts[i].system->configure(step_.frame, batch.parts[i].groups);
        }
    }
}

void BatchedAdvance::run_batch_measured(Batch& batch)
{
    batch.meter.start();
    run_batch(batch, batch.work);
    batch.meter.stop();
}

/// False if the solver refuses to advance its several clusters together.
bool BatchedAdvance::run_solver(Batch::Part& part, std::vector<double>& work, EventSink& events)
{
    const auto cluster = [&](std::uint32_t g) { return step_.groups.all[g].cluster; };
    const bool several =
        std::any_of(part.groups.begin(), part.groups.end(), [&](std::uint32_t g) { return cluster(g) != cluster(part.groups.front()); });
    const CommandInfo* together = several ? together_command(step_.world, part.solver) : nullptr;
    if (!together)
    {
        part.fine = motion_.run_solver(*part.system, part.solver, 0, step_.frame.step, {&work, 1}, &events);
        return true;
    }
    CostMeter& meter = part.system->meter();
    const CostScope scope(meter, meter.of_component(part.solver));
    part.system->begin(0, step_.frame.step, {&work, 1}, &events);
    if (!motion_.call_solver(*part.system, part.solver, *together)) return false;
    part.fine = part.system->finish();
    return true;
}

void BatchedAdvance::emit_in_order()
{
    // Sort events so that their order does not depend on the partition.
    std::vector<Event> all;
    for (Batch& batch : batches_)
    {
        std::move(batch.events.events.begin(), batch.events.events.end(), std::back_inserter(all));
        batch.events.events.clear();
    }
    const auto key = [&](const Event& e) { return std::pair(e.time, e.component == kNoIndex ? kNoIndex : step_.world.rank(e.component)); };
    std::stable_sort(all.begin(), all.end(), [&](const Event& x, const Event& y) { return key(x) < key(y); });
    for (Event& event : all) step_.emit(std::move(event));
}

void BatchedAdvance::advance()
{
    if (!ready_) plan();
    const bool alone = batches_.size() == 1;
    if (alone)
        run_batch(batches_.front(), step_.work);
    else
    {
        const CostScope scope(step_.meter, waiting_ns_);
        step_.workers.run(batches_.size(), [this](std::size_t b) { run_batch_measured(batches_[b]); });
    }
    emit_in_order();
    // After a split the batches are planned again, so that the order of the parts follows from split_ and not from the history.
    ready_ = std::none_of(batches_.begin(), batches_.end(), [](const Batch& b) { return b.split; });
    for (Batch& batch : batches_)
    {
        for (Batch::Part& part : batch.parts)
        {
            if (!part.fine) motion_.freeze(*part.system);
            motion_.take_reports(*part.system);
        }
        if (alone) continue;
        step_.meter.accounts() += batch.meter.accounts();
        batch.meter.accounts().clear();
        for (std::size_t i = 0; i < step_.work.size(); ++i) step_.work[i] += batch.work[i];
        std::fill(batch.work.begin(), batch.work.end(), 0.0);
    }
}

}  // namespace plab::simulation
