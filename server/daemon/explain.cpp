#include "daemon/explain.h"

#include <map>

#include "model/numbers.h"
#include "publish/figures.h"
#include "simulation/contacts/contact_rules.h"
#include "simulation/step/step_tree.h"

namespace plab::daemon
{
namespace
{

std::string plugins_text(const plugins::PluginLibrary& library)
{
    std::string out = "plugins loaded\n";
    for (const plugins::PluginInfo& p : library.loaded()) out += "  " + p.name + "  " + p.path + "\n";
    std::map<std::string, std::string> unused;
    for (const std::string& type : library.names())
    {
        bool loaded = false;
        for (const plugins::PluginInfo& p : library.loaded())
            for (const std::string& t : p.types) loaded = loaded || t == type;
        if (!loaded) unused[type.substr(0, type.find('/'))] += " " + type;
    }
    out += "types not loaded: the blueprint does not use them\n";
    for (const auto& [kind, types] : unused) out += "  " + kind + ":" + types + "\n";
    return out;
}

std::string step_text(const simulation::Stepper& stepper)
{
    std::string out = "the step\n";
    for (const simulation::StepNode& node : simulation::kStepTree)
    {
        const bool needed = (stepper.*node.needed)();
        out += std::string("  ") + (needed ? "runs      " : "left out  ") + std::string(name_of(node.stage)) + "." +
               std::string(node.name) + ": " + std::string(node.what) + "\n";
    }
    return out;
}

std::string groups_text(const simulation::Simulation& s)
{
    const simulation::Groups& groups = s.stepper().groups();
    std::string out = "solver groups: " + std::to_string(groups.all.size()) + "\n";
    std::size_t shown = 0;
    for (const simulation::Group& g : groups.all)
    {
        if (++shown > 20)
        {
            out += "  ...\n";
            break;
        }
        out += "  ";
        for (const std::uint32_t b : g.bodies) out += s.world().id_of(Ref{Facet::Body, b}) + " ";
        for (const std::uint32_t b : g.prescribed_bodies) out += s.world().id_of(Ref{Facet::Body, b}) + " ";
        for (const std::uint32_t x : g.shafts) out += s.world().id_of(Ref{Facet::Shaft, x}) + " ";
        for (const std::uint32_t x : g.prescribed_shafts) out += s.world().id_of(Ref{Facet::Shaft, x}) + " ";
        if (g.bodies.empty() && g.shafts.empty())
            out += "- prescribed motion, no solver";
        else if (g.solver != kNoIndex)
            out += "- " + s.world().type_of(g.solver)->info.name + " (" + s.world().id_of(g.solver) + ")";
        if (g.mixed_solvers) out += ", its members name different solvers: the one of the highest order is used";
        out += "\n";
    }
    for (const simulation::ShaftTree& t : s.stepper().graph().trees())
        out += "constraint graph: " + std::to_string(t.count) + " shafts move with " + s.world().id_of(Ref{Facet::Shaft, t.root}) +
               ", one degree of freedom, " + std::to_string(t.redundant) + " redundant couplings\n";
    return out;
}

std::string collision_text(const simulation::Simulation& s)
{
    std::string out;
    for (const simulation::Detector& d : s.stepper().detectors())
        out += "collision " + s.world().id_of(d.component) + ": " + publish::answer_of(s, d) + "\n";
    for (const std::string& sentence : simulation::unused_in_contacts(s.world(), s.stepper().detectors())) out += "  " + sentence + "\n";
    if (out.empty()) out = "collision: none, so no memento is kept and no contacts are searched for\n";
    return out;
}

}  // namespace

std::string explain(const simulation::Simulation& s, const plugins::PluginLibrary& library)
{
    std::size_t bodies = 0, shafts = 0;
    for (const std::uint32_t i : s.world().in_id_order())
    {
        bodies += s.world().component(i).facet == Facet::Body ? 1 : 0;
        shafts += s.world().component(i).facet == Facet::Shaft ? 1 : 0;
    }
    std::string out =
        "objects: " + std::to_string(bodies) + " bodies in space, " + std::to_string(shafts) + " shafts with one degree of freedom\n";
    if (bodies == 0) out += "no 3-D state: no body is in the scene\n";
    return out + plugins_text(library) + step_text(s.stepper()) + groups_text(s) + collision_text(s);
}

std::string explain_choices(const simulation::Simulation& s)
{
    std::string out;
    const std::vector<std::string> resolved = publish::resolved_algorithms(s);
    for (const std::uint32_t i : s.world().in_id_order())
        if (const model::ComponentType* type = s.world().type_of(i); type && type->schema.find_field("reason"))
            out += "  " + s.world().id_of(i) + " (" + type->info.name + "): " + resolved[i] + "\n";
    return out.empty() ? out : "chosen in a first step\n" + out;
}

std::string explain_rules(const simulation::Simulation& s)
{
    std::map<std::string, std::string> made;
    for (const model::ComponentSpec& spec : s.world().scene().components)
        if (!spec.made_by.empty() && spec.parent.empty())
            made[spec.made_by] += " " + spec.id + (spec.type.empty() ? "" : " (" + spec.type + ")");
    std::string out;
    for (const model::ComponentSpec& spec : s.world().scene().components)
    {
        const model::ComponentType* type = spec.type.empty() ? nullptr : s.world().type_of(s.world().find(spec.id));
        const auto by_it = made.find(spec.id);
        if ((!type || type->info.family != "Rule") && by_it == made.end()) continue;
        out += "  " + spec.id + (spec.name.empty() ? "" : ", " + spec.name) + ":" + (by_it == made.end() ? " nothing yet" : by_it->second) +
               "\n";
    }
    return out.empty() ? out : "made by rules at " + model::format_real(s.time()) + " s\n" + out;
}

}  // namespace plab::daemon
