/// Figures and texts about a running scene that several outputs show: the bus, the final state, the table, --explain.
#pragma once

#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace plab::publish
{

/// A body or a shaft.
bool is_object(const world::Component& component);
/// Neither object nor shape nor group: fields, couplings, scripts, detections, responses, solvers, ...
bool is_interaction(const world::Component& component);
bool is_solver(const world::World& world, std::uint32_t component);

/// kinetic - kinetic at start - work: energy that the methods created or lost, J.
double unexplained(const simulation::Simulation& simulation, const simulation::Totals& totals);

/// The method that a component which chooses among several has used last (its output `resolved`); empty if it is what its name says, or
/// if it does not choose.
std::string chosen_method(const world::World& world, std::uint32_t component);

/// Which components process the results of a detection: "Resolution/Bisection (rewinds the whole world), Response/Impulse".
std::string answer_of(const simulation::Simulation& simulation, const simulation::Detector& detector);

/// The algorithm that does the work of each interaction, in words, by directory index; empty for components that are not
/// interactions.
std::vector<std::string> resolved_algorithms(const simulation::Simulation& simulation);

}  // namespace plab::publish
