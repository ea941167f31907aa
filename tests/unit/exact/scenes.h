/// Closed forms of scenes that a test writes down.
#pragma once

#include <algorithm>

#include "exact/closed_form.h"
#include "support/scene.h"

namespace plab::test
{

/// The state of an object after t seconds, by the closed form of this name.
inline exact::State exact_at(const Scene& scene, const std::string& name, const std::string& id, double t)
{
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    const auto solution = exact::make_solution(name, scene.simulation(), std::max(t, 10.0));
    REQUIRE_MESSAGE(solution.ok(), (solution ? "" : solution.error().text()));
    exact::State out;
    REQUIRE((*solution)->state(id, t, out));
    return out;
}

/// Why there is no closed form of this name; "none" if there is one.
inline std::string refusal(const Scene& scene, const std::string& name)
{
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    const auto solution = exact::make_solution(name, scene.simulation(), 1);
    return solution ? "none" : solution.error().text();
}

}  // namespace plab::test
