/// What the comparison requires of an engine: build a scene, step it, return the states of the bodies.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/peers/scene.h"
#include "plab/result.h"

namespace plab::peers
{

struct BodyState
{
    Vec3 position;          ///< of the centre of mass, m
    Quat orientation;       ///< q_WB
    Vec3 velocity;          ///< m/s
    Vec3 angular_velocity;  ///< in W, rad/s
    /// rad about the body's hinge since the start, if the engine counts turns; NaN: to be unwound from the orientation.
    double turned = std::numeric_limits<double>::quiet_NaN();
};

/// One scene in one engine. The loop over steps is inside, so that it is the engine's own cost that is measured.
class Engine
{
public:
    virtual ~Engine() = default;
    virtual void advance(int steps) = 0;
    virtual void read(std::span<BodyState> out) const = 0;
};

/// One point of the comparison: an engine with settings and a step.
struct Run
{
    std::string engine;    ///< "ode", "bullet", "simbody", "plab"
    std::string settings;  ///< as in the results: "quick20", "RungeKutta4"
    Step step;             ///< of a method that chooses its own steps: the time between two samples
    std::string control;   ///< how such a method is controlled, e.g. "1e-6"; empty: fixed steps
    std::function<Result<std::unique_ptr<Engine>>(const Scene&)> make;

    std::string label() const { return engine + " " + settings + (control.empty() ? " dt " + step.text() : " tol " + control); }
};

struct Case;

/// The runs that an engine offers for a case, each with settings that its users would choose for it. `notes` receives what it
/// leaves out, and why.
using Adapter = std::vector<Run> (*)(const Case& which, std::vector<std::string>& notes);

std::vector<Run> ode_runs(const Case& which, std::vector<std::string>& notes);
std::vector<Run> bullet_runs(const Case& which, std::vector<std::string>& notes);
std::vector<Run> simbody_runs(const Case& which, std::vector<std::string>& notes);
std::vector<Run> plab_runs(const Case& which, std::vector<std::string>& notes);

}  // namespace plab::peers
