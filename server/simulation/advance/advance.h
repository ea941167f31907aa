/// Advances groups over a part of a step, each in the right way: by its solver alone, with the contact springs that it may touch, or with
/// the island of persistent contacts to which it belongs.
#pragma once

#include "simulation/advance/batches.h"
#include "simulation/contact_forces/contact_forces.h"

namespace plab::simulation
{

class Advance
{
public:
    Advance(StepState& step, GroupMotion& motion, ContactBook& contacts, HardContacts& hard, ContactForces& forces)
        : step_(step), motion_(motion), contacts_(contacts), hard_(hard), forces_(forces), batches_(step, motion)
    {
    }

    /// To be called after any structural change.
    void rebuild(const GroupsChange& change);
    /// The same if nothing but solvers has changed (world::Revisions).
    void solvers_changed();
    /// Advances all groups over the whole step. If no group has contacts, in batches on all threads.
    void advance_all();
    /// Advances groups from `from` to `to` (s since the start of the step), from their present state. Groups whose state they read are
    /// advanced along with them, and put back afterwards. A trial emits no events and freezes no object.
    void advance(std::span<const std::uint32_t> groups, double from, double to, WorkBook book, bool trial);

    /// Whether a manager advances the group in this step because of its joints.
    bool holds_joints_of(std::uint32_t group) const { return hard_.holds_joints_of(group); }

    BatchedAdvance& batches() { return batches_; }
    const BatchedAdvance& batches() const { return batches_; }

private:
    void find_groups_without_solver();
    void split_by_contact(std::span<const std::uint32_t> groups);
    void collect_observed(std::span<const std::uint32_t> groups);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    HardContacts& hard_;
    ContactForces& forces_;
    BatchedAdvance batches_;
    bool some_without_solver_ = false;
    IndexSet known_, touching_;  ///< scratch, groups
    std::vector<std::uint32_t> places_;
    std::vector<std::uint32_t> smooth_, in_contact_, observed_;
};

}  // namespace plab::simulation
