/// Islands of persistent contacts whose response applies impulses (ImpactMode::Rest): time stepping without a manager.
///
/// Forces change the velocities first, then impulses keep the contacts from closing, then positions are integrated with the mean of the old
/// and new velocities, which is exact for a body that slides with constant deceleration.
#pragma once

#include "simulation/contacts/kicked_bodies.h"
#include "simulation/contacts/midpoint_contacts.h"
#include "simulation/contacts/position_correction.h"

namespace plab::simulation
{

class ImpulseIslands
{
public:
    ImpulseIslands(StepState& step, GroupMotion& motion, ContactBook& contacts, PositionCorrection& positions)
        : step_(step), motion_(motion), contacts_(contacts), positions_(positions), midpoint_(step, contacts)
    {
    }

    /// `island`: groups, ascending, that persistent contacts hold together. `observed`: groups whose state the forces read. `begins`:
    /// KnownContact::warm_start.
    void advance(std::span<const std::uint32_t> island, std::span<const std::uint32_t> observed, double from, double to, WorkBook book,
                 bool trial, bool begins);

private:
    bool meets_any(GroupSystem& system, double h) const;
    void stop_closing(std::span<const std::uint32_t> island, double from, double to, WorkBook book);
    bool advance_to_midpoint(GroupSystem& system, double h);
    void update_touching(double h);
    void report_paradoxes(double from);
    void log_touching(std::span<const std::uint32_t> island, double from, double to, bool is_impact, WorkBook book);
    void book_rest(double work, WorkBook book);
    void keep_impulses(std::span<FoundContact> contacts, double from, double h);
    void keep_impulses_of(PairState& pair, std::span<FoundContact> contacts, double from, double h);

    StepState& step_;
    GroupMotion& motion_;
    ContactBook& contacts_;
    PositionCorrection& positions_;
    MidpointContacts midpoint_;
    KickedBodies moved_;
    std::vector<FoundContact> touching_;
    std::vector<std::uint32_t> members_, places_;
};

}  // namespace plab::simulation
