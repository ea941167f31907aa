// Shafts connected by couplings: speeds engage by reflected inertia, constant torques accelerate the whole train.
#include <cmath>
#include <map>

#include "exact/facts.h"
#include "model/numbers.h"

namespace plab::exact
{
namespace
{

/// A train of shafts whose speeds have fixed ratios; directory indices.
struct Train
{
    std::map<std::uint32_t, double> ratio;
    double inertia = 0;       ///< sum of ratio^2 J, kg m^2
    double speed = 0;         ///< rad/s: from sum of ratio J w, which the couplings cannot change
    double acceleration = 0;  ///< rad/s^2
};

class Gears final : public Solution
{
public:
    struct Wheel
    {
        double ratio, angle, speed, acceleration;
    };
    explicit Gears(std::map<std::string, Wheel> wheels, std::string words) : wheels_(std::move(wheels)), words_(std::move(words)) {}
    bool state(const std::string& id, double t, State& out) const override
    {
        const auto found = wheels_.find(id);
        if (found == wheels_.end()) return false;
        const Wheel& w = found->second;
        out.angle = w.angle + w.ratio * (w.speed * t + 0.5 * w.acceleration * t * t);
        out.speed = w.ratio * (w.speed + w.acceleration * t);
        return true;
    }
    std::string words() const override { return words_; }

private:
    std::map<std::string, Wheel> wheels_;
    std::string words_;
};

struct Mesh
{
    std::uint32_t driver, driven;
    double factor;
};

/// Turns of driven per turn of driver, from velocity_factor or from tooth counts.
double factor_of(const SceneFacts& facts, std::uint32_t gear)
{
    const auto teeth = [&](const char* name)
    {
        const Value v = facts.world().get(gear, name);
        const auto* n = std::get_if<std::int64_t>(&v);
        return n ? static_cast<double>(*n) : 0.0;
    };
    if (!(teeth("driver_teeth") > 0)) return real_of(facts, gear, "velocity_factor");
    const Value mesh = facts.world().get(gear, "mesh");
    const auto* kind = std::get_if<std::string>(&mesh);
    return (kind && *kind == "external" ? -1 : 1) * teeth("driver_teeth") / teeth("driven_teeth");
}

Result<std::vector<Mesh>> meshes_of(const SceneFacts& facts)
{
    std::vector<Mesh> out;
    std::vector<std::uint32_t> gears = facts.of_type("Constraint/AngularVelocity/");
    for (const std::uint32_t i : facts.of_type("Constraint/Gear")) gears.push_back(i);
    for (const std::uint32_t i : gears)
    {
        const auto driver = participants(facts, i, "driver"), driven = participants(facts, i, "driven");
        for (const auto* side : {&driver, &driven})
            if (side->size() != 1 || facts.world().component(side->front()).facet != Facet::Shaft)
                return reason(facts.world().id_of(i) + " does not couple two shafts");
        out.push_back({driver.front(), driven.front(), factor_of(facts, i)});
    }
    if (out.empty()) return reason("it has 0 couplings of shafts");
    return out;
}

/// All shafts that are connected to `first`; a loop has to close.
Result<Train> train_of(const std::vector<Mesh>& meshes, std::uint32_t first)
{
    Train out;
    out.ratio[first] = 1;
    for (bool grown = true; grown;)
    {
        grown = false;
        for (const Mesh& m : meshes)
        {
            const auto a = out.ratio.find(m.driver), b = out.ratio.find(m.driven);
            if (a != out.ratio.end() && b == out.ratio.end()) out.ratio[m.driven] = a->second * m.factor, grown = true;
            if (a == out.ratio.end() && b != out.ratio.end()) out.ratio[m.driver] = b->second / m.factor, grown = true;
            if (a != out.ratio.end() && b != out.ratio.end() && std::fabs(a->second * m.factor - b->second) > 1e-12 * std::fabs(b->second))
                return reason("a closed loop of its couplings is contradictory");
        }
    }
    return out;
}

/// Constant torque on a shaft, N m: of loads, and of a script with a number `torque` on the shafts that it drives.
double torque_on(const SceneFacts& facts, std::uint32_t shaft)
{
    double out = 0;
    for (const std::uint32_t i : facts.of_type("Field/Load"))
        for (const std::uint32_t participant : participants(facts, i, "between"))
            if (participant == shaft) out += real_of(facts, i, "shaft_torque");
    for (const std::uint32_t i : facts.of_type("Script/"))
        for (const std::uint32_t participant : participants(facts, i, "driven"))
            if (participant == shaft) out += facts.number("torque").value_or(0);
    return out;
}

}  // namespace

Result<std::unique_ptr<Solution>> make_gears(const SceneFacts& facts, double)
{
    const auto meshes = meshes_of(facts);
    if (!meshes) return meshes.errors();
    if (!facts.foreign_force({"Script/", "Constraint/AngularVelocity/", "Constraint/Gear", "Field/Load"}).empty())
        return reason("forces other than Field/Load and a script's constant torque act");
    const world::World& world = facts.world();
    const Shafts& shafts = facts.shafts();
    std::map<std::string, Gears::Wheel> wheels;
    std::string words = "closed form of gears";
    for (const Mesh& m : *meshes)
    {
        if (wheels.count(world.id_of(m.driver)) > 0) continue;
        auto train = train_of(*meshes, m.driver);
        if (!train) return train.errors();
        double momentum = 0, torque = 0;
        for (const auto& [i, ratio] : train->ratio)
        {
            const std::uint32_t row = world.component(i).host_index;
            if (!shafts.dynamic(row)) return reason("the shaft " + world.id_of(i) + " is prescribed or static");
            train->inertia += ratio * ratio * shafts.inertia[row];
            momentum += ratio * shafts.inertia[row] * shafts.speed[row], torque += ratio * torque_on(facts, i);
        }
        train->speed = momentum / train->inertia, train->acceleration = torque / train->inertia;
        for (const auto& [i, ratio] : train->ratio)
            wheels[world.id_of(i)] = {ratio, shafts.angle[world.component(i).host_index], train->speed, train->acceleration};
        words += ": " + world.id_of(m.driver) + " and " + std::to_string(train->ratio.size() - 1) + " more, inertia " +
                 model::format_real(train->inertia) + " kg m^2, from " + model::format_real(train->speed) + " rad/s with " +
                 model::format_real(train->acceleration) + " rad/s^2";
    }
    return std::unique_ptr<Solution>(std::make_unique<Gears>(std::move(wheels), std::move(words)));
}

}  // namespace plab::exact
