/// Component types for tests of the blueprint language: roles, fields, rules and commands like those of the real types, but
/// without plugins and without implementations of the commands.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "model/names.h"
#include "model/type_registry.h"

namespace plab::test
{

struct SampleBody
{
    Column<Vec3> position, linear_velocity, angular_velocity;
    Column<Quat> orientation;
    Column<double> mass, density;
    Column<Mat3> inertia;
    Column<std::string> material;
    Column<Ref> shape, solver;
    Column<double> kinetic_energy;

    void describe(Schema& s)
    {
        s.state(position, "position", unit::metre, "origin of the body's frame").hosted();
        s.state(orientation, "orientation", unit::one, "turns the body's axes into the world's").hosted();
        s.state(linear_velocity, "linear_velocity", unit::metre_per_second, "of the origin").hosted();
        s.state(angular_velocity, "angular_velocity", unit::radian_per_second, "in the world").hosted();
        s.param(mass, "mass", unit::kilogram, "mass").or_else(1).positive();
        s.param(density, "density", unit::kilogram_per_metre3, "of the shapes").or_else(0);
        s.param(inertia, "inertia", unit::kilogram_metre2, "about the centre").or_else(Mat3::identity());
        s.param(material, "material", unit::one, "name of the material").or_else("");
        s.output(kinetic_energy, "kinetic_energy", unit::joule, "of the body");
        s.role(shape, "shape", {Facet::Shape}, "its shape").optional();
        s.role(solver, "solver", {Facet::Component}, "the solver that advances it").family("Solver/").optional();
    }
};

struct SampleStatic
{
    Column<Vec3> position;
    Column<Quat> orientation;
    Column<Ref> shape;

    void describe(Schema& s)
    {
        s.state(position, "position", unit::metre, "origin of the body's frame").hosted();
        s.state(orientation, "orientation", unit::one, "turns the body's axes into the world's").hosted();
        s.role(shape, "shape", {Facet::Shape}, "its shape").optional();
    }
};

struct SampleShaft
{
    Column<double> angle, angular_velocity, inertia;
    Column<Vec3> position, axis;
    Column<bool> prescribed;
    Column<Ref> solver;

    void describe(Schema& s)
    {
        s.state(angle, "angle", unit::radian, "turned").hosted();
        s.state(angular_velocity, "angular_velocity", unit::radian_per_second, "about the axis").hosted();
        s.param(inertia, "inertia", unit::kilogram_metre2, "about the axle").positive();
        s.param(position, "position", unit::metre, "a point of the axle").or_else({});
        s.param(axis, "axis", unit::one, "direction of the axle").or_else({0, 0, 1}).unit_length();
        s.param(prescribed, "prescribed", unit::one, "its motion is prescribed").or_else(false);
        s.role(solver, "solver", {Facet::Component}, "the solver that advances it").family("Solver/").optional();
    }
};

struct SampleSphere
{
    Column<double> radius;
    void describe(Schema& s) { s.param(radius, "radius", unit::metre, "radius").positive(); }
};

struct SampleMesh
{
    Column<Reals> vertices;
    Column<Integers> triangles;
    Column<bool> hull_collides;

    void describe(Schema& s)
    {
        s.param(vertices, "vertices", unit::metre, "x y z of each vertex");
        s.param(triangles, "triangles", unit::one, "three vertex numbers per triangle");
        s.param(hull_collides, "hull_collides", unit::one, "collides as its convex hull").or_else(true);
    }
};

struct SampleSolver
{
    Column<std::int64_t> substeps;
    void describe(Schema& s) { s.param(substeps, "substeps", unit::one, "per step").or_else(1).at_least(1).at_most(100); }
};

struct SampleDetection
{
    Column<RefList> between, against;
    Column<Ref> resolution, response;
    Column<std::string> space;

