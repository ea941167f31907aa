/// Ladders of algorithms: which type of a family is the next finer one. A shadow step measures an error against it, and governors move
/// components along it (server/docs/levels.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plab::model
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

/// The longest chain of ever finer types in a family ("Solver", "Constraint/AngularVelocity"), from the coarsest to the finest; of equally
/// long ones that which begins with the type that comes first by name. Empty if the family has no order.
inline std::vector<std::string> default_ladder(std::string_view family)
{
    std::vector<std::string> longest;
    for (const Finer& f : kFiner)
    {
        if (f.type.size() <= family.size() + 1 || !f.type.starts_with(family) || f.type[family.size()] != '/') continue;
        std::vector<std::string> chain{std::string(f.type)};
        for (std::string next = finer_than(f.type); !next.empty(); next = finer_than(next)) chain.push_back(next);
        if (chain.size() > longest.size()) longest = std::move(chain);
    }
    return longest;
}

}  // namespace plab::model
