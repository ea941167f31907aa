/// What a study varies: types, parameters and the step length, and all their combinations.
#pragma once

#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"

namespace plab::study
{

/// "solver=RungeKutta4" (type), "contact.thickness=1 mm" (parameter), "dt=1/240". A type without "/" is one of the kind that
/// the component has now.
struct Setting
{
    std::string target;  ///< "dt", an id, or ID.param
    std::string value;

    bool is_dt() const { return target == "dt"; }
    std::string text() const { return target + "=" + value; }
};

/// One point of a study: a combination of settings.
struct Combination
{
    std::vector<Setting> settings;
    std::string algorithm;  ///< all settings except dt, in words: the name of a line in a diagram
    std::string dt;         ///< as written; empty: the scene's

    std::string label() const { return dt.empty() ? algorithm : algorithm + " at " + dt + " s"; }
};

/// "solver=RungeKutta4,Exact": one setting per value.
Result<std::vector<Setting>> parse_vary(const std::string& text);
/// "NAME: solver=RungeKutta4 contact.response=None": settings that belong together, separated by spaces; the name is optional.
struct Algorithm
{
    std::string name;
    std::vector<Setting> settings;
};
Result<Algorithm> parse_algorithm(const std::string& text);

/// Checks that each run gets a unique name and that no setting overrides another: a target varied twice, a value given
/// twice, an algorithm that sets what is varied as well are refused.
Result<void> check_settings(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied);

/// Each algorithm (or none) with each choice of every vary; dt varies fastest, so that an algorithm's points are adjacent.
std::vector<Combination> combine(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied);

/// The scene with the settings. The error names the setting that is not possible, and the alternatives.
Result<model::SceneSpec> apply(const model::SceneSpec& scene, model::TypeSource& types, const std::vector<Setting>& settings);

/// "Solver/RungeKutta4" for a component whose type was written as "RungeKutta4".
std::string full_type_name(const std::string& present_type, const std::string& written);

/// The shortest time at which all step lengths have a boundary, as a step length itself; empty if it does not fit 64 bits or a
/// length is not rational.
Result<model::StepLength> common_instants(const std::vector<model::StepLength>& lengths);

}  // namespace plab::study
