/// The cost of a step with each algorithm, by kind of scene, as measured. Updated with build/bin/bench_algorithms --measured,
/// whose output replaces the rows below.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace plab::model
{

/// s: the measurement does not wait longer for a step.
inline constexpr int kDearestStep = 5;
inline constexpr double kDear = std::numeric_limits<double>::infinity();

/// us of processor time per step of 1/240 s, one thread, in three kinds of scene; < 0: cannot be used there; kDear: a step
/// takes more than kDearestStep.
struct MeasuredCost
{
    std::string_view type;
    double few = 0, many = 0, tied = 0;
};
inline constexpr MeasuredCost kMeasuredCosts[] = {
    // gcc 12.2 -O2, one core of a small virtual machine; compare within a column.
    {"Manager/Direct", 5.8, 571, 52.5},
    {"Manager/SequentialImpulse", 4.31, 1.38e+03, 178},
    {"Manager/SoftStep", 11.2, 2.66e+03, 252},
    {"Resolution/Bisection", 5.09, 1.11e+03, 145},
    {"Resolution/ConservativeAdvancement", 4.99, 2e+03, 139},
    {"Resolution/LocalBisection", 5.1, 1.08e+03, 148},
    {"Resolution/LocalRoot", 4.99, 1.97e+03, 146},
    {"Resolution/None", 3.98, 555, 52.2},
    {"Resolution/Speculative", 3.85, 591, 52.4},
    {"Response/HuntCrossley", 1.79e+04, kDear, 4.32e+06},
    {"Response/Impulse", 7.57, 5.47e+04, 8.65e+04},
    {"Response/Penalty", 2.37e+03, kDear, kDear},
    {"Response/Rows", 3.89, 623, 52.8},
    {"Solver/Automatic", 2.26, 101, 22.6},
    {"Solver/DormandPrince54", 3.37, 546, 51.6},
    {"Solver/Exact", 12.6, 3.36e+03, 37.7},
    {"Solver/Exponential", 23.2, 4.61e+03, 1.1e+03},
    {"Solver/ImplicitMidpoint", 2.21, 595, 54.2},
    {"Solver/Radau5", 14.3, 2.35e+03, 313},
    {"Solver/RotationSplitting", 17.8, 3.22e+03, 159},
    {"Solver/RungeKutta4", 2.07, 100, 22.2},
    {"Solver/SemiImplicitEuler", 1.17, 50.6, 25.4},
    {"Solver/StoermerVerlet", 2.29, 86.8, 24.7},
    {"Constraint/AngularVelocity/Assign", 2.77, 79, 9.79},
    {"Constraint/AngularVelocity/Graph", 1.74, 23.2, 4.1},
    {"Constraint/AngularVelocity/Impulse", 2.98, 68.3, 7.76},
};

/// Types that can replace one another and were measured in the same scenes.
struct MeasuredFamily
{
    std::string_view prefix;                 ///< of its types' names
    std::array<std::string_view, 3> scenes;  ///< descriptions of the scenes: few, many, coupled
};
inline constexpr std::string_view kCubes[] = {"a cube at rest", "192 cubes in stacks of 3", "a stack of 20 cubes"};
inline constexpr MeasuredFamily kMeasuredFamilies[] = {
    {"Constraint/AngularVelocity/", {"a pair of shafts", "96 pairs", "a line of 20 shafts"}},
    {"Manager/", {kCubes[0], kCubes[1], kCubes[2]}},
    {"Resolution/", {kCubes[0], kCubes[1], kCubes[2]}},
    {"Response/", {kCubes[0], kCubes[1], kCubes[2]}},
    {"Solver/", {"a body in flight", "192 bodies in flight", "3 hinged bodies"}},
};

/// A family's types in one kind of scene, cheapest first, without those that cannot be used there.
struct MeasuredLadder
{
    struct Algorithm
    {
        std::string_view type;
        double us = 0;
    };
    std::string_view family, scene;
    std::vector<Algorithm> algorithms;

    /// From 1: number of types that are cheaper than this one by more than a tenth, plus one. 0: it is not in the list.
    std::size_t place_of(std::string_view type) const;
    /// "`Direct` 178 < `SequentialImpulse` 455 ~ `SoftStep` 470"; ~: within a tenth of the one before.
    std::string text() const;
};

/// Three lines for each family whose types' names begin with this prefix; all families for an empty prefix.
std::vector<MeasuredLadder> measured_ladders(std::string_view prefix = {});

/// "12.3 us (1st of 3) for a cube at rest, 456 us (3rd of 3) for ...": empty if it was not measured.
std::string measured_cost_of(std::string_view type);

}  // namespace plab::model
