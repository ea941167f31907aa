/// Who takes part in a trial: the objects that a swap can touch, and the components between them.
#pragma once

#include <cstdint>
#include <vector>

#include "simulation/step/stepper.h"

namespace plab::simulation
{

class TrialScope
{
public:
    explicit TrialScope(const world::World& world) : world_(&world) {}

    /// Whatever a change of this component acts on: an object itself; the participants of an interaction; of a part (response,
    /// manager, solver, shape) those of whoever has it.
    void add(std::uint32_t component);
    /// This object.
    void add(Ref object);
    void add_everything() { everything_ = true; }
    bool has_everything() const { return everything_; }

    /// Goes on to whoever is integrated, coupled, read or touched together with those who are in: to be called with the stepper that knows
    /// the structure.
    void close(const Stepper& stepper);
    /// Which components act on somebody in it, with their parts. After close().
    void choose_components();

    bool holds(Ref object) const;
    /// By directory index; after choose_components().
    const std::vector<std::uint8_t>& components() const { return components_; }
    std::size_t objects() const;

private:
    void fit();
    void visit(std::uint32_t component);
    bool mark(Ref object);
    bool close_over_clusters(const Groups& groups);
    void add_object(Ref object);
    template <class Pairs>
    bool close_over_pairs(const Pairs& pairs);
    bool rewinds_everybody(const Stepper& stepper) const;
    bool carries_on(Ref object) const;
    void choose_with_parts(std::uint32_t component);
    bool acts_on_scope(std::uint32_t component) const;

    const world::World* world_;
    bool everything_ = false;
    std::vector<std::uint8_t> bodies_, shafts_, quantities_;  ///< by host row
    std::vector<std::uint8_t> fixed_;                         ///< static bodies that are changed: those who lie on them are in
    std::vector<std::uint8_t> components_, visited_;          ///< by directory index
};

}  // namespace plab::simulation
