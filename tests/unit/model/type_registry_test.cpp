/// What the registry refuses, and which types can stand in for one another.
#include <doctest/doctest.h>

#include "model/type_registry.h"

using namespace plab;
using model::TypeRegistry;

namespace
{

struct Good
{
    Column<double> mass;
    Column<Ref> driver;
    void describe(Schema& s)
    {
        s.param(mass, "mass", unit::kilogram, "").or_else(1).positive();
        s.role(driver, "driver", {Facet::Shaft}, "");
    }
};

/// The errors of registering Table under `name`.
template <class Table>
std::string refusal(const std::string& name)
{
    TypeRegistry registry;
    Registrar registrar;
    registrar.component<Table>(name, "");
    const Result<void> added = registry.add(std::move(registrar), "sample");
    CHECK(registry.types().empty() == !added.ok());
    return added ? std::string() : added.error().text();
}

}  // namespace

TEST_CASE("a type is found by name, with its schema and commands")
{
    TypeRegistry registry;
    Registrar registrar;
    registrar.component<Good>("Kind/Good", "").host_command(Phase::Finish, "Kind/Finish", "");
    REQUIRE(registry.add(std::move(registrar), "sample").ok());
    const model::ComponentType* type = registry.find("Kind/Good");
    REQUIRE(type);
    CHECK(type->plugin == "sample");
    CHECK(type->schema.find_field("mass"));
    CHECK(type->find_command("Kind/Finish") == 0);
    CHECK(type->find_command("Kind/Begin") == -1);
    CHECK(type->takes_part(Phase::Finish));
    CHECK_FALSE(type->takes_part(Phase::Force));
    CHECK_FALSE(registry.find("Kind/Goo"));
}

TEST_CASE("a type with a known name is refused, and no type of its plugin is registered")
{
    TypeRegistry registry;
    Registrar first, second;
    first.component<Good>("Kind/Good", "");
    second.component<Good>("Kind/New", "");
    second.component<Good>("Kind/Good", "");
    REQUIRE(registry.add(std::move(first), "one").ok());
    const Result<void> added = registry.add(std::move(second), "two");
    REQUIRE_FALSE(added.ok());
    CHECK(added.error().text() == "plugin two: Kind/Good: is already declared by plugin 'one'");
    CHECK_FALSE(registry.find("Kind/New"));
}

TEST_CASE("type names")
{
    CHECK(refusal<Good>("Kind/Good").empty());
    CHECK(refusal<Good>("Kind/Family/Good4").empty());
    for (const char* name : {"Good", "kind/Good", "Kind/", "Kind//Good", "A/B/C/D", "Kind/Go od", "/Kind"})
    {
        CAPTURE(name);
        CHECK(refusal<Good>(name).find("type names must have the form Kind/Algorithm or Kind/Family/Algorithm") != std::string::npos);
    }
}

namespace
{

struct BadName
{
    Column<double> mass;
    void describe(Schema& s) { s.param(mass, "bodyMass", unit::kilogram, ""); }
};
struct Reserved
{
    Column<double> mass;
    void describe(Schema& s) { s.param(mass, "type", unit::kilogram, ""); }
};
struct Twice
{
    Column<double> mass;
    Column<Ref> role;
    void describe(Schema& s)
    {
        s.param(mass, "mass", unit::kilogram, "");
        s.role(role, "mass", {Facet::Body}, "");
    }
};
struct BadDefault
{
    Column<double> mass;
    void describe(Schema& s) { s.param(mass, "mass", unit::kilogram, "").or_else(0).positive(); }
};
struct LongDirection
{
    Column<Vec3> axis;
    void describe(Schema& s) { s.param(axis, "axis", unit::one, "").or_else({1, 1, 0}).unit_length(); }
};
struct NoFacet
{
    Column<Ref> role;
    void describe(Schema& s) { s.role(role, "role", {}, ""); }
};
struct WrongDefaultType
{
    Column<Ref> role;
    void describe(Schema& s) { s.role(role, "role", {Facet::Component}, "").family("Response/").default_type("Solver/Euler"); }
};
struct SilentExclusive
{
    Column<Ref> role;
    void describe(Schema& s) { s.role(role, "role", {Facet::Body}, "").exclusive(); }
};

}  // namespace

TEST_CASE("declarations that contradict themselves")
{
    CHECK(refusal<BadName>("A/B") == "plugin sample: A/B: 'bodyMass' must be in snake_case");
    CHECK(refusal<Reserved>("A/B") == "plugin sample: A/B: 'type' is already an attribute of every component");
    CHECK(refusal<Twice>("A/B") == "plugin sample: A/B: 'mass' is declared twice");
    CHECK(refusal<BadDefault>("A/B") == "plugin sample: A/B: the default breaks its own rule: mass must be positive, not 0");
    CHECK(refusal<LongDirection>("A/B") == "plugin sample: A/B: the default of axis must be of unit length");
    CHECK(refusal<NoFacet>("A/B") == "plugin sample: A/B: role role accepts no component: it names no facet");
    CHECK(refusal<WrongDefaultType>("A/B") == "plugin sample: A/B: role role has a default type outside its family Response/");
    CHECK(refusal<SilentExclusive>("A/B") == "plugin sample: A/B: role role is exclusive, so it must be declared as writing");
}

TEST_CASE("a command is declared once")
{
    TypeRegistry registry;
    Registrar registrar;
    registrar.component<Good>("A/B", "").host_command(Phase::Finish, "A/X", "").host_command(Phase::Draw, "A/X", "");
    CHECK(registry.add(std::move(registrar), "sample").error().reason == "command 'A/X' is declared twice");
}

namespace
{

struct OneRole
{
    Column<Ref> driver;
    void describe(Schema& s) { s.role(driver, "driver", {Facet::Shaft}, ""); }
};
struct ManyRole
{
    Column<RefList> driver;
    void describe(Schema& s) { s.role(driver, "driver", {Facet::Shaft}, ""); }
};
struct BodyRole
{
    Column<Ref> driver;
    void describe(Schema& s) { s.role(driver, "driver", {Facet::Body}, ""); }
};
struct TwoRoles
{
    Column<Ref> driver, driven;
    void describe(Schema& s)
    {
        s.role(driver, "driver", {Facet::Shaft}, "");
        s.role(driven, "driven", {Facet::Shaft}, "");
    }
};

}  // namespace

TEST_CASE("differences that prevent types from replacing one another")
{
    TypeRegistry registry;
    Registrar r;
    r.component<OneRole>("K/F/One", "");
    r.component<OneRole>("K/F/Same", "");
    r.component<OneRole>("K/G/Other", "");
    r.component<OneRole>("K/F/Body", "").facet(Facet::Body);
    r.component<ManyRole>("K/F/Many", "");
    r.component<BodyRole>("K/F/Kind", "");
    r.component<TwoRoles>("K/F/Two", "");
    REQUIRE(registry.add(std::move(r), "sample").ok());
    const auto why = [&](const char* other) { return registry.find("K/F/One")->why_not_exchangeable(*registry.find(other)); };
    CHECK(why("K/F/One").empty());
    CHECK(why("K/F/Same").empty());
    CHECK(why("K/G/Other") == "K/F/One is of family K/F, K/G/Other of family K/G");
    CHECK(why("K/F/Body") == "K/F/One is a component, K/F/Body is a body");
    CHECK(why("K/F/Many") == "role driver takes one participant in one type and many in the other");
    CHECK(why("K/F/Kind") == "role driver takes different kinds of participants");
    CHECK(why("K/F/Two") == "K/F/One has the roles 'driver', K/F/Two has 'driver' and 'driven'");
}
