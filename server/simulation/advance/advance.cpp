#include "simulation/advance/advance.h"

#include <algorithm>

namespace plab::simulation
{

void Advance::rebuild(const GroupsChange& change)
{
    find_groups_without_solver();
    batches_.rebuild(change);
}

void Advance::solvers_changed()
{
    find_groups_without_solver();
    batches_.divide_again();
}

void Advance::find_groups_without_solver()
{
    const auto has_no_solver = [](const Group& g)
    { return g.solver == kNoIndex && !(g.bodies.empty() && g.shafts.empty() && g.quantities.empty()); };
    some_without_solver_ = std::any_of(step_.groups.all.begin(), step_.groups.all.end(), has_no_solver);
}

void Advance::advance_all()
{
    contacts_.cache().forget_parked();
    if (forces_.any()) forces_.begin_step();
    hard_.begin_step();
    const bool some_sleep = hard_.any_asleep();
    if (some_without_solver_ || some_sleep || hard_.needs_islands() || (forces_.any() && forces_.any_near()))
        advance(some_sleep ? hard_.awake_groups() : step_.all_groups, 0, step_.frame.step, step_.book(), false);
    else
        batches_.advance();
    motion_.save_ends();
}

void Advance::split_by_contact(std::span<const std::uint32_t> groups)
{
    touching_.begin(step_.groups.all.size());
    contacts_.resting().find(groups, places_);
    for (const std::uint32_t place : places_)
        for (const PairState& p = contacts_.cache().pairs()[place]; const Ref r : {p.a, p.b})
            if (const std::uint32_t g = step_.groups.of(r); g != kNoIndex) touching_.add(g);
    for (const std::uint32_t g : groups)
        if (hard_.holds_joints_of(g)) touching_.add(g);
    smooth_.clear(), in_contact_.clear();
    for (const std::uint32_t g : groups)
    {
        const Group& group = step_.groups.all[g];
        const bool moves = !(group.bodies.empty() && group.shafts.empty());
        (touching_.has(g) && moves ? in_contact_ : smooth_).push_back(g);
    }
}

void Advance::collect_observed(std::span<const std::uint32_t> groups)
{
    known_.begin(step_.groups.all.size());
    for (const std::uint32_t g : groups) known_.add(g);
    observed_.clear();
    const auto add_upstream = [&](std::uint32_t g)
    {
        for (const std::uint32_t up : step_.groups.all[g].upstream)
            if (known_.add(up)) observed_.push_back(up);
    };
    for (const std::uint32_t g : groups) add_upstream(g);
    for (std::size_t i = 0; i < observed_.size(); ++i) add_upstream(observed_[i]);
    std::sort(observed_.begin(), observed_.end());
}

void Advance::advance(std::span<const std::uint32_t> groups, double from, double to, WorkBook book, bool trial)
{
    collect_observed(groups);
    // Observed groups first advance from the start of their pieces to `from`; they are put back to the end of the step afterwards.
    if (!observed_.empty())
    {
        for (const std::uint32_t g : observed_) motion_.rewind(g);
        const bool together =
            std::all_of(observed_.begin(), observed_.end(), [&](std::uint32_t g) { return motion_.segment_begin(g) == 0; });
        if (together && from > 0) motion_.advance_smooth(observed_, {}, 0, from, {}, true);
        for (const std::uint32_t g : observed_)
            if (!together && motion_.segment_begin(g) < from)
                motion_.advance_smooth(std::span(&g, 1), {}, motion_.segment_begin(g), from, {}, true);
    }
    split_by_contact(groups);
    if (forces_.any())
    {
        forces_.take(groups, smooth_, in_contact_, from, to);
        forces_.advance(observed_, from, to, book, trial);
    }
    if (!in_contact_.empty()) hard_.advance(in_contact_, observed_, from, to, book, trial);
    if (!smooth_.empty()) motion_.advance_smooth(smooth_, observed_, from, to, book, trial);
    for (const std::uint32_t g : observed_) motion_.restore_end(g);
}

}  // namespace plab::simulation
