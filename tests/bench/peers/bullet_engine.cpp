// Bullet 3.24 as Debian builds it: single precision.
//
// Settings: `siN` is the sequential impulse solver with N iterations, `mlcp` the direct one (Dantzig). `erp0_cpt0` sets erp, erp2
// and the bodies' contact processing threshold to 0: the first adds speed to a bounce, the second answers contacts before they
// touch and so eats the restitution. In all: restitution threshold 0, sleeping off, btDbvtBroadphase, one fixed step per call.
// Free bodies: `implicit` is Bullet's default for the gyroscopic term, `explicit` the other one.
#include <btBulletDynamicsCommon.h>

#include <BulletDynamics/ConstraintSolver/btGearConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>

#include <cmath>

#include "bench/peers/case.h"
#include "bench/peers/engine.h"

namespace plab::peers
{
namespace
{

struct BulletSettings
{
    int iterations = 10;
    bool direct = false;
    bool clean_bounce = false;  ///< erp0_cpt0
    bool explicit_gyro = false;
    bool limited_spring = false;  ///< Bullet's own cap of stiffness and damping by the step
};

btScalar real(double v) { return static_cast<btScalar>(v); }
btVector3 vector(const Vec3& v) { return {real(v.x), real(v.y), real(v.z)}; }
Vec3 vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// A frame at p whose x axis is n.
btTransform frame_along(const Vec3& n, const Vec3& p)
{
    const Vec3 u = any_perpendicular(n), v = cross(n, u);
    const btMatrix3x3 R(real(n.x), real(u.x), real(v.x), real(n.y), real(u.y), real(v.y), real(n.z), real(u.z), real(v.z));
    return btTransform(R, vector(p));
}

class BulletEngine final : public Engine
{
public:
    BulletEngine(const Scene& scene, double dt, const BulletSettings& settings)
        : scene_(scene), settings_(settings), dt_(real(dt)), dispatcher_(&configuration_)
    {
        if (settings.direct)
            solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
        else
            solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
        world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(), &configuration_);
        world_->setGravity(vector(scene.gravity));
        btContactSolverInfo& info = world_->getSolverInfo();
        info.m_numIterations = settings.iterations;
        info.m_restitutionVelocityThreshold = 0;
        if (settings.direct) info.m_minimumSolverBatchSize = 1;
        if (settings.clean_bounce) info.m_erp = info.m_erp2 = 0;
        for (const BodySpec& b : scene.bodies) add_body(b);
        for (const JointSpec& j : scene.joints) add_joint(j);
        for (const GearSpec& g : scene.gears) add_gear(g);
        add_half_spaces();
    }
    BulletEngine(const BulletEngine&) = delete;
    BulletEngine& operator=(const BulletEngine&) = delete;
    ~BulletEngine() override
    {
        for (const auto& joint : joints_) world_->removeConstraint(joint.get());
        for (const auto& body : bodies_) world_->removeRigidBody(body.get());
        for (const auto& body : fixed_) world_->removeRigidBody(body.get());
    }

    void advance(int steps) override
    {
        for (int i = 0; i < steps; ++i)
        {
            for (const LoadSpec& load : scene_.loads) push(load);
            world_->stepSimulation(dt_, 0);
        }
    }
    void read(std::span<BodyState> out) const override
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i)
        {
            const btTransform& X = bodies_[i]->getCenterOfMassTransform();
            const btQuaternion q = X.getRotation();
            out[i].position = vector(X.getOrigin());
            out[i].orientation = {q.w(), q.x(), q.y(), q.z()};
            out[i].velocity = vector(bodies_[i]->getLinearVelocity());
            out[i].angular_velocity = vector(bodies_[i]->getAngularVelocity());
        }
    }

