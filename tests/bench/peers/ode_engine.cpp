// ODE 0.16.2's own dynamics, as Debian builds it: double precision, built-in threading unused.
//
// Settings: `world` is dWorldStep, `quickN` is dWorldQuickStep with N iterations. ERP and CFM are ODE's defaults (0.2, 1e-10);
// sleeping is off. Contacts: approximate pyramid of friction (dContactApprox1), restitution from the first approach on, up to 4
// points between two bodies. Spaces: simple for few bodies, sweep and prune for many, as ODE's manual advises.
#include <ode/ode.h>

#include <cmath>

#include "bench/peers/case.h"
#include "bench/peers/engine.h"

namespace plab::peers
{
namespace
{

struct OdeSettings
{
    int iterations = 0;  ///< 0: dWorldStep
};

/// ODE's global tables, for as long as the process lives.
void start_library()
{
    static const int started = dInitODE2(0);
    static_cast<void>(started);
}

class OdeEngine final : public Engine
{
public:
    OdeEngine(const Scene& scene, double dt, const OdeSettings& settings) : scene_(scene), settings_(settings), dt_(dt)
    {
        start_library();
        world_ = dWorldCreate();
        space_ = scene.bodies.size() > 100 ? dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ) : dSimpleSpaceCreate(nullptr);
        contacts_ = dJointGroupCreate(0);
        dWorldSetGravity(world_, scene.gravity.x, scene.gravity.y, scene.gravity.z);
        dWorldSetAutoDisableFlag(world_, 0);
        if (settings.iterations > 0) dWorldSetQuickStepNumIterations(world_, settings.iterations);
        for (const BodySpec& b : scene.bodies) add_body(b);
        for (const JointSpec& j : scene.joints) add_joint(j);
        for (const GearSpec& g : scene.gears) add_gear(g);
        add_half_spaces();
        collides_ = scene.ground;
    }
    OdeEngine(const OdeEngine&) = delete;
    OdeEngine& operator=(const OdeEngine&) = delete;
    ~OdeEngine() override
    {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    void advance(int steps) override
    {
        for (int i = 0; i < steps; ++i)
        {
            for (const LoadSpec& load : scene_.loads) push(load);
            if (collides_) dSpaceCollide(space_, this, &OdeEngine::meet);
            if (settings_.iterations > 0)
                dWorldQuickStep(world_, dt_);
            else
                dWorldStep(world_, dt_);
            if (collides_) dJointGroupEmpty(contacts_);
        }
    }
    void read(std::span<BodyState> out) const override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i)
        {
            const dReal* p = dBodyGetPosition(bodies_[i]);
            const dReal* q = dBodyGetQuaternion(bodies_[i]);
            const dReal* v = dBodyGetLinearVel(bodies_[i]);
            const dReal* w = dBodyGetAngularVel(bodies_[i]);
            out[i].position = {p[0], p[1], p[2]};
            out[i].orientation = {q[0], q[1], q[2], q[3]};
            out[i].velocity = {v[0], v[1], v[2]};
            out[i].angular_velocity = {w[0], w[1], w[2]};
        }
    }

private:
    void add_body(const BodySpec& spec)
    {
        const dBodyID body = dBodyCreate(world_);
        dMass mass;
        dMassSetParameters(&mass, spec.mass, 0, 0, 0, spec.inertia.x, spec.inertia.y, spec.inertia.z, 0, 0, 0);
        dBodySetMass(body, &mass);
        const dQuaternion q{spec.orientation.w, spec.orientation.x, spec.orientation.y, spec.orientation.z};
        dBodySetPosition(body, spec.position.x, spec.position.y, spec.position.z);
        dBodySetQuaternion(body, q);
        dBodySetLinearVel(body, spec.velocity.x, spec.velocity.y, spec.velocity.z);
        dBodySetAngularVel(body, spec.angular_velocity.x, spec.angular_velocity.y, spec.angular_velocity.z);
        bodies_.push_back(body);
        if (spec.form == Form::Point) return;
        const dGeomID geom = spec.form == Form::Sphere ? dCreateSphere(space_, spec.half.x)
                                                       : dCreateBox(space_, 2 * spec.half.x, 2 * spec.half.y, 2 * spec.half.z);
        dGeomSetBody(geom, body);
    }
    dBodyID body(int index) const { return index == kWorld ? nullptr : bodies_[static_cast<std::size_t>(index)]; }