    void describe(Schema& s)
    {
        s.role(between, "between", {Facet::Body}, "bodies that meet each other").at_least(1);
        s.role(against, "against", {Facet::Body}, "bodies that the others meet").optional();
        s.role(resolution, "resolution", {Facet::Component}, "finds the time").family("Resolution/").default_type("Resolution/Bisection");
        s.role(response, "response", {Facet::Component}, "pushes apart").family("Response/").default_type("Response/Impulse");
        s.param(space, "space", unit::one, "broad phase").or_else("hash").one_of({"simple", "hash", "sweep"});
    }
};

struct SampleResolution
{
    Column<double> tolerance;
    void describe(Schema& s) { s.param(tolerance, "tolerance", unit::metre, "overlap that is left").or_else(1e-9).positive(); }
};

struct SampleResponse
{
    Column<double> friction, restitution;
    void describe(Schema& s)
    {
        s.param(friction, "friction", unit::one, "Coulomb's coefficient").or_else(0).not_negative().may_be_infinite();
        s.param(restitution, "restitution", unit::one, "Newton's coefficient").or_else(1).at_least(0).at_most(1);
    }
};

struct SampleField
{
    Column<RefList> between;
    Column<Vec3> acceleration;
    void describe(Schema& s)
    {
        s.role(between, "between", {Facet::Body}, "bodies that have weight").writes().independent();
        s.param(acceleration, "acceleration", unit::metre_per_second2, "of free fall").or_else({0, 0, -9.81});
    }
};

struct SampleGear
{
    Column<Ref> driver, driven;
    Column<double> velocity_factor, torque;
    void describe(Schema& s)
    {
        s.role(driver, "driver", {Facet::Shaft}, "turns the other");
        s.role(driven, "driven", {Facet::Shaft}, "is turned").writes();
        s.param(velocity_factor, "velocity_factor", unit::one, "turns of driven per turn of driver").nonzero();
        s.output(torque, "torque", unit::newton_metre, "on driven");
    }
};

struct SampleScript
{
    Column<std::string> code;
    Column<Entries> state;
    Column<RefList> driver, driven;
    void describe(Schema& s)
    {
        s.param(code, "code", unit::one, "Lua text");
        s.state(state, "state", unit::one, "values that live across steps");
        s.role(driver, "driver", {Facet::Body, Facet::Shaft}, "the object that it reads").optional();
        s.role(driven, "driven", {Facet::Body, Facet::Shaft}, "the object that it moves").optional().writes();
    }
};

inline void register_sample_objects(Registrar& r)
{
    const auto restore = [](auto&& type) { type.host_command(Phase::Restore, "State/Restore", "back to the saved state"); };
    const auto shape = [](auto&& type)
    {
        type.facet(Facet::Shape)
            .family("Shape")
            .host_command(Phase::Prepare, "Shape/Prepare", "hands over")
            .host_command(Phase::Measure, "Shape/VolumeIntegration", "mass properties")
            .host_command(Phase::Draw, "Shape/Draw", "shows it");
    };
    const auto solver = [](auto&& type)
    { type.host_command(Phase::Advance, "Solver/Advance", "advances its group").order(4).cost("4 force evaluations"); };
    restore(r.component<SampleStatic>("State/Static", "never moves").facet(Facet::Body).family("State/Body"));
    restore(r.component<SampleBody>("State/RigidBody", "moves by forces").facet(Facet::Body).family("State/Body"));
    restore(r.component<SampleShaft>("State/Shaft", "turns about an axle").facet(Facet::Shaft).family("State/Shaft"));
    shape(r.component<SampleSphere>("Shape/Sphere", "a ball"));
    shape(r.component<SampleMesh>("Shape/Mesh", "triangles"));
    solver(r.component<SampleSolver>("Solver/RungeKutta4", "order 4"));
    solver(r.component<SampleSolver>("Solver/SemiImplicitEuler", "order 1"));
    solver(r.component<SampleSolver>("Solver/Automatic", "chooses"));
}

inline void register_sample_interactions(Registrar& r)
{
    r.component<SampleDetection>("CDetection/ODE", "finds contacts")
        .host_command(Phase::Prepare, "CDetection/Add", "adds the bodies to the library")
        .host_command(Phase::Advance, "CDetection/Update", "moves the bodies in the library")
        .host_command(Phase::Detect, "CDetection/Handle", "finds contacts");
    for (const char* name : {"Resolution/Bisection", "Resolution/LocalBisection", "Resolution/None"})
        r.component<SampleResolution>(name, "finds the time of an event")
            .host_command(Phase::Locate, "Resolution/Locate", "next time to try");
    for (const char* name : {"Response/Impulse", "Response/None"})
        r.component<SampleResponse>(name, "answers contacts").host_command(Phase::Respond, "Response/Respond", "applies impulses");
    r.component<SampleField>("Field/Gravity", "weight").family("Field/Gravity").host_command(Phase::Force, "Field/Apply", "adds m g");
    for (const char* name : {"Constraint/AngularVelocity/Graph", "Constraint/AngularVelocity/Impulse"})
        r.component<SampleGear>(name, "keeps a ratio of speeds")
            .host_command(Phase::Connect, "Constraint/Connect", "enters the graph")
            .host_command(Phase::Couple, "Constraint/AngularVelocity", "relates the speeds");
    r.component<SampleScript>("Script/Lua", "runs a script")
        .host_command(Phase::Drive, "Script/Drive", "drive(step)")
        .host_command(Phase::Force, "Script/Force", "force(t, state)");
}

/// All sample types; they are always loaded.
class SampleTypes final : public model::TypeSource
{
public:
    SampleTypes()
    {
        Registrar registrar;
        register_sample_objects(registrar);
        register_sample_interactions(registrar);
        added_ = registry_.add(std::move(registrar), "sample");
    }

    Result<const model::ComponentType*> require(const std::string& name) override
    {
        if (!added_) return added_.errors();
        if (const model::ComponentType* type = registry_.find(name)) return type;
        return reason("unknown type '" + name + "'" + model::did_you_mean(name, names()));
    }
    std::vector<std::string> names() const override
    {
        std::vector<std::string> out;
        for (const model::ComponentType& type : registry_.types()) out.push_back(type.info.name);
        std::sort(out.begin(), out.end());
        return out;
    }

private:
    model::TypeRegistry registry_;
    Result<void> added_;
};

}  // namespace plab::test
