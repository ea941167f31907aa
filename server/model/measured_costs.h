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
    {"Manager/Automatic", 2.56, 330, 35.2},
    {"Manager/Direct", 2.52, 322, 34.8},
    {"Manager/SequentialImpulse", 2.72, 847, 106},
    {"Manager/SoftStep", 5.57, 1.19e+03, 112},
    {"Resolution/Automatic", 3.38, 721, 35.7},
    {"Resolution/Bisection", 3.29, 674, 86.5},
    {"Resolution/ConservativeAdvancement", 3.34, 518, 51.4},
    {"Resolution/LocalBisection", 3.22, 609, 92.4},
    {"Resolution/LocalRoot", 3.4, 510, 50.1},
    {"Resolution/None", 2.52, 326, 34.8},
    {"Resolution/Speculative", 2.59, 325, 34.3},
    {"Response/Automatic", 2.58, 323, 35.5},
    {"Response/HuntCrossley", 1.24e+04, kDear, 2.84e+06},
    {"Response/Impulse", 3.08, 2.74e+04, 5.94e+04},
    {"Response/Penalty", 982, kDear, 6.11e+05},
    {"Response/Rows", 2.64, 334, 35.7},
    {"Solver/Automatic", 1.55, 66.7, 16},
    {"Solver/DormandPrince54", 2.41, 375, 22.5},
    {"Solver/Exact", 8.59, 1.54e+03, 15.7},
    {"Solver/Exponential", 12.2, 2.26e+03, 595},
    {"Solver/ImplicitMidpoint", 1.58, 240, 22.2},
    {"Solver/Radau5", 6.19, 1.07e+03, 125},
    {"Solver/RotationSplitting", 8.46, 1.54e+03, 75.7},
    {"Solver/RungeKutta4", 1.35, 55.1, 15.6},
    {"Solver/SemiImplicitEuler", 0.798, 27.3, 11.5},
    {"Solver/StoermerVerlet", 1.05, 45.1, 11.5},
    {"Constraint/AngularVelocity/Assign", 1.41, 37.7, 4.53},
    {"Constraint/AngularVelocity/Graph", 1.2, 15.6, 2.11},
    {"Constraint/AngularVelocity/Impulse", 1.48, 42.8, 5.55},
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
