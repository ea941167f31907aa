// Simbody 3.7 as Debian builds it: double precision, reduced coordinates.
//
// Settings: `rkm` is Runge-Kutta-Merson with fixed steps; with a tolerance it chooses its own steps (setAccuracy) and is sampled
// 60 times per second without interpolation; `cpodes` is CVODE's BDF, for stiff scenes. Contact is left out: Simbody's is compliant,
// which is another model.
#include <cmath>
#include <concepts>

namespace SimTK
{
/// Simbody 3.7's indices compare through int, which C++20 calls ambiguous; an exact match decides it. Before its headers.
template <class Index>
requires requires(const Index& i)
{
    {
        i.isValidExtended()
        } -> std::same_as<bool>;
}
bool operator==(const Index& a, const Index& b) { return static_cast<int>(a) == static_cast<int>(b); }
}  // namespace SimTK

#include <Simbody.h>

#include "bench/peers/case.h"
#include "bench/peers/engine.h"

namespace plab::peers
{
namespace
{

enum class Method
{
    Merson,
    Cpodes,
};

struct SimbodySettings
{
    Method method = Method::Merson;
    double accuracy = 0;  ///< 0: fixed steps
};

SimTK::Vec3 vector(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 vector(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

/// A frame at p whose `which` axis is n.
SimTK::Transform frame_along(const Vec3& n, SimTK::CoordinateAxis which, const Vec3& p)
{
    return {SimTK::Rotation(SimTK::UnitVec3(vector(n)), which), vector(p)};
}

class SimbodyEngine final : public Engine
{
public:
    SimbodyEngine(const Scene& scene, double dt, const SimbodySettings& settings)
        : scene_(scene), dt_(dt), matter_(system_), forces_(system_)
    {
        if (length(scene.gravity) > 0) SimTK::Force::UniformGravity(forces_, matter_, vector(scene.gravity));
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) add_body(i);
        for (const JointSpec& j : scene.joints) add_spring(j);
        for (const GearSpec& g : scene.gears) add_gear(g);
        for (const LoadSpec& load : scene.loads)
            SimTK::Force::MobilityConstantForce(forces_, child_of(load.joint), SimTK::MobilizerUIndex(0), load.torque);
        SimTK::State state = system_.realizeTopology();
        system_.realizeModel(state);
        set_start(state);
        if (settings.method == Method::Cpodes)
            integrator_ = std::make_unique<SimTK::CPodesIntegrator>(system_, SimTK::CPodes::BDF);
        else
            integrator_ = std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system_);
        if (settings.accuracy > 0)
            integrator_->setAccuracy(settings.accuracy);
        else
            integrator_->setFixedStepSize(dt);
        integrator_->setAllowInterpolation(settings.method == Method::Cpodes);
        integrator_->setFinalTime(scene.duration + dt);
        integrator_->initialize(state);
    }

    void advance(int steps) override
    {
        for (int i = 0; i < steps; ++i)
        {
            ++done_;
            const double until = static_cast<double>(done_) * dt_;
            while (integrator_->getTime() < until - 1e-12)
                if (integrator_->stepTo(until) == SimTK::Integrator::EndOfSimulation) return;
        }
    }
    void read(std::span<BodyState> out) const override
    {
        const SimTK::State& state = integrator_->getState();
        system_.realize(state, SimTK::Stage::Velocity);
        for (std::size_t i = 0; i < bodies_.size(); ++i)
        {
            const SimTK::Transform& X = bodies_[i].getBodyTransform(state);
            const SimTK::Quaternion q = X.R().convertRotationToQuaternion();
            out[i].position = vector(X.p());
            out[i].orientation = {q[0], q[1], q[2], q[3]};
            out[i].velocity = vector(bodies_[i].getBodyOriginVelocity(state));
            out[i].angular_velocity = vector(bodies_[i].getBodyAngularVelocity(state));
            if (is_hinged(i)) out[i].turned = bodies_[i].getOneQ(state, 0);
        }
    }

private:
    const JointSpec* joint_of(std::size_t body) const
    {
        for (const JointSpec& j : scene_.joints)
            if (static_cast<std::size_t>(j.child) == body) return &j;
        return nullptr;
    }
    bool is_hinged(std::size_t body) const
    {
        const JointSpec* j = joint_of(body);
        return j != nullptr && j->kind == JointKind::Hinge;
    }
    SimTK::MobilizedBody& child_of(int joint)
    {
        return bodies_[static_cast<std::size_t>(scene_.joints[static_cast<std::size_t>(joint)].child)];
    }

    /// Bodies of a spring between two are both on sliders of the world along its axis: the same motion, as no torque acts.
    bool slides_on_world(std::size_t body) const
    {
        for (const JointSpec& j : scene_.joints)
            if (j.kind == JointKind::Slider && (static_cast<std::size_t>(j.child) == body || j.parent == static_cast<int>(body)))
                return true;
        return false;
    }
    void add_body(std::size_t i)
    {
        const BodySpec& b = scene_.bodies[i];
        const SimTK::Body::Rigid rigid(SimTK::MassProperties(b.mass, SimTK::Vec3(0), SimTK::Inertia(vector(b.inertia))));
        const JointSpec* j = joint_of(i);
        if (slides_on_world(i))
        {
            const Vec3 axis = scene_.joints[0].axis;
            bodies_.push_back(SimTK::MobilizedBody::Slider(matter_.updGround(), frame_along(axis, SimTK::XAxis, b.position), rigid,
                                                           frame_along(axis, SimTK::XAxis, {})));
        }
        else if (j == nullptr)
            bodies_.push_back(SimTK::MobilizedBody::Free(matter_.updGround(), SimTK::Transform(), rigid, SimTK::Transform()));
        else
            add_jointed(*j, b, rigid);
    }
    void add_jointed(const JointSpec& j, const BodySpec& b, const SimTK::Body::Rigid& rigid)
    {
        const bool to_world = j.parent == kWorld;
        SimTK::MobilizedBody& parent = to_world ? matter_.updGround() : bodies_[static_cast<std::size_t>(j.parent)];
        const Vec3 parent_place = to_world ? Vec3{} : scene_.bodies[static_cast<std::size_t>(j.parent)].position;
        const SimTK::Transform on_parent = frame_along(j.axis, SimTK::ZAxis, j.anchor - parent_place);
        const SimTK::Transform on_child = frame_along(j.axis, SimTK::ZAxis, j.anchor - b.position);
        if (j.kind == JointKind::Hinge)
            bodies_.push_back(SimTK::MobilizedBody::Pin(parent, on_parent, rigid, on_child));
        else
            bodies_.push_back(SimTK::MobilizedBody::Ball(parent, on_parent, rigid, on_child));
    }
    void add_spring(const JointSpec& j)
    {
        if (j.kind != JointKind::Slider || j.stiffness <= 0) return;
        SimTK::MobilizedBody& child = bodies_[static_cast<std::size_t>(j.child)];
        if (j.parent == kWorld)
        {
            SimTK::Force::MobilityLinearSpring(forces_, child, SimTK::MobilizerQIndex(0), j.stiffness, j.rest);
            SimTK::Force::MobilityLinearDamper(forces_, child, SimTK::MobilizerUIndex(0), j.damping);
            return;
        }
        const SimTK::MobilizedBody& parent = bodies_[static_cast<std::size_t>(j.parent)];
        const double apart = dot(
            scene_.bodies[static_cast<std::size_t>(j.child)].position - scene_.bodies[static_cast<std::size_t>(j.parent)].position, j.axis);
        SimTK::Force::TwoPointLinearSpring(forces_, parent, SimTK::Vec3(0), child, SimTK::Vec3(0), j.stiffness, apart + j.rest);
        SimTK::Force::TwoPointLinearDamper(forces_, parent, SimTK::Vec3(0), child, SimTK::Vec3(0), j.damping);
    }
    /// q2 - ratio q1 = 0.
    void add_gear(const GearSpec& g)
    {
        SimTK::Vector coefficients(3, 0.0);
        coefficients[0] = -g.ratio, coefficients[1] = 1;
        SimTK::Array_<SimTK::MobilizedBodyIndex> bodies;
        bodies.push_back(child_of(g.first).getMobilizedBodyIndex()), bodies.push_back(child_of(g.second).getMobilizedBodyIndex());
        SimTK::Array_<SimTK::MobilizerQIndex> coordinates(2, SimTK::MobilizerQIndex(0));
        SimTK::Constraint::CoordinateCoupler(matter_, new SimTK::Function::Linear(coefficients), bodies, coordinates);  // takes ownership
    }
    void set_start(SimTK::State& state)
    {
        if (!scene_.joints.empty()) return;  // the joints' own zero
        for (std::size_t i = 0; i < bodies_.size(); ++i)
        {
            const BodySpec& b = scene_.bodies[i];
            const SimTK::Rotation R(SimTK::Quaternion(b.orientation.w, b.orientation.x, b.orientation.y, b.orientation.z));
            bodies_[i].setQToFitTransform(state, SimTK::Transform(R, vector(b.position)));
            system_.realize(state, SimTK::Stage::Position);
            bodies_[i].setUToFitVelocity(state, SimTK::SpatialVec(vector(b.angular_velocity), vector(b.velocity)));
        }
    }

    Scene scene_;
    double dt_;
    long done_ = 0;
    SimTK::MultibodySystem system_;
    SimTK::SimbodyMatterSubsystem matter_;
    SimTK::GeneralForceSubsystem forces_;
    std::vector<SimTK::MobilizedBody> bodies_;
    std::unique_ptr<SimTK::Integrator> integrator_;
};

Run run_with(const char* name, const Step& step, const SimbodySettings& settings, const std::string& control)
{
    const auto make = [settings, step](const Scene& scene)
    { return Result<std::unique_ptr<Engine>>(std::make_unique<SimbodyEngine>(scene, step.seconds(), settings)); };
    return {"simbody", name, step, control, make};
}

}  // namespace

std::vector<Run> simbody_runs(const Case& which, std::vector<std::string>& notes)
{
    if (which.scenes[0].ground)
    {
        notes.push_back("simbody is left out of " + which.id + ": its contact is compliant, another model");
        return {};
    }
    std::vector<Run> runs;
    std::vector<Step> ladder = which.ladder;
    if (which.id == "a" || which.id == "h") ladder = steps({1, 2, 5, 10, 20, 30, 60, 120, 240, 480, 1000});
    for (const Step& step : ladder) runs.push_back(run_with("rkm", step, {}, ""));
    const bool stiff = which.id[0] == 'i';
    for (const char* accuracy : {"1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-8", "1e-10"})
    {
        runs.push_back(run_with("rkm", {1, 60}, {Method::Merson, std::atof(accuracy)}, accuracy));
        if (stiff) runs.push_back(run_with("cpodes", {1, 60}, {Method::Cpodes, std::atof(accuracy)}, accuracy));
    }
    return runs;
}

}  // namespace plab::peers
