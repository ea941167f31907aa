/// The next finer algorithm of a ladder: the reference against which a shadow step measures an error.
#pragma once

#include <string>
#include <string_view>

namespace plab::publish
{

struct Finer
{
    std::string_view type, finer;
};
/// Ordered by accuracy in the same role, not by cost: server/docs/reference.md lists the measured cost of each in each kind of
/// scene. Contact laws that are forces are not ordered: another law is another model.
inline constexpr Finer kFiner[] = {
    {"Constraint/AngularVelocity/Assign", "Constraint/AngularVelocity/Graph"},
    {"Constraint/AngularVelocity/Impulse", "Constraint/AngularVelocity/Graph"},
    {"Manager/SequentialImpulse", "Manager/Direct"},
    {"Manager/SoftStep", "Manager/Direct"},
    {"Resolution/Bisection", "Resolution/LocalRoot"},
    {"Resolution/ConservativeAdvancement", "Resolution/LocalRoot"},
    {"Resolution/LocalBisection", "Resolution/LocalRoot"},
    {"Resolution/None", "Resolution/LocalBisection"},
    {"Resolution/Speculative", "Resolution/LocalRoot"},
    {"Response/Impulse", "Response/Rows"},
    {"Solver/Automatic", "Solver/Radau5"},
    {"Solver/DormandPrince54", "Solver/Radau5"},
    {"Solver/Exact", "Solver/DormandPrince54"},
    {"Solver/Exponential", "Solver/Radau5"},
    {"Solver/ImplicitMidpoint", "Solver/Radau5"},
    {"Solver/RotationSplitting", "Solver/DormandPrince54"},
    {"Solver/RungeKutta4", "Solver/DormandPrince54"},
    {"Solver/SemiImplicitEuler", "Solver/RungeKutta4"},
    {"Solver/StoermerVerlet", "Solver/RungeKutta4"},
};

/// Empty if none of the family is finer.
inline std::string finer_than(std::string_view type)
{
    for (const Finer& f : kFiner)
        if (f.type == type) return std::string(f.finer);
    return {};
}

}  // namespace plab::publish
