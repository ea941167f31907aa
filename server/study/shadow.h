/// A second simulation that continues from a state of a run with one level of detail for all, and how far the objects of the two are apart.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plab/levels.h"
#include "plab/result.h"
#include "simulation/simulation.h"

namespace plab::study
{

/// Carries out the operations at the present boundary, without a trial.
Result<void> ask_now(simulation::Simulation& simulation, std::vector<simulation::Operation> operations);
Result<void> give_all(simulation::Simulation& simulation, const std::vector<std::string>& components, const simulation::Level& level);

/// An object in a run and in its shadow.
struct ObjectPair
{
    Facet facet = Facet::Body;
    std::uint32_t here = 0, there = 0;  ///< host rows
};

/// All moving bodies, in id order.
std::vector<ObjectPair> body_pairs(const simulation::Simulation& run, const simulation::Simulation& shadow);
/// Of one body or shaft; false: the shadow lacks it.
bool find_pair(const simulation::Simulation& run, const simulation::Simulation& shadow, Ref object, ObjectPair& out);

struct Apart
{
    double metres = 0;   ///< |dp| + r |angle|, of a body
    double radians = 0;  ///< turn of a body or of a shaft
};
Apart apart(const simulation::Simulation& run, const simulation::Simulation& shadow, const ObjectPair& pair);

/// Pixels in the picture of a viewer for each metre at p (W, m); 0: p is not in the picture.
double pixels_per_metre(const Viewpoint& eye, const Vec3& p);
/// The largest one of all viewers.
double pixels_per_metre(const std::vector<Viewpoint>& eyes, const Vec3& p);

}  // namespace plab::study
