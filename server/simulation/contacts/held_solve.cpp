// What managers make of the islands, and what is booked, kept and reported of it.
#include <algorithm>

#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/paradox.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{

void HeldIslands::solve(std::span<HeldIsland*> islands, GroupSystem& system, double from, double to, WorkBook book, bool trial)
{
    const bool books = book.work != nullptr;
    // A shaft stands for the train of which it is the root.
    const auto energy_of_shafts = [&](const HeldIsland& island)
    {
        double sum = 0;
        for (const std::uint32_t root : island.shafts)
            if (const double mobility = mobility_of(root); mobility > 0)
                sum += 0.5 * step_.world.host().shafts.speed[root] * step_.world.host().shafts.speed[root] / mobility;
        return sum;
    };
    const auto work_on_shafts = [&](const HeldIsland& island)
    {
        double sum = 0;
        for (std::size_t k = 0; k < island.shafts.size(); ++k)
            if (const double mobility = mobility_of(island.shafts[k]); mobility > 0)
                sum += system.speed_rates()[6 * system.body_count() + island.roots[k]] / mobility *
                       island.motion.means()[island.members.size() + k].shaft;
        return sum;
    };
    for (HeldIsland* island : islands)
    {
        island->rows.clear();
        if (!island->has_rows || !system.rows()) continue;
        const std::span<const ConstraintRow> changes = system.force_changes();
        system.rows()->begin_hold(system.context(), changes);
        const std::span<const ConstraintRow> joints = system.rows()->rows();
        island->rows.assign(joints.begin(), joints.end());
        island->rows.insert(island->rows.end(), changes.begin(), changes.end());
    }
    wedging_.resize(step_.world.host().bodies.size(), 0.0);
    share(islands,
          [&](HeldIsland& island)
          {
              begin(island, system, books, trial);
              if (books) island.energy += energy_of_shafts(island);
          });
    if (!trial)
        for (const HeldIsland* island : islands) report_paradoxes(*island, step_.frame.start_time + from);
    call_managers(islands, from, to, trial);
    share(islands,
          [&](HeldIsland& island)
          {
              if (books) island.energy -= energy_of_shafts(island) - work_on_shafts(island), divide_work(island);
              if (!trial) keep(island);
          });
    for (HeldIsland* island : islands)
    {
        if (books) book_contacts(*island, book);
        if (books && book.sign > 0 && contacts_.log().on()) log_contacts(*island, from, to);
        // The cost per row of a factorisation grows with the number of rows. For kFactored rows it is taken to cost one more sweep.
        constexpr std::size_t kFactored = 400;
        const std::size_t rows = 3 * island->contacts.size() + island->rows.size();
        step_.report.swept_rows += rows * (static_cast<std::size_t>(1 + island->iterations) + rows / kFactored);
        if (trial) continue;
        note_releases(*island, from, to - from);
        if (island->meets) report_impacts(*island, step_.frame.start_time + from);
    }
}

/// What is done for an island before its manager is called.
void HeldIslands::begin(HeldIsland& island, GroupSystem& system, bool books, bool trial)
{
    world::HostTables& host = step_.world.host();
    if (!trial) find_paradoxes(island);
    island.motion.begin(system, host.bodies, host.shafts, island.members, member_of_body_, island.roots, island.contacts, island.rows,
                        books, step_.workers);
    island.energy = books ? island.motion.kinetic_energy() : 0.0;
}

Island HeldIslands::describe(HeldIsland& held, double from, double to)
{
    Island island;
    island.interruption = step_.frame.interruption;
    island.h = to - from, island.time = step_.frame.start_time + from;
    island.bodies = held.bodies, island.shafts = held.shafts;
    island.size = held.size;
    island.shaft_mobility = shaft_mobility_;
    island.rows = held.rows, island.contacts = held.contacts, island.motion = &held.motion;
    island.further_impulses = held.further, island.resistances = held.resistances;
    return island;
}

/// Each manager is called once, with all of its islands; the first one is that of the first island.
void HeldIslands::call_managers(std::span<HeldIsland*> islands, double from, double to, bool trial)
{
    shaft_mobility_.resize(step_.world.host().shafts.size());
    for (const HeldIsland* island : islands)
        for (const std::uint32_t root : island->shafts) shaft_mobility_[root] = mobility_of(root);
    for (HeldIsland* island : islands) island->solved = false;
    for (const HeldIsland* first : islands)
    {
        if (first->solved || step_.frame.give_up()) continue;
        solved_.clear(), solved_of_.clear();
        for (HeldIsland* island : islands)
            if (island->manager == first->manager) solved_.push_back(describe(*island, from, to)), solved_of_.push_back(island);
        call_manager(first->manager, from, to, trial);
        for (std::size_t i = 0; i < solved_.size(); ++i)
        {
            solved_of_[i]->solved = true, solved_of_[i]->iterations = solved_[i].iterations;
            if (!trial) step_.report.worst_residual = std::max(step_.report.worst_residual, solved_[i].residual);
        }
    }
}

