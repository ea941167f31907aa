// What managers make of the islands, and what is booked and reported of it.
#include <algorithm>

#include "simulation/contacts/held_islands.h"
#include "simulation/contacts/paradox.h"
#include "simulation/motion/component_call.h"

namespace plab::simulation
{

void HeldIslands::solve(std::span<HeldIsland*> islands, GroupSystem& system, double from, double to, WorkBook book, bool trial)
{
    const bool books = book.work != nullptr;
    for (HeldIsland* island : islands)
    {
        island->rows.clear();
        if (!island->has_rows || !system.rows()) continue;
        system.rows()->begin_hold(system.context());
        island->rows.assign(system.rows()->rows().begin(), system.rows()->rows().end());
    }
    share(islands, [&](HeldIsland& island) { begin(island, system, books, trial); });
    if (!trial)
        for (const HeldIsland* island : islands) report_paradoxes(*island, step_.frame.start_time + from);
    if (step_.frame.give_up()) return;
    call_managers(islands, from, to, trial);
    if (books) share(islands, [&](HeldIsland& island) { divide_work(island); });
    for (HeldIsland* island : islands)
    {
        if (books) book_contacts(*island, book);
        // The cost per row of a factorisation grows with the number of rows. For kFactored rows it is taken to cost one more sweep.
        constexpr std::size_t kFactored = 400;
        const std::size_t rows = 3 * island->contacts.size() + island->rows.size();
        step_.report.swept_rows += rows * (static_cast<std::size_t>(1 + island->iterations) + rows / kFactored);
        if (trial) continue;
        note_releases(*island, from, to - from);
        keep(*island);
        report_impacts(*island, step_.frame.start_time + from);
    }
}

/// What is done for each island before its manager is called.
void HeldIslands::begin(HeldIsland& island, GroupSystem& system, bool books, bool trial)
{
    world::HostTables& host = step_.world.host();
    const auto is_paradox = [&](const Contact& c) { return may_jam(host.bodies, c) && contacts_.is_paradox(c); };
    if (!trial)
        for_parts(&step_.workers, island.contacts.size(), kPart,
                  [&](std::size_t first, std::size_t end)
                  {
                      for (std::size_t i = first; i < end; ++i) paradoxes_[island.first + i] = is_paradox(island.contacts[i]) ? 1 : 0;
                  });
    island.motion.begin(system, host.bodies, host.shafts, island.members, island.roots, island.contacts, island.rows, books, step_.workers);
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
    answer.call.islands = solved_;
    step_.meter.enter(step_.meter.of_component(manager));
    step_.meter.ran(step_.world.component(manager).table, Phase::Solve);
    answer.run(Phase::Solve);
    step_.meter.leave();
}

/// Finds the work of the manager. Contacts dissipate energy, so on bodies that nothing else drives their work must not be positive, apart
/// from what position correction lifts. Energy that the method creates beyond that is not booked as work, so it remains visible as the
/// unexplained part of the ledger (ContactEnergy::made).
void HeldIslands::divide_work(HeldIsland& island) const
{
    const Bodies& bodies = step_.world.host().bodies;
    const double gained = island.motion.kinetic_energy() - island.energy;
    island.lifted = island.motion.count_corrections();
    const double work = gained - island.motion.work_of_forces();
    const auto driven = [&](const Contact& c)
    { return bodies.motion[c.a.index] == Motion::Kinematic || bodies.motion[c.b.index] == Motion::Kinematic; };
    const bool any = !island.rows.empty() || std::any_of(island.contacts.begin(), island.contacts.end(), driven);
    island.made = any ? 0.0 : std::max(0.0, work - island.lifted);
    island.work = work - island.made;
}

void HeldIslands::book_contacts(const HeldIsland& island, WorkBook book)
{
    (*book.work)[island.manager] += book.sign * island.work;
    ContactEnergy& own = step_.contact_energy[island.manager];
    own.made += book.sign * island.made, own.lifted += book.sign * island.lifted;
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

}  // namespace plab::simulation
