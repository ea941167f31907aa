/// The scope of a trial: the objects that a request can affect, and the components that act on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulation/step/stepper.h"

namespace plab::simulation
{

class TrialScope
{
public:
    explicit TrialScope(const world::World& world) : world_(&world) {}

    /// Adds everything that a change of this component acts on: an object itself; the participants of an interaction; for a part
    /// (response, manager, solver, shape), the same for all components that refer to it.
    void add(std::uint32_t component);
    /// Adds one object.
    void add(Ref object);
    /// Adds what a component acts on that the request has made. Only its own roles count, because nothing that existed before refers to
    /// it. What rests on a new fixed body, and what a component does that names no moving object, is not known before the step: then
    /// everything is in the scope.
    void add_new(std::uint32_t component);
    void add_everything() { everything_ = true; }
    bool has_everything() const { return everything_; }
    /// From now on at most about this many objects are in the scope, unless everything is: if a change acts on more, it is tried on a
    /// sample of them.
    void limit_to(std::size_t objects) { most_ = objects; }

    /// Extends the scope to all objects that are integrated with, coupled to, read by or in contact with those in it. `stepper`: the one
    /// that knows the present structure.
    ///
    /// If these are more than the limit, the scope becomes a sample: islands of objects spread evenly over those that were added, in
    /// their order. What is integrated or coupled stays together. Of an island that has more than its share of the limit, only the objects
    /// nearest by contacts to the chosen one are in the sample, and those that touch them are held still (holds_neighbours()). What is
    /// added to a sample later is ignored: it was drawn from all that the change acts on.
    void close(const Stepper& stepper);
    bool is_sample() const { return sample_; }
    /// Whether something moving that touches the sample is outside it.
    bool holds_neighbours() const { return holds_neighbours_; }
    void note_neighbour() { holds_neighbours_ = true; }
    /// Objects that the change acts on directly; of a sample, those from which it was drawn.
    std::size_t concerned() const { return sample_ ? concerned_ : objects(); }
    /// Determines the components that act on an object in the scope, with their parts. To be called after close().
    void choose_components();

    bool holds(Ref object) const;
    std::size_t objects() const;

    // Valid after choose_components() --------------------------------------------------------------------------------
    /// The components that take part in the trial.
    const Selection& components() const { return selection_; }
    /// Host rows of the objects in the scope, ascending.
    std::span<const std::uint32_t> bodies() const { return body_rows_; }
    std::span<const std::uint32_t> shafts() const { return shaft_rows_; }
    std::span<const std::uint32_t> quantities() const { return quantities_rows_; }
    /// Host rows of the bodies and shafts outside the scope that a component in it may see, ascending: its other participants, and all
    /// bodies if it is a detection.
    std::span<const std::uint32_t> other_bodies() const { return other_body_rows_; }
    std::span<const std::uint32_t> other_shafts() const { return other_shaft_rows_; }

private:
    class TouchingBodies;
    class Closure;

    void fit();
    void unmark();
    bool draw_sample(Closure& closure, const std::vector<Ref>& all);
    void visit(std::uint32_t component);
    bool mark(Ref object);
    bool mark_participants(std::uint32_t component);
    void mark_cluster(const Groups& groups, std::uint32_t cluster);
    void add_object(Ref object);
    bool rewinds_everything(const Stepper& stepper) const;
    void choose_on_scope();
    void list_rows();
    void list_others();
    bool carries_on(Ref object) const;
    void choose_with_parts(std::uint32_t component);
    bool acts_on_scope(std::uint32_t component) const;

    const world::World* world_;
    bool everything_ = false, sample_ = false, holds_neighbours_ = false;
    std::size_t most_ = 0, concerned_ = 0;                    ///< most_: 0: no limit
    std::vector<std::uint8_t> bodies_, shafts_, quantities_;  ///< by host row
    std::vector<Ref> marked_;                                 ///< the same, in the order in which they were found
    std::vector<std::uint32_t> fixed_;    ///< static bodies that are changed, so that bodies resting on them are in the scope
    std::vector<std::uint32_t> visited_;  ///< by directory index: the last visit_
    std::uint32_t visit_ = 0;             ///< counts the calls of add() for components
    Selection selection_;
    std::vector<std::uint32_t> body_rows_, shaft_rows_, quantities_rows_, other_body_rows_, other_shaft_rows_;
};

}  // namespace plab::simulation
