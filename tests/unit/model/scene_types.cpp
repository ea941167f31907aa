#include "scene_types.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "model/names.h"

namespace plab::test
{

namespace
{

struct BodyRows
{
    Column<double> mass, energy;
    Column<Vec3> position, velocity;
    Column<Quat> orientation;
    Column<Ref> shape, solver;

    void describe(Schema& s)
    {
        s.param(mass, "mass", unit::kilogram, "mass of the body").positive();
        s.state(position, "position", unit::metre, "of B in W").hosted();
        s.state(orientation, "orientation", unit::one, "of B in W").hosted();
        s.state(velocity, "linear_velocity", unit::metre_per_second, "of B in W").hosted();
        s.output(energy, "energy", unit::joule, "kinetic");
        s.role(shape, "shape", {Facet::Shape}, "its form").optional();
        s.role(solver, "solver", {Facet::Component}, "advances it").family("Solver/");
    }
};

struct ShaftRows
{
    Column<double> inertia, angle;
    Column<Vec3> axis;
    Column<Ref> solver;

    void describe(Schema& s)
    {
        s.param(inertia, "inertia", unit::kilogram_metre2, "about the axle").or_else(1).positive();
        s.param(axis, "axis", unit::one, "of the axle in W").or_else({0, 0, 1}).unit_length();
        s.state(angle, "angle", unit::radian, "about the axle").hosted();
        s.role(solver, "solver", {Facet::Component}, "advances it").family("Solver/");
    }
};

struct SphereRows
{
    Column<double> radius;
    Column<Vec3> position;

    void describe(Schema& s)
    {
        s.param(radius, "radius", unit::metre, "of the sphere").or_else(0.5).positive();
        s.param(position, "position", unit::metre, "in its body").or_else({});
    }
};

struct MeshRows
{
    Column<Reals> vertices;
    Column<Integers> triangles;

    void describe(Schema& s)
    {
        s.param(vertices, "vertices", unit::metre, "three numbers each");
        s.param(triangles, "triangles", unit::one, "three indices each");
    }
};

struct PlacedRows
{
    Column<Ref> of;
    void describe(Schema& s) { s.role(of, "of", {Facet::Shape}, "placed once more"); }
};

struct SolverRows
{
    Column<std::int64_t> substeps;
    void describe(Schema& s) { s.param(substeps, "substeps", unit::one, "per step").or_else(1).positive(); }
};

struct CouplingRows
{
    Column<Ref> driver, driven;
    Column<double> velocity_factor;
    Column<std::string> mesh;

    void describe(Schema& s)
    {
        s.role(driver, "driver", {Facet::Shaft}, "turns the other").writes();
        s.role(driven, "driven", {Facet::Shaft}, "is turned").writes().exclusive();
        s.param(velocity_factor, "velocity_factor", unit::one, "turns of driven per turn of driver").or_else(1).nonzero();
        s.param(mesh, "mesh", unit::one, "of teeth").or_else("external").one_of({"external", "internal", "belt"});
    }
};

struct DetectionRows
{
    Column<RefList> between;
    Column<Ref> resolution, response;

    void describe(Schema& s)
    {
        s.role(between, "between", {Facet::Body}, "collide").at_least(2);
        s.role(resolution, "resolution", {Facet::Component}, "locates").family("Resolution/").default_type("Resolution/Bisection");
        s.role(response, "response", {Facet::Component}, "answers").family("Response/").default_type("Response/Impulse");
    }
};

struct ResponseRows
{
    Column<double> restitution, limit;

    void describe(Schema& s)
    {
        s.param(restitution, "restitution", unit::one, "Newton's coefficient").or_else(1).not_negative().at_most(1);
        s.param(limit, "limit", unit::newton_second, "of an impulse").or_else(std::numeric_limits<double>::infinity()).may_be_infinite();
    }
};

struct ResolutionRows
{
    Column<double> tolerance;
    void describe(Schema& s) { s.param(tolerance, "tolerance", unit::second, "of the time").or_else(1e-9).positive(); }
};

struct ScriptRows
{
    Column<std::string> code;
    Column<Entries> state;
    Column<Ref> target;

