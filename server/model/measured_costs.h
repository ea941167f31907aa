/// What a step costs with each algorithm, by kind of scene: measured, not promised. Renewed by build/bin/bench_rungs --measured.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace plab::model
{

/// us per step of 1/240 s, one thread; < 0: refused there. Contacts (Manager/, Resolution/ and Response/, the others at their
/// defaults): one cube at rest, 192 cubes in 64 stacks of 3, one stack of 20 cubes, all with friction 0.6. Solvers: one body in
/// flight, 192 of them, three hinged bodies.
struct MeasuredCost
{
    std::string_view type;
    double few = 0, many = 0, tied = 0;
};
inline constexpr std::initializer_list<MeasuredCost> kMeasuredCosts = {
    // gcc 12.2 -O2, one core of a small virtual machine with other work beside it; compare within a column.
};

/// "12.3 us a step with one body, 456 with 192, 78 in a stack of 20"; empty if it was not measured.
std::string measured_cost_of(std::string_view type);

}  // namespace plab::model
