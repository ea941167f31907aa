// The algorithm that does the work of each interaction: solvers by the groups that they actually advance, detections by the
// components that process their results.
#include <algorithm>
#include <map>

#include "publish/figures.h"
#include "simulation/contacts/sleeping_pairs.h"

namespace plab::publish
{
namespace
{

/// The current value of a text output of a component; empty if it has none of that name.
std::string text_of(const world::World& world, std::uint32_t component, const std::string& output)
{
    if (!world.table_of(component).schema().find_field(output)) return {};
    const Value value = world.get(component, output);
    const auto* text = std::get_if<std::string>(&value);
    return text ? *text : std::string();
}

}  // namespace

std::string chosen_method(const world::World& world, std::uint32_t component)
{
    const std::string method = text_of(world, component, "resolved");
    return world.type_of(component)->info.name.ends_with("/" + method) ? std::string() : method;
}

namespace
{

/// The work of a solver in the current structure.
struct Use
{
    std::size_t groups = 0, objects = 0, mixed = 0, resting = 0;
    std::map<std::uint32_t, std::size_t> others;  ///< objects that name it but are advanced by another solver, by that solver
};

std::string counted(std::size_t n, const std::string& what) { return std::to_string(n) + " " + what + (n == 1 ? "" : "s"); }

/// The solver that an object names; kNoIndex if it has no such role.
std::uint32_t named_solver(const world::World& world, Ref object)
{
    const std::uint32_t component = world.host().component_of(object);
    for (const Role& role : world.table_of(component).schema().roles())
        if (role.family == "Solver/")
            for (const Ref solver : world.participants(component, role)) return solver.index;
    return kNoIndex;
}

std::vector<std::uint8_t> resting_groups(const simulation::Stepper& stepper)
{
    std::vector<std::uint8_t> out(stepper.groups().all.size(), 0);
    stepper.contacts().each_pair(
        [&](const simulation::PairState& pair)
        {
            for (const Ref r : {pair.a, pair.b})
                if (const std::uint32_t g = pair.resting ? stepper.groups().of(r) : kNoIndex; g != kNoIndex) out[g] = 1;
        });
    return out;
}

std::map<std::uint32_t, Use> uses_of_solvers(const simulation::Simulation& s)
{
    std::map<std::uint32_t, Use> out;
    const std::vector<std::uint8_t> resting = resting_groups(s.stepper());
    const std::vector<simulation::Group>& groups = s.stepper().groups().all;
    for (std::size_t g = 0; g < groups.size(); ++g)
    {
        const simulation::Group& group = groups[g];
        if (group.solver == kNoIndex) continue;
        Use& use = out[group.solver];
        ++use.groups, use.objects += group.bodies.size() + group.shafts.size();
        use.mixed += group.mixed_solvers ? 1 : 0, use.resting += resting[g];
        if (!group.mixed_solvers) continue;
        const auto note = [&](Ref object)
        {
            if (const std::uint32_t named = named_solver(s.world(), object); named != kNoIndex && named != group.solver)
                ++out[named].others[group.solver];
        };
        for (const std::uint32_t b : group.bodies) note({Facet::Body, b});
        for (const std::uint32_t x : group.shafts) note({Facet::Shaft, x});
    }
    return out;
}

/// The method that a component with a choice or fallback reports, and why; empty if it is what its name says.
std::string choice_of(const world::World& world, std::uint32_t component)
{
    const std::string method = chosen_method(world, component), why = text_of(world, component, "reason");
    if (method.empty()) return {};
    return ", by " + method + (why.empty() ? "" : " (last choice: " + why + ")");
}

std::string words_for_solver(const world::World& world, std::uint32_t solver, const Use& use)
{
    std::string out = use.groups == 0 ? "nothing" : world.type_of(solver)->info.name;
    if (use.groups > 0) out += ": " + counted(use.groups, "group") + ", " + counted(use.objects, "object") + choice_of(world, solver);
    if (use.groups == 0 && use.others.empty()) out += ": no moving object uses it";
    if (use.mixed > 0) out += "; in " + counted(use.mixed, "group") + " some members name another solver";
    for (const auto& [other, objects] : use.others)
        out += "; " + counted(objects, "object") + " that use it: " + world.type_of(other)->info.name + " (" + world.id_of(other) +
               "), of whose group they are members";
    if (use.resting > 0) out += "; " + counted(use.resting, "group") + " with resting contacts: time stepping";
    return out;
}

}  // namespace

std::vector<std::string> resolved_algorithms(const simulation::Simulation& s)
{
    const world::World& world = s.world();
    std::vector<std::string> out(world.components().size());
    const std::map<std::uint32_t, Use> uses = uses_of_solvers(s);
    for (const std::uint32_t i : world.in_id_order())
    {
        const world::Component& c = world.component(i);
        if (!is_interaction(c)) continue;
        const auto use = uses.find(i);
        if (c.quarantined)
            out[i] = "nothing: it failed and takes no part";
        else if (is_solver(world, i))
            out[i] = words_for_solver(world, i, use == uses.end() ? Use{} : use->second);
        else
            out[i] = world.type_of(i)->info.name + choice_of(world, i);
    }
    for (const simulation::Detector& d : s.stepper().detectors()) out[d.component] += ": " + answer_of(s, d);
    return out;
}

}  // namespace plab::publish
