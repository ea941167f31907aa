/// The energy of islands in a run and in its shadow: what one of them makes or loses and the other does not.
///
/// The energy of an object is its kinetic energy and its share of what conservative interactions store (Phase::Potential): that of a body
/// in a field is its own, and that of a spring or of a contact belongs to both ends, which are in one island, or to the one that moves.
#pragma once

#include <string>
#include <vector>

#include "plab/result.h"
#include "simulation/simulation.h"

namespace plab::study
{

class IslandEnergies
{
public:
    /// Objects are those that move in the run now.
    void begin(const simulation::Simulation& run);
    /// To be called at each boundary after that. Islands grow: what is connected by forces, couplings or contacts in one of the two, at any
    /// of these boundaries, is one island. Errors: a component stores energy without saying whose it is.
    Result<void> look(simulation::Simulation& run, simulation::Simulation& shadow);
    /// J: what the islands of these objects of the run have more than in the shadow, together; negative: less.
    double excess(const simulation::Simulation& run, std::span<const Ref> objects);

private:
    /// Where the objects are in one of the two simulations.
    struct Rows
    {
        std::uint64_t revision = 0;
        bool known = false;
        std::vector<std::uint32_t> body, shaft;  ///< by host row: position in ids_, or kNoIndex

        std::uint32_t of(Ref object) const;
    };

    void find_rows(const simulation::Simulation& of, Rows& rows) const;
    void join(const simulation::Simulation& of, const Rows& rows);
    Result<void> add_energies(simulation::Simulation& of, const Rows& rows, double sign);

    std::vector<std::string> ids_;
    simulation::DisjointSets islands_;
    std::vector<double> excess_;  ///< J, by object; after look(): of its island, by the representative of that
    Rows here_, there_;
    std::vector<std::uint32_t> counted_;  ///< islands of one call of excess()
};

}  // namespace plab::study
