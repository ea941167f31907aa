/// Figures and words about a running scene that several outputs show: the bus, the end state, the table, --explain.
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

/// CPU time that one row of each table took per step, ns, from an earlier reading of the book until now. A type's cost is
/// measured per phase; an instance's share is by rows.
std::vector<double> cost_of_rows(const simulation::Simulation& simulation, const simulation::CostBook& since = {});
/// The entry for a component; 0 for a group.
double cost_of(const std::vector<double>& cost_of_rows, const world::Component& component);

/// kinetic - kinetic at start - work: what the methods lost or made up, J.
double unexplained(const simulation::Simulation& simulation, const simulation::Totals& totals);

/// Who answers for what a detection finds: "Resolution/Bisection (rewinds the whole world), Response/Impulse".
std::string answer_of(const simulation::Simulation& simulation, const simulation::Detector& detector);

/// What does the work of each interaction, in words, by directory index; empty for what is no interaction.
std::vector<std::string> resolved_algorithms(const simulation::Simulation& simulation);

}  // namespace plab::publish
