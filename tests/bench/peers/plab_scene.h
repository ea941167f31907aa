/// The comparison's scenes as pLab's blueprints.
#pragma once

#include <string>

#include "bench/peers/scene.h"

namespace plab::peers
{

/// One choice of algorithms: fragments of the blueprint.
struct Algorithm
{
    std::string name;      ///< as in the results
    std::string solver;    ///< attributes of the component "solver": type="Solver/..." and its parameters
    std::string contact;   ///< attributes of the CDetection component: resolution="...", space="..."
    std::string response;  ///< attributes of its response: type="Response/..." and parameters, but friction and restitution
    std::string extra;     ///< further components, e.g. a manager
    enum class Gears
    {
        Shafts,  ///< hinged bodies that only turn are shafts, one degree of freedom each
        Bodies,
    } gears = Gears::Shafts;
    std::string spring = "type=\"Constraint/SpringDamper\"";  ///< of a slider with a spring
};

/// Body i of the scene is component "b<i>" (five digits, so that the order of ids is the order of bodies).
std::string body_id(std::size_t i);
std::string blueprint_text(const Scene& scene, const Algorithm& algorithm, const Step& step);

}  // namespace plab::peers