private:
    btCollisionShape* shape_of(const BodySpec& b)
    {
        for (const auto& [half, shape] : shapes_)
            if (half == b.half) return shape.get();
        std::unique_ptr<btCollisionShape> made;
        if (b.form == Form::Point) made = std::make_unique<btEmptyShape>();
        if (b.form == Form::Sphere) made = std::make_unique<btSphereShape>(real(b.half.x));
        if (b.form == Form::Box) made = std::make_unique<btBoxShape>(vector(b.half));
        shapes_.emplace_back(b.half, std::move(made));
        return shapes_.back().second.get();
    }
    /// Bullet multiplies the two bodies' coefficients.
    void set_surface(btRigidBody& body) const
    {
        body.setFriction(real(std::sqrt(scene_.friction)));
        body.setRestitution(real(std::sqrt(scene_.restitution)));
        if (settings_.clean_bounce) body.setContactProcessingThreshold(0);
    }
    void add_body(const BodySpec& b)
    {
        btRigidBody::btRigidBodyConstructionInfo info(real(b.mass), nullptr, shape_of(b), vector(b.inertia));
        const Quat& q = b.orientation;
        info.m_startWorldTransform = btTransform(btQuaternion(real(q.x), real(q.y), real(q.z), real(q.w)), vector(b.position));
        auto body = std::make_unique<btRigidBody>(info);
        body->setLinearVelocity(vector(b.velocity));
        body->setAngularVelocity(vector(b.angular_velocity));
        body->setActivationState(DISABLE_DEACTIVATION);
        if (settings_.explicit_gyro) body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT);
        set_surface(*body);
        // Without ground nothing collides.
        scene_.ground ? world_->addRigidBody(body.get()) : world_->addRigidBody(body.get(), 0, 0);
        bodies_.push_back(std::move(body));
    }
    void add_plane(const Vec3& n, double offset)
    {
        planes_.push_back(std::make_unique<btStaticPlaneShape>(vector(n), real(offset)));
        const btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, planes_.back().get());
        fixed_.push_back(std::make_unique<btRigidBody>(info));
        set_surface(*fixed_.back());
        world_->addRigidBody(fixed_.back().get());
    }
    void add_half_spaces()
    {
        if (scene_.ground) add_plane({0, 0, 1}, 0);
        if (scene_.container <= 0) return;
        for (const double side : {1.0, -1.0}) add_plane({side, 0, 0}, -scene_.container), add_plane({0, side, 0}, -scene_.container);
    }

    btRigidBody& body(int i) { return *bodies_[static_cast<std::size_t>(i)]; }
    btVector3 local(int i, const Vec3& point) const { return vector(point - scene_.bodies[static_cast<std::size_t>(i)].position); }
    void add_joint(const JointSpec& j)
    {
        std::unique_ptr<btTypedConstraint> joint;
        const btVector3 axis = vector(j.axis), at_child = local(j.child, j.anchor);
        const bool to_world = j.parent == kWorld;
        if (j.kind == JointKind::Ball && to_world) joint = std::make_unique<btPoint2PointConstraint>(body(j.child), at_child);
        if (j.kind == JointKind::Ball && !to_world)
            joint = std::make_unique<btPoint2PointConstraint>(body(j.child), body(j.parent), at_child, local(j.parent, j.anchor));
        if (j.kind == JointKind::Hinge && to_world) joint = std::make_unique<btHingeConstraint>(body(j.child), at_child, axis);
        if (j.kind == JointKind::Hinge && !to_world)
            joint = std::make_unique<btHingeConstraint>(body(j.child), body(j.parent), at_child, local(j.parent, j.anchor), axis, axis);
        if (j.kind == JointKind::Slider) joint = make_spring(j);
        world_->addConstraint(joint.get(), true);
        joints_.push_back(std::move(joint));
    }
    /// Axis 0 is free and sprung, the other five are locked.
    std::unique_ptr<btTypedConstraint> make_spring(const JointSpec& j)
    {
        const Vec3 child_place = scene_.bodies[static_cast<std::size_t>(j.child)].position;
        const btTransform at_child = frame_along(j.axis, j.anchor - child_place);
        std::unique_ptr<btGeneric6DofSpring2Constraint> joint;
        if (j.parent == kWorld)
            joint = std::make_unique<btGeneric6DofSpring2Constraint>(body(j.child), at_child);
        else
        {
            const Vec3 parent_place = scene_.bodies[static_cast<std::size_t>(j.parent)].position;
            joint = std::make_unique<btGeneric6DofSpring2Constraint>(body(j.parent), body(j.child),
                                                                     frame_along(j.axis, j.anchor - parent_place), at_child);
        }
        joint->setLinearLowerLimit({1, 0, 0}), joint->setLinearUpperLimit({-1, 0, 0});
        joint->setAngularLowerLimit({0, 0, 0}), joint->setAngularUpperLimit({0, 0, 0});
        joint->enableSpring(0, true);
        joint->setStiffness(0, real(j.stiffness), settings_.limited_spring);
        joint->setDamping(0, real(j.damping), settings_.limited_spring);
        joint->setEquilibriumPoint(0, real(j.rest));
        return joint;
    }
    /// Bullet holds w_A . a + ratio w_B . b = 0.
    void add_gear(const GearSpec& g)
    {
        const JointSpec& a = scene_.joints[static_cast<std::size_t>(g.first)];
        const JointSpec& b = scene_.joints[static_cast<std::size_t>(g.second)];
        joints_.push_back(
            std::make_unique<btGearConstraint>(body(a.child), body(b.child), vector(a.axis), vector(b.axis), real(-1 / g.ratio)));
        world_->addConstraint(joints_.back().get(), true);
    }
    void push(const LoadSpec& load)
    {
        const JointSpec& joint = scene_.joints[static_cast<std::size_t>(load.joint)];
        body(joint.child).applyTorque(vector(joint.axis * load.torque));
    }

    Scene scene_;
    BulletSettings settings_;
    btScalar dt_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btDantzigSolver dantzig_;
    std::unique_ptr<btConstraintSolver> solver_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::vector<std::pair<Vec3, std::unique_ptr<btCollisionShape>>> shapes_;
    std::vector<std::unique_ptr<btStaticPlaneShape>> planes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_, fixed_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

struct Named
{
    const char* name;
    BulletSettings settings;
};

std::vector<Named> settings_for(const Case& which)
{
    const Scene& scene = which.scenes[0];
    if (which.id == "a") return {{"implicit", {10, false, false, false, false}}, {"explicit", {10, false, false, true, false}}};
    if (which.id[0] == 'i') return {{"spring2", {}}, {"spring2 limited", {10, false, false, false, true}}};
    if (scene.restitution > 0)
        return {{"si10", {}}, {"si10 erp0_cpt0", {10, false, true, false, false}}, {"si50 erp0_cpt0", {50, false, true, false, false}}};
    std::vector<Named> out{{"si10", {}}, {"si50", {50, false, false, false, false}}};
    if (scene.bodies.size() <= 100) out.push_back({"mlcp", {10, true, false, false, false}});
    return out;
}

}  // namespace

std::vector<Run> bullet_runs(const Case& which, std::vector<std::string>&)
{
    std::vector<Run> runs;
    for (const Named& offered : settings_for(which))
        for (const Step& step : which.ladder)
        {
            const auto make = [settings = offered.settings, step](const Scene& scene)
            { return Result<std::unique_ptr<Engine>>(std::make_unique<BulletEngine>(scene, step.seconds(), settings)); };
            runs.push_back({"bullet", offered.name, step, "", make});
        }
    return runs;
}

}  // namespace plab::peers
