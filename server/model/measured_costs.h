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
    {"Manager/Automatic", 2.79, 320, 38.5},
    {"Manager/Direct", 3.03, 344, 34.5},
    {"Manager/SequentialImpulse", 3.48, 906, 82.9},
    {"Manager/SoftStep", 6.84, 1.08e+03, 79.1},
    {"Resolution/Automatic", 3.74, 754, 36.9},
    {"Resolution/Bisection", 3.7, 665, 56.5},
    {"Resolution/ConservativeAdvancement", 3.92, 511, 51.4},
    {"Resolution/LocalBisection", 3.51, 615, 99.9},
    {"Resolution/LocalRoot", 4, 532, 51.2},
    {"Resolution/None", 2.86, 324, 34.5},
    {"Resolution/Speculative", 2.83, 322, 34.5},
    {"Response/Automatic", 2.83, 310, 35.7},
    {"Response/HuntCrossley", 192, 1.2e+05, 2.46e+04},
    {"Response/Impulse", 3.73, 2.93e+04, 8.16e+03},
    {"Response/Penalty", 267, 1.54e+05, 2.18e+04},
    {"Response/Rows", 2.79, 321, 34.4},
    {"Solver/Articulated", 2.46, 385, 10.3},
    {"Solver/Automatic", 1.53, 66.8, 15.9},
    {"Solver/DormandPrince54", 2.42, 373, 22.1},
    {"Solver/Exact", 8.42, 1.51e+03, 15.4},
    {"Solver/Exponential", 12, 2.23e+03, 592},
    {"Solver/ImplicitMidpoint", 1.55, 228, 21.8},
    {"Solver/Radau5", 5.92, 1.05e+03, 122},
    {"Solver/RotationSplitting", 8.37, 1.52e+03, 75},
    {"Solver/RungeKutta4", 1.42, 54.9, 15.5},
    {"Solver/SemiImplicitEuler", 0.822, 27.5, 11.2},
    {"Solver/StoermerVerlet", 1.08, 44.9, 11.3},
    {"Constraint/AngularVelocity/Assign", 1.51, 44.4, 5.53},
    {"Constraint/AngularVelocity/Graph", 1.26, 25.1, 2.47},
    {"Constraint/AngularVelocity/Impulse", 1.56, 51.3, 7.03},
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
