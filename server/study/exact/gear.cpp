// Two shafts that a coupling holds together: speeds engage by reflected inertia, a constant torque turns both.
#include <cmath>

#include "model/values.h"
#include "study/exact/exact.h"

namespace plab::study
{
namespace
{

class GearPair final : public ExactSolution
{
public:
    GearPair(std::string driver, std::string driven, double ratio, double angle1, double angle2, double speed, double acceleration)
        : driver_(std::move(driver)),
          driven_(std::move(driven)),
          ratio_(ratio),
          angle1_(angle1),
          angle2_(angle2),
          speed_(speed),
          acceleration_(acceleration)
    {
    }
    bool state(const std::string& id, double t, ExactState& out) const override
    {
        if (id != driver_ && id != driven_) return false;
        const double turned = speed_ * t + 0.5 * acceleration_ * t * t, r = id == driver_ ? 1.0 : ratio_;
        out.angle = (id == driver_ ? angle1_ : angle2_) + r * turned;
        out.speed = r * (speed_ + acceleration_ * t);
        return true;
    }
    std::string words() const override
    {
        return "closed form of a gear pair: ratio " + model::format_real(ratio_) + ", driver from " + model::format_real(speed_) +
               " rad/s with " + model::format_real(acceleration_) + " rad/s^2";
    }

private:
    std::string driver_, driven_;
    double ratio_, angle1_, angle2_, speed_, acceleration_;
};

}  // namespace

Result<std::unique_ptr<ExactSolution>> make_gear_pair(const SceneFacts& facts, double)
{
    const world::World& world = facts.world();
    const auto gears = facts.of_type("Constraint/AngularVelocity/");
    if (gears.size() != 1) return reason("it has " + std::to_string(gears.size()) + " couplings of shafts; this form is about one");
    const auto find = [&](const char* role) -> std::uint32_t
    {
        for (const Role& r : world.table_of(gears.front()).schema().roles())
            if (r.name == role)
                for (const Ref ref : world.participants(gears.front(), r)) return world.host().component_of(ref);
        return kNoIndex;
    };
    const std::uint32_t driver = find("driver"), driven = find("driven");
    if (driver == kNoIndex || driven == kNoIndex) return reason("its coupling has no driver and driven shaft");
    const std::uint32_t a = world.component(driver).host_index, b = world.component(driven).host_index;
    const Shafts& shafts = facts.shafts();
    if (!shafts.dynamic(a) || !shafts.dynamic(b)) return reason("one of the two shafts is prescribed or static");
    if (!facts.foreign_force({"Script/", "Constraint/AngularVelocity/"}).empty())
        return reason("other forces act than a script's constant torque");
    const double r = std::get<double>(world.get(gears.front(), "velocity_factor"));
    const double J = shafts.inertia[a] + r * r * shafts.inertia[b];
    // The momentum that the coupling cannot change: J1 w1 + r J2 w2.
    const double speed = (shafts.inertia[a] * shafts.speed[a] + r * shafts.inertia[b] * shafts.speed[b]) / J;
    return std::unique_ptr<ExactSolution>(std::make_unique<GearPair>(world.id_of(driver), world.id_of(driven), r, shafts.angle[a],
                                                                     shafts.angle[b], speed, facts.number("torque").value_or(0) / J));
}

}  // namespace plab::study
