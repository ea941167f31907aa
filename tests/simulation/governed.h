/// Scenes under governors, and what their components have.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "support/scene.h"

namespace plab::test
{

inline constexpr const char* kLadder = "Solver/SemiImplicitEuler; Solver/RungeKutta4; Solver/DormandPrince54";

inline const simulation::LevelInfo& level(const std::vector<simulation::LevelInfo>& levels, const Scene& s, const std::string& id)
{
    const auto found = std::find_if(levels.begin(), levels.end(),
                                    [&](const simulation::LevelInfo& l) { return s.simulation().world().id_of(l.component) == id; });
    REQUIRE_MESSAGE(found != levels.end(), id, " is not watched");
    return *found;
}

/// Masses on springs, all with the cheapest level, under a governor by budget. The error of that level is large.
inline std::string springs_under_budget(int count, const std::string& more)
{
    std::string out = "<component id=\"ball\" type=\"Shape/Sphere\" radius=\"0.1\"/>";
    for (int k = 0; k < count; ++k)
    {
        const std::string n = std::to_string(k);
        out += "<component id=\"post." + n + "\" type=\"State/Static\" position=\"0 " + n + " 0\"/><component id=\"bob." + n +
               "\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"1.5 " + n + " 0\" solver=\"Solver/SemiImplicitEuler\"/>" +
               "<component id=\"spring." + n + "\" type=\"Constraint/SpringDamper\" a=\"post." + n + "\" b=\"bob." + n +
               "\" length=\"1\" stiffness=\"40\"/>";
    }
    return out + "<component id=\"lod\" type=\"Governor/Budget\" watches=\"*.solver\" levels=\"" + kLadder +
           "\" budget=\"1e-3\" every=\"0.05\" dwell=\"0\" " + more + "/>";
}

/// Tells the governor "lod" what was measured, as the host does.
inline void measure(Scene& s, const char* input, Value value)
{
    REQUIRE(s.ask(simulation::SetOperation{"lod", input, std::move(value)}).done);
}

inline std::ptrdiff_t count_at(const Scene& s, std::int32_t level)
{
    const auto levels = s.simulation().levels().levels();
    return std::count_if(levels.begin(), levels.end(), [&](const simulation::LevelInfo& l) { return l.level == level; });
}

}  // namespace plab::test
