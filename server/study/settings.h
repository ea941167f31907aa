/// What a study varies: types, parameters and the step length, and all their combinations.
#pragma once

#include <string>
#include <vector>

#include "model/scene.h"
#include "model/type_registry.h"

namespace plab::study
{

/// "solver=RungeKutta4" (type), "contact.thickness=1 mm" (parameter), "dt=1/240". A type without "/" is one of the kind
/// that the component has now.
struct Setting
{
    std::string target;  ///< "dt", an id, or ID.param
    std::string value;

    bool is_dt() const { return target == "dt"; }
    std::string text() const { return target + "=" + value; }
};

/// One point of a study: settings that hold together.
struct Combination
{
    std::vector<Setting> settings;
    std::string algorithm;  ///< all settings but dt, in words: what a line of a diagram stands for
    std::string dt;         ///< as written; empty: the scene's

    std::string label() const { return dt.empty() ? algorithm : algorithm + " at " + dt + " s"; }
};

/// "solver=RungeKutta4,Exact": one setting per value.
Result<std::vector<Setting>> parse_vary(const std::string& text);
/// "NAME: solver=RungeKutta4 contact.response=None": settings that go together, by blanks; the name is optional.
struct Algorithm
{
    std::string name;
    std::vector<Setting> settings;
};
Result<Algorithm> parse_algorithm(const std::string& text);

/// Whether each run gets a name of its own and no setting is overridden by another: a target varied twice, a value given
/// twice, a algorithm that sets what is varied as well are refused.
Result<void> check_settings(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied);

/// Each algorithm (or none) with each choice of every vary; dt varies fastest, so that a algorithm's points stand together.
std::vector<Combination> combine(const std::vector<Algorithm>& algorithms, const std::vector<std::vector<Setting>>& varied);

/// The scene with the settings. The error says which setting does not hold and what would be right.
Result<model::SceneSpec> apply(const model::SceneSpec& scene, model::TypeSource& types, const std::vector<Setting>& settings);

/// "Solver/RungeKutta4" of a component for which "RungeKutta4" was written.
std::string full_type_name(const std::string& present_type, const std::string& written);

/// The shortest time at which all step lengths have a boundary, as a step length itself; none if it does not fit 64 bits or
/// a length is not rational.
Result<model::StepLength> common_instants(const std::vector<model::StepLength>& lengths);

}  // namespace plab::study