    void add_joint(const JointSpec& spec)
    {
        dJointID joint = nullptr;
        switch (spec.kind)
        {
            case JointKind::Hinge:
                joint = dJointCreateHinge(world_, nullptr);
                dJointAttach(joint, body(spec.child), body(spec.parent));
                dJointSetHingeAnchor(joint, spec.anchor.x, spec.anchor.y, spec.anchor.z);
                dJointSetHingeAxis(joint, spec.axis.x, spec.axis.y, spec.axis.z);
                break;
            case JointKind::Ball:
                joint = dJointCreateBall(world_, nullptr);
                dJointAttach(joint, body(spec.child), body(spec.parent));
                dJointSetBallAnchor(joint, spec.anchor.x, spec.anchor.y, spec.anchor.z);
                break;
            case JointKind::Slider:
                joint = dJointCreateSlider(world_, nullptr);
                dJointAttach(joint, body(spec.child), body(spec.parent));
                dJointSetSliderAxis(joint, spec.axis.x, spec.axis.y, spec.axis.z);
                add_spring(joint, spec);
                break;
        }
        joints_.push_back(joint);
    }
    /// ODE's manual: a stop with ERP = h k / (h k + c) and CFM = 1 / (h k + c) is a spring and damper, taken implicitly.
    void add_spring(dJointID joint, const JointSpec& spec) const
    {
        if (spec.stiffness <= 0) return;
        const double hk = dt_ * spec.stiffness;
        dJointSetSliderParam(joint, dParamLoStop, spec.rest);
        dJointSetSliderParam(joint, dParamHiStop, spec.rest);
        dJointSetSliderParam(joint, dParamStopERP, hk / (hk + spec.damping));
        dJointSetSliderParam(joint, dParamStopCFM, 1 / (hk + spec.damping));
    }
    void add_gear(const GearSpec& spec)
    {
        const JointSpec& a = scene_.joints[static_cast<std::size_t>(spec.first)];
        const JointSpec& b = scene_.joints[static_cast<std::size_t>(spec.second)];
        const dJointID joint = dJointCreateTransmission(world_, nullptr);
        dJointAttach(joint, body(a.child), body(b.child));
        // Wheels side by side turn in opposite directions, those of a chain in the same one; the ratio itself has no sign.
        dJointSetTransmissionMode(joint, spec.ratio < 0 ? dTransmissionParallelAxes : dTransmissionChainDrive);
        dJointSetTransmissionAnchor1(joint, a.anchor.x, a.anchor.y, a.anchor.z);
        dJointSetTransmissionAnchor2(joint, b.anchor.x, b.anchor.y, b.anchor.z);
        dJointSetTransmissionAxis(joint, a.axis.x, a.axis.y, a.axis.z);
        dJointSetTransmissionRatio(joint, std::fabs(spec.ratio));
    }
    void add_half_spaces() const
    {
        if (scene_.ground) dCreatePlane(space_, 0, 0, 1, 0);
        if (scene_.container <= 0) return;
        for (const double side : {1.0, -1.0})
        {
            dCreatePlane(space_, side, 0, 0, -scene_.container);
            dCreatePlane(space_, 0, side, 0, -scene_.container);
        }
    }
    void push(const LoadSpec& load) const
    {
        const JointSpec& joint = scene_.joints[static_cast<std::size_t>(load.joint)];
        const Vec3 m = joint.axis * load.torque;
        dBodyAddTorque(body(joint.child), m.x, m.y, m.z);
    }

    static void meet(void* self, dGeomID a, dGeomID b)
    {
        constexpr int kPoints = 4;
        const auto* engine = static_cast<const OdeEngine*>(self);
        dContact points[kPoints];
        const int n = dCollide(a, b, kPoints, &points[0].geom, sizeof(dContact));
        for (int i = 0; i < n; ++i)
        {
            dSurfaceParameters& surface = points[i].surface;
            surface.mode = dContactApprox1;
            surface.mu = engine->scene_.friction;
            if (engine->scene_.restitution > 0)
            {
                surface.mode |= dContactBounce;
                surface.bounce = engine->scene_.restitution;
                surface.bounce_vel = 0;
            }
            dJointAttach(dJointCreateContact(engine->world_, engine->contacts_, &points[i]), dGeomGetBody(a), dGeomGetBody(b));
        }
    }

    Scene scene_;
    OdeSettings settings_;
    double dt_;
    bool collides_ = false;
    dWorldID world_ = nullptr;
    dSpaceID space_ = nullptr;
    dJointGroupID contacts_ = nullptr;
    std::vector<dBodyID> bodies_;
    std::vector<dJointID> joints_;
};

}  // namespace

std::vector<Run> ode_runs(const Case& which, std::vector<std::string>& notes)
{
    struct Named
    {
        const char* name;
        OdeSettings settings;
    };
    std::vector<Named> offered{{"world", {0}}, {"quick20", {20}}, {"quick100", {100}}};
    if (which.scenes[0].bodies.size() >= 1000)
    {
        notes.push_back("ode world is left out of " + which.id + ": dWorldStep takes time as the cube of the contacts");
        offered.erase(offered.begin());
    }
    const bool free = !which.scenes[0].ground && which.scenes[0].joints.empty();
    if (free) offered.resize(1);  // nothing to solve: all give the same result
    std::vector<Run> runs;
    for (const Named& o : offered)
        for (const Step& step : which.ladder)
        {
            const auto make = [settings = o.settings, step](const Scene& scene)
            { return Result<std::unique_ptr<Engine>>(std::make_unique<OdeEngine>(scene, step.seconds(), settings)); };
            runs.push_back({"ode", o.name, step, "", make});
        }
    return runs;
}

}  // namespace plab::peers