    void describe(Schema& s)
    {
        s.param(code, "code", unit::one, "the text to run");
        s.state(state, "state", unit::one, "lives across steps");
        s.role(target, "target", {Facet::Body, Facet::Shaft}, "is pushed").optional().writes();
    }
};

struct ManagerRows
{
    Column<RefList> parts;
    void describe(Schema& s) { s.role(parts, "parts", {Facet::Component}, "whatever").optional(); }
};

void register_objects(Registrar& r)
{
    r.component<BodyRows>("State/RigidBody", "a body").facet(Facet::Body).host_command(Phase::Restore, "State/Restore", "");
    r.component<ShaftRows>("State/Shaft", "a shaft").facet(Facet::Shaft).host_command(Phase::Restore, "State/Restore", "");
    r.component<SphereRows>("Shape/Sphere", "a sphere")
        .facet(Facet::Shape)
        .host_command(Phase::Prepare, "Shape/Prepare", "")
        .host_command(Phase::Measure, "Shape/VolumeIntegration", "")
        .host_command(Phase::Draw, "Shape/Draw", "");
    r.component<MeshRows>("Shape/Mesh", "triangles").facet(Facet::Shape).host_command(Phase::Draw, "Shape/Draw", "");
    r.component<PlacedRows>("Shape/Placed", "a shape once more").facet(Facet::Shape);
    r.component<SolverRows>("Solver/Automatic", "").host_command(Phase::Advance, "Solver/Advance", "");
    r.component<SolverRows>("Solver/RungeKutta4", "").host_command(Phase::Advance, "Solver/Advance", "");
    r.component<SolverRows>("Solver/SemiImplicitEuler", "").host_command(Phase::Advance, "Solver/Advance", "");
}

void register_interactions(Registrar& r)
{
    for (const char* name : {"Constraint/AngularVelocity/Graph", "Constraint/AngularVelocity/Assign"})
        r.component<CouplingRows>(name, "")
            .host_command(Phase::Prepare, "Constraint/Prepare", "")
            .host_command(Phase::Couple, "Constraint/AngularVelocity", "")
            .host_command(Phase::Finish, "Constraint/Finish", "");
    r.component<DetectionRows>("CDetection/Simple", "")
        .host_command(Phase::Prepare, "CDetection/Prepare", "")
        .host_command(Phase::Detect, "CDetection/Handle", "");
    r.component<ResolutionRows>("Resolution/Bisection", "").host_command(Phase::Locate, "Resolution/Locate", "");
    r.component<ResponseRows>("Response/Impulse", "").host_command(Phase::Respond, "Response/Respond", "");
    r.component<ScriptRows>("Script/Lua", "")
        .host_command(Phase::Prepare, "Script/Prepare", "")
        .host_command(Phase::Drive, "Script/Lua/Drive", "")
        .host_command(Phase::Force, "Script/Lua/Force", "");
    r.component<ManagerRows>("Manager/Any", "");
}

}  // namespace

FixedTypes::FixedTypes()
{
    Registrar r;
    register_objects(r);
    register_interactions(r);
    const Result<void> added = registry_.add(std::move(r), "test");
    REQUIRE_MESSAGE(added.ok(), (added ? "" : added.error().text()));
}

Result<const model::ComponentType*> FixedTypes::require(const std::string& name)
{
    asked.push_back(name);
    if (const model::ComponentType* type = registry_.find(name)) return type;
    return reason("unknown type '" + name + "'" + model::did_you_mean(name, names()));
}

std::vector<std::string> FixedTypes::names() const
{
    std::vector<std::string> out;
    for (const model::ComponentType& t : registry_.types()) out.push_back(t.info.name);
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace plab::test
