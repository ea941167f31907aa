/// How often a world has changed, by what follows from the change.
///
/// Much is derived from the components of a world: which commands run when, which objects are integrated together, who refers to whom.
/// Whoever keeps something derived also keeps the revisions from which it was derived, and derives again only what follows from counts
/// that have grown since. Motion, and what the commands of a step write, is no change in this sense.
///
///   | count    | of                                                          | what follows                                         |
///   |----------|-------------------------------------------------------------|------------------------------------------------------|
///   | order    | additions and removals                                      | everything, because ranks change                     |
///   | solvers  | changes of components that only advance others              | who advances a group, which groups share a system;   |
///   |          | (ComponentType::only_advances)                              | not the groups, the graph, and the systems           |
///   | answers  | changes of responses, resolutions and managers              | what runs when, contacts of the present state;       |
///   |          | (ComponentType::only_answers_contacts)                      | not the groups, the graph, the systems, the sizes of |
///   |          |                                                             | bodies, and where bodies are near one another        |
///   | others   | changes of all other components: type, values,              | everything but ranks                                 |
///   |          | participants, quarantine                                    |                                                      |
///   | contacts | those of the others on which contacts may depend            | sizes of bodies, contacts of the present state       |
///   |          | (ComponentType::concerns_contacts)                          |                                                      |
#pragma once

#include <cstdint>

namespace plab::world
{

struct Revisions
{
    std::uint64_t order = 0, solvers = 0, answers = 0, others = 0, contacts = 0;

    /// Whether nothing but solvers has changed since `before`, and these have.
    bool only_solvers_since(const Revisions& before) const
    {
        return order == before.order && others == before.others && answers == before.answers && solvers != before.solvers;
    }
    /// Whether nothing but what answers contacts has changed since `before`, and this has.
    bool only_answers_since(const Revisions& before) const
    {
        return order == before.order && others == before.others && solvers == before.solvers && answers != before.answers;
    }
    /// Whether bodies that have not moved since are as near to one another as before.
    bool keeps_bodies_since(const Revisions& before) const { return order == before.order && contacts == before.contacts; }
    /// Whether nothing on which contacts may depend has changed since.
    bool keeps_contacts_since(const Revisions& before) const { return keeps_bodies_since(before) && answers == before.answers; }
};

}  // namespace plab::world
