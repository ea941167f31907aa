#include "import/mjcf_tendon.h"

#include <algorithm>
#include <optional>

#include "model/text.h"

namespace plab::import
{
namespace
{

/// The joint that another one follows in the end, and the ratio of their motions.
struct Leader
{
    std::string joint;
    double ratio = 1;
    std::vector<std::string> by;  ///< names of the couplings
};

Leader leader_of(const std::string& joint, const std::vector<Coupling>& couplings)
{
    Leader out{joint, 1, {}};
    for (std::size_t i = 0; i < couplings.size(); ++i)  // a ring of couplings has no leader
    {
        const auto follows = [&](const Coupling& c) { return c.kind == CouplingKind::Gear && c.second == out.joint; };
        const auto at = std::find_if(couplings.begin(), couplings.end(), follows);
        if (at == couplings.end()) break;
        out.joint = at->first, out.ratio *= at->factor;
        out.by.push_back(at->name);
    }
    return out;
}

/// The joint on which a force in the tendon acts, and by how much the tendon's length changes with its coordinate.
std::optional<Leader> leader_of(const FixedTendon& tendon, const std::vector<Coupling>& couplings)
{
    Leader out{"", 0, {}};
    for (const FixedTendon::Term& term : tendon.terms)
    {
        const Leader own = leader_of(term.joint, couplings);
        if (!out.joint.empty() && own.joint != out.joint) return {};
        out.joint = own.joint, out.ratio += term.coefficient * own.ratio;
        out.by.insert(out.by.end(), own.by.begin(), own.by.end());
    }
    if (out.joint.empty() || out.ratio == 0) return {};
    return out;
}

}  // namespace

std::vector<FixedTendon> read_tendons(const XmlElement& section, Document& document)
{
    std::vector<FixedTendon> out;
    for (const XmlElement& e : section.children)
    {
        if (e.name != "fixed") continue;
        document.list_attributes(e, {"name"});
        document.list_children(e, {"joint"});
        FixedTendon tendon;
        tendon.name = document.text(e, "name"), tendon.where = e.where;
        for (const XmlElement& joint : e.children)
            if (joint.name == "joint")
            {
                document.list_attributes(joint, {"joint", "coef"});
                tendon.terms.push_back({document.text(joint, "joint"), document.number(joint, "coef", 1)});
            }
        out.push_back(std::move(tendon));
    }
    return out;
}

void put_on_joints(Robot& robot, const std::vector<FixedTendon>& tendons, Document& document)
{
    const auto is_on_cable = [&](const Actuator& a)
    { return std::any_of(robot.cables.begin(), robot.cables.end(), [&](const Cable& c) { return c.name == a.tendon; }); };
    for (Actuator& a : robot.actuators)
    {
        if (a.tendon.empty() || is_on_cable(a)) continue;
        const auto at = std::find_if(tendons.begin(), tendons.end(), [&](const FixedTendon& t) { return t.name == a.tendon; });
        const auto leader = at == tendons.end() ? std::nullopt : leader_of(*at, robot.couplings);
        if (leader)
            a.joint = leader->joint, a.gear *= leader->ratio, a.relies_on = leader->by;
        else
            document.lost(a.where, model::quoted(a.name),
                          "is not carried over: of a tendon's actuator all joints have to follow one another (<equality>), in a <fixed> "
                          "tendon, or it "
                          "has to be a <spatial> one that is carried over");
    }
    for (const FixedTendon& t : tendons)
        if (std::none_of(robot.actuators.begin(), robot.actuators.end(), [&](const Actuator& a) { return a.tendon == t.name; }))
            document.lost(t.where, model::quoted(t.name), "is not carried over: no actuator acts by it");
    std::erase_if(robot.actuators, [&](const Actuator& a) { return a.joint.empty() && !is_on_cable(a); });
}

}  // namespace plab::import
