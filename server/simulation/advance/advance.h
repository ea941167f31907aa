/// Groups over a part of a step, each by who is to move it: its solver alone, the springs that it touches, or the island that it stands in.
#pragma once

#include "simulation/advance/batches.h"
#include "simulation/contact_forces/contact_forces.h"

namespace plab::simulation
{

class Advance
{
public:
    Advance(StepState& step, GroupMotion& motion, ContactBook& contacts, HardContacts& hard, ContactForces& forces, int threads)
        : step_(step), motion_(motion), contacts_(contacts), hard_(hard), forces_(forces), batches_(step, motion, threads)
    {
    }

    /// After any structural change.
    void rebuild();
    /// Everybody over the whole step: in batches, on as many threads as there are, where nobody touches anybody.
    void advance_all();
    /// From where their pieces are. Whom they read goes along, and comes back to where it had got to. A trial emits no events and
    /// freezes nobody.
    void advance(std::span<const std::uint32_t> groups, double from, double to, WorkBook book, bool trial);

    BatchedAdvance& batches() { return batches_; }
    const BatchedAdvance& batches() const { return batches_; }

private:
    void split_by_contact(std::span<const std::uint32_t> groups);
    void collect_observed(std::span<const std::uint32_t> groups);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    HardContacts& hard_;
    ContactForces& forces_;
    BatchedAdvance batches_;
    bool some_without_solver_ = false;
    std::vector<std::uint8_t> group_flags_;
    std::vector<std::uint32_t> smooth_, in_contact_, observed_;
};

}  // namespace plab::simulation
