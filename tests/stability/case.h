/// A stiff or extreme case: a table of algorithms by values of one parameter, each cell a scene that is run and judged.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "outcome.h"

namespace plab::stability
{

struct Case
{
    std::string name;       ///< one word, for --case
    std::string title;      ///< a heading
    std::string text;       ///< scene, measure of error, bounds
    std::string algorithm;  ///< the heading of the rows
    std::string parameter;  ///< the heading of the columns, with its unit
    std::vector<std::string> algorithms, values;
    std::function<Outcome(std::size_t algorithm, std::size_t value)> run;
    /// Cells of the default test: the quick and most informative ones.
    std::function<bool(std::size_t algorithm, std::size_t value)> quick;
    unsigned cpu_seconds = 20;  ///< of one cell, then it counts as hanging
};

/// All cases in the order of the document.
std::vector<Case> all_cases();

// One function per file of cases.
std::vector<Case> mass_cases();
std::vector<Case> spring_cases();
std::vector<Case> step_cases();
std::vector<Case> speed_cases();
std::vector<Case> extent_cases();
std::vector<Case> inertia_cases();
std::vector<Case> contact_cases();
std::vector<Case> joint_cases();
std::vector<Case> script_cases();
std::vector<Case> long_cases();

}  // namespace plab::stability
