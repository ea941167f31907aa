/// Closed forms by name: the exact solution of a scene, without any numerical error.
/// Parameters are read from the scene, or given: "oscillator:stiffness=100,damping=2". A scene that a closed form does not
/// describe is refused with the reason.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plab/result.h"
#include "simulation/simulation.h"

namespace plab::exact
{

/// Pose and speeds of a body (p_WC, q_WB, v_WC, w_WB in W) or angle and speed of a shaft; SI.
struct State
{
    Vec3 position;
    Quat orientation;
    Vec3 velocity;
    Vec3 angular_velocity;
    double angle = 0, speed = 0;
};

/// A contact that begins.
struct ContactStart
{
    std::string kind;  ///< of the event: "contact.impact"
    std::string a, b;
    double time = 0;  ///< s
};

inline constexpr double kPrecision = 1e-14;
/// With a phase that has advanced by this many rad.
inline double precision_after(double radians) { return kPrecision + 1e-15 * radians; }

class Solution
{
public:
    virtual ~Solution() = default;
    /// False if the closed form does not cover that object.
    virtual bool state(const std::string& id, double t, State& out) const = 0;
    /// In words: the formula, and the parameters that were read.
    virtual std::string words() const = 0;
    /// Relative accuracy of the evaluation in double precision: phases lose digits with their number of turns.
    virtual double precision(double until) const { return (void)until, kPrecision; }
    /// Whether the moments of contact are part of the solution; those up to `until`.
    virtual bool knows_contacts() const { return false; }
    virtual std::vector<ContactStart> contacts(double until) const { return (void)until, std::vector<ContactStart>(); }
};

/// The data available to a closed form: the scene before its first step.
class SceneFacts
{
public:
    SceneFacts(const simulation::Simulation& simulation, std::map<std::string, double> given) : s_(&simulation), given_(std::move(given)) {}

    const simulation::Simulation& simulation() const { return *s_; }
    const world::World& world() const { return s_->world(); }
    const Bodies& bodies() const { return world().host().bodies; }
    const Shafts& shafts() const { return world().host().shafts; }
    /// Directory indices of moving objects.
    std::vector<std::uint32_t> dynamic(Facet facet) const;
    std::vector<std::uint32_t> of_type(const std::string& prefix) const;
    /// A number that was given, or that a component has under this name (a field or a script's parameter).
    std::optional<double> number(const std::string& name) const;
    /// Sum of all Field/Gravity, m/s^2.
    Vec3 gravity() const;
    /// The first type that adds forces and does not match the `known` prefixes; empty if there is none.
    std::string foreign_force(const std::vector<std::string>& known) const;
    bool collides() const { return !of_type("CDetection/").empty(); }

private:
    const simulation::Simulation* s_;
    std::map<std::string, double> given_;
};

using Maker = Result<std::unique_ptr<Solution>> (*)(const SceneFacts& facts, double until);

struct Entry
{
    std::string_view name;
    std::string_view what;   ///< formula
    std::string_view needs;  ///< requirements on the scene
    Maker make;
};
/// All closed forms, in the order of the manual.
std::span<const Entry> closed_forms();

/// `text`: NAME or NAME:key=value,key=value. `until`: the last required time, s.
Result<std::unique_ptr<Solution>> make_solution(const std::string& text, const simulation::Simulation& simulation, double until);

// Factories, by file.
Result<std::unique_ptr<Solution>> make_flight(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_oscillator(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_pendulum(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_kepler(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_bounce(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_slide(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_gears(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_rest(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_rocking(const SceneFacts& facts, double until);
Result<std::unique_ptr<Solution>> make_spring_bounce(const SceneFacts& facts, double until);

}  // namespace plab::exact