void HeldIslands::call_manager(std::uint32_t manager, double from, double to, bool trial)
{
    ComponentCall answer(step_, manager);
    answer.context.time = step_.frame.start_time + from, answer.context.dt = to - from;
    answer.context.interruption = step_.frame.interruption;
    if (trial) answer.context.events = nullptr;
    answer.arguments.islands = solved_;
    step_.meter.enter(step_.meter.of_component(manager));
    step_.meter.ran(step_.world.component(manager).table, Phase::Solve);
    answer.run(Phase::Solve);
    step_.meter.leave();
}

/// Finds the work of the manager. Contacts dissipate energy, so on bodies that nothing else drives their work must not be positive, apart
/// from what position correction lifts. Energy that the method creates beyond that is not booked as work, so it remains visible as the
/// unexplained part of the ledger (ContactEnergy::created).
void HeldIslands::divide_work(HeldIsland& island)
{
    const double gained = island.motion.kinetic_energy() - island.energy;
    island.by_correction = island.motion.count_corrections();
    const double work = gained - island.motion.work_of_forces();
    island.created = island.driven || !island.rows.empty() ? 0.0 : std::max(0.0, work - island.by_correction);
    island.work = work - island.created;
}

void HeldIslands::book_contacts(const HeldIsland& island, WorkBook book)
{
    (*book.work)[island.manager] += book.sign * island.work;
    ContactEnergy& own = step_.contact_energy[island.manager];
    own.created += book.sign * island.created, own.by_correction += book.sign * island.by_correction;
}

void HeldIslands::log_contacts(const HeldIsland& island, double from, double to)
{
    ContactLog& log = contacts_.log();
    for (const Run& run : island.runs)
        for (std::uint32_t i = run.first; i < run.end; ++i)
        {
            Contact c = island.contacts[i];
            const double depth = island.motion.start_depth(i);
            const bool meets = c.approach > 0, passes_on = !meets && island.meets;
            if (!passes_on) c.impulse += island.further[i];
            if (!run.pair->ahead || !(c.impulse == Vec3{})) log.add(c, run.pair->detector, depth, from, to, meets);
            if (!passes_on || island.further[i] == Vec3{}) continue;
            c.impulse = island.further[i];
            log.add(c, run.pair->detector, depth, from, to, true);
        }
}

/// The work of the groups that are held is taken back from this time on.
void HeldIslands::take_back_contacts(double from)
{
    contacts_.log().take_back(from, [&](Ref r) { return std::binary_search(held_.begin(), held_.end(), step_.groups.of(r)); });
}

/// Reports the impulses of the joints, and moves their work from the manager's account to theirs.
void HeldIslands::report_rows(const HeldIsland& island, GroupSystem& system, double h, WorkBook book)
{
    if (island.rows.empty()) return;
    StepContext context = system.context();
    context.time += h;
    const double work = system.rows()->take_impulses(context, island.rows, h, system.row_book());
    if (book.work) (*book.work)[island.manager] -= book.sign * work;
}

/// 1/(kg m^2): inverse inertia of the gear train whose root is this shaft.
double HeldIslands::mobility_of(std::uint32_t root) const
{
    const Shafts& shafts = step_.world.host().shafts;
    const ShaftTree* tree = step_.graph.tree_of(root);
    const double inertia = tree ? tree->inertia : shafts.dynamic(root) ? shafts.inertia[root] : 0.0;
    return inertia > 0 ? 1 / inertia : 0.0;
}

void HeldIslands::find_paradoxes(HeldIsland& island)
{
    for_parts(&step_.workers, island.bodies.size(), kPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k) wedging_[island.bodies[k]] = contacts_.wedging_of(island.bodies[k]);
              });
    const auto find_in = [&](const Run& run)
    {
        const std::span<const Contact> own = island.of(run);
        const Ref a = own.front().a, b = own.front().b;
        // Where bodies are ahead of the start of the step, points may be anywhere near them.
        const bool is_near = !island.turns && run.most_depth <= contacts_.depth_that_excludes(a, b);
        const bool excluded = is_near && excludes_paradox(own.front().friction, std::max(wedging_[a.index], wedging_[b.index]));
        for (std::uint32_t i = run.first; i < run.end; ++i) island.jams[i] = !excluded && contacts_.is_paradox(island.contacts[i]) ? 1 : 0;
    };
    for_parts(&step_.workers, island.runs.size(), kRunPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k) find_in(island.runs[k]);
              });
    for (const std::uint32_t b : island.bodies) wedging_[b] = 0;
}

