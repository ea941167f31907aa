/// What the rest of a sleeping body depends on, as a hash: as long as it is the same, nothing has happened that would move the body.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/contacts/contact_book.h"

namespace plab::simulation
{

class SleepCauses
{
public:
    SleepCauses(const StepState& step, const ContactBook& contacts) : step_(step), contacts_(contacts) {}

    /// To be called before the following, whenever parameters may have changed.
    void begin();
    /// What concerns all bodies: objects that never move, detections with their resolutions, responses and managers, materials, and
    /// exclusions from collision.
    std::uint64_t of_scene();
    /// What concerns one body: its place, mass and shapes, the forces on it, and its contacts, which add_pair() adds up. Never 0.
    std::uint64_t of_body(std::uint32_t body);
    void add_pair(const PairState& pair);

private:
    std::uint64_t of_component(std::uint32_t component);
    std::uint64_t of_name(std::uint32_t component) const;
    std::uint64_t of_place(std::uint32_t body);
    std::uint64_t of_filter() const;

    const StepState& step_;
    const ContactBook& contacts_;
    std::vector<std::uint64_t> known_;  ///< by component; 0: not known
    std::vector<std::uint64_t> pairs_;  ///< by body
    ByteWriter bytes_;
};

}  // namespace plab::simulation
