/// The paper's listings, completed in scenes/paper: what they must contain once they are read.
#include <doctest/doctest.h>

#include "blueprint/reader.h"
#include "blueprint/writer.h"
#include "model/compile.h"
#include "support/sample_types.h"

using namespace plab;
using Names = std::vector<std::string>;

namespace
{

struct Listing
{
    test::SampleTypes types;
    model::SceneSpec scene;

    explicit Listing(int figure)
    {
        const auto blueprint = blueprint::read_blueprint_file(PLAB_SOURCE_DIR "/scenes/paper/listing-" + std::to_string(figure) + ".xml");
        REQUIRE_MESSAGE(blueprint.ok(), (blueprint.ok() ? "" : blueprint.error().text()));
        auto compiled = model::compile(*blueprint, types);
        REQUIRE_MESSAGE(compiled.ok(), (compiled.ok() ? "" : compiled.error().text()));
        scene = compiled.take();
    }
    const model::ComponentSpec& component(const std::string& id) const
    {
        const model::ComponentSpec* found = scene.find(id);
        REQUIRE_MESSAGE(found, id);
        return *found;
    }
    Names members(const std::string& id, const std::string& role) const
    {
        for (const model::RoleSpec& r : component(id).roles)
            if (r.name == role) return r.members;
        return {};
    }
    Value field(const std::string& id, const std::string& name) const
    {
        for (const model::FieldSpec& f : component(id).fields)
            if (f.name == name) return f.value;
        return {};
    }
};

}  // namespace

TEST_CASE("figure 2: an object that shares a mesh and selects its commands")
{
    const Listing l(2);
    CHECK(l.component("00").type == "Shape/Mesh");
    CHECK(std::get<Reals>(l.field("00", "vertices")).size() == 24);
    CHECK(std::get<Integers>(l.field("00", "triangles")).size() == 36);
    CHECK(l.component("02").alias_of == "00");
    CHECK(l.component("02").parent == "01");
    CHECK(l.members("03", "shape") == Names{"00"});
    CHECK(l.members("03", "solver") == Names{"04"});
    CHECK(l.component("03").explicit_commands);
    CHECK(l.component("03").commands == Names{"State/Restore"});
    CHECK(l.component("04").commands == Names{"Solver/Advance"});
    CHECK(l.component("00").commands == Names{"Shape/VolumeIntegration", "Shape/Draw"});
}

TEST_CASE("figure 2: each edge of the mesh is used once in each direction, and it holds 0.008 m^3")
{
    const Listing l(2);
    const auto vertices = std::get<Reals>(l.field("00", "vertices"));
    const auto triangles = std::get<Integers>(l.field("00", "triangles"));
    std::vector<std::pair<std::int64_t, std::int64_t>> edges;
    double six_volumes = 0;
    for (std::size_t f = 0; f < triangles.size(); f += 3)
    {
        Vec3 p[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            edges.emplace_back(triangles[f + k], triangles[f + (k + 1) % 3]);
            const auto at = static_cast<std::size_t>(triangles[f + k]) * 3;
            p[k] = {vertices[at], vertices[at + 1], vertices[at + 2]};
        }
        six_volumes += dot(p[0], cross(p[1], p[2]));
    }
    CHECK(six_volumes / 6 == doctest::Approx(0.008).epsilon(1e-14));
    std::sort(edges.begin(), edges.end());
    CHECK(std::adjacent_find(edges.begin(), edges.end()) == edges.end());
    for (const auto& [a, b] : edges) CHECK(std::binary_search(edges.begin(), edges.end(), std::pair(b, a)));
}

TEST_CASE("figure 4: the interaction names the bodies, and which commands of the library run when")
{
    const Listing l(4);
    CHECK(l.members("10", "between") == Names{"31", "32", "33"});
    CHECK(l.members("10", "resolution") == Names{"10.resolution"});
    CHECK(l.component("10.resolution").type == "Resolution/LocalBisection");
    CHECK(l.field("10.response", "restitution") == Value(1.0));
    CHECK(l.component("10").explicit_commands);
    CHECK(l.component("10").commands == Names{"CDetection/Add", "CDetection/Update", "CDetection/Handle"});
    CHECK(!l.component("10.response").explicit_commands);
}

TEST_CASE("figure 6: parameters behind the command; a command stands for its subject's state")
{
    const Listing l(6);
    CHECK(l.members("52", "driver") == Names{"101"});
    CHECK(l.members("52", "driven") == Names{"201"});
    CHECK(l.field("52", "velocity_factor") == Value(-0.5));
    CHECK(l.component("52").commands == Names{"Constraint/AngularVelocity"});
}

TEST_CASE("figure 7: a command that is a script")
{
    const Listing l(7);
    CHECK(l.component("300").type == "Script/Lua");
    CHECK(l.component("300").name == "Hello");
    CHECK(l.field("300", "code") == Value(std::string("function drive(step) emit(\"hello\", \"Hello pLab!\") end")));
    CHECK(l.component("300").commands == Names{"Script/Drive"});
}

TEST_CASE("the long forms of the listings load again")
{
    for (const int figure : {2, 4, 6, 7})
    {
        CAPTURE(figure);
        Listing l(figure);
        const std::string text = blueprint::write_long_form(l.scene, l.types);
        const auto blueprint = blueprint::read_blueprint(text, "long.xml");
        REQUIRE(blueprint.ok());
        const auto again = model::compile(*blueprint, l.types);
        REQUIRE_MESSAGE(again.ok(), (again.ok() ? "" : again.error().text()));
        CHECK(again->components.size() == l.scene.components.size());
        CHECK(blueprint::write_long_form(*again, l.types) == text);
    }
}