void HeldIslands::report_paradoxes(const HeldIsland& island, double time)
{
    for (const Run& run : island.runs)
        for (std::uint32_t i = run.first; i < run.end; ++i)
            if (island.jams[i] != 0) contacts_.report_paradox(island.contacts[i], *run.pair, time);
}

/// Finds the pairs that are released, and keeps the impulses of all others for the next step.
void HeldIslands::keep(HeldIsland& island)
{
    const auto keep_or_release = [&](Run& run)
    {
        const ContactBook::Pressing pressing = pressing_of(island, run);
        run.counts_all = pressing.counts_all;
        run.released = contacts_.stops_pressing(*run.pair, pressing);
        if (!run.released) keep_run(island, run);
    };
    for_parts(&step_.workers, island.runs.size(), kRunPart,
              [&](std::size_t begin, std::size_t end)
              {
                  for (std::size_t k = begin; k < end; ++k)
                  {
                      if (k + PairState::kAhead < end) island.runs[k + PairState::kAhead].pair->prefetch();
                      keep_or_release(island.runs[k]);
                  }
              });
}

void HeldIslands::keep_run(HeldIsland& island, const Run& run)
{
    // The impulse of an impact is not an estimate of how hard the contact will press in the next step.
    for (std::uint32_t i = run.first; i < run.end; ++i)
        if (KnownContact* const known = kept(island, run, i))
            known->impulse = island.contacts[i].approach > 0 ? Vec3{} : island.contacts[i].impulse;
    run.pair->normal = island.contacts[run.end - 1].normal;
}

/// Where the pair keeps a contact. Null if it has more of them than it can keep.
KnownContact* HeldIslands::kept(const HeldIsland& island, const Run& run, std::uint32_t contact)
{
    const std::span<KnownContact> all = run.pair->all();
    const std::uint32_t slot = island.slots[contact], feature = island.contacts[contact].feature;
    if (slot < all.size() && all[slot].feature == feature) return &all[slot];
    const auto found = std::find_if(all.begin(), all.end(), [&](const KnownContact& k) { return k.feature == feature; });
    return found == all.end() ? nullptr : &*found;
}

/// How hard a pair pressed in the last step and in this one.
ContactBook::Pressing HeldIslands::pressing_of(const HeldIsland& island, const Run& run) const
{
    ContactBook::Pressing pressing = contacts_.pressing_of(*run.pair);
    bool is_hit = false;
    for (std::uint32_t i = run.first; i < run.end; ++i)
    {
        const KnownContact* known = kept(island, run, i);
        pressing.add_impulse(island.contacts[i], known ? known->impulse : Vec3{});
        is_hit = is_hit || island.contacts[i].approach > 0;
    }
    if (is_hit) pressing.now = HUGE_VAL;  // a pair with an impact is not released
    return pressing;
}

/// Notes the releases of pairs whose points all separate.
void HeldIslands::note_releases(HeldIsland& island, double from, double h)
{
    for (const Run& run : island.runs)
    {
        if (!run.released) continue;
        ContactBook::Pressing pressing = pressing_of(island, run);
        pressing.counts_all = run.counts_all;
        for (std::uint32_t i = run.first; i < run.end; ++i)
        {
            const KnownContact* known = kept(island, run, i);
            pressing.add_speed(island.contacts[i], known ? known->impulse : Vec3{}, island.motion.start_depth(i),
                               island.motion.separation_speed(i), h);
        }
        contacts_.note_release(*run.pair, island.contacts[run.first], pressing, from, h);
        for (Contact& c : island.of(run)) c.impulse = {};
        keep_run(island, run);
    }
}

void HeldIslands::report_impacts(const HeldIsland& island, double time)
{
    for (const Run& run : island.runs)
        for (std::uint32_t i = run.first; i < run.end; ++i)
        {
            if (!(island.contacts[i].approach > 0) || island.contacts[i].impulse == Vec3{}) continue;
            Contact c = island.contacts[i];
            c.depth = island.motion.start_depth(i);
            if (PairState& pair = *run.pair; pair.ahead) pair.ahead = false, pair.since = step_.frame.tick, report_begin(pair, c, time);
            step_.emit(contacts_.contact_event("contact.impact", *run.pair, time, c, c.impulse));
        }
}

}  // namespace plab::simulation
