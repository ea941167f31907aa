#include <doctest/doctest.h>

#include "blueprint/reader.h"

using namespace plab;

namespace
{

/// A component with a mesh of this content, read; the mesh begins in line 2, column 1, its content in line 3.
Result<model::Blueprint> mesh(const std::string& content)
{
    return blueprint::read_blueprint("<component id='m'>\n<MESH>\n" + content + "</MESH></component>", "m.xml");
}

std::string mesh_refusal(const std::string& content)
{
    const auto result = mesh(content);
    return result.ok() ? "accepted" : result.error().text();
}

const std::string kPoints = "<P ID='1'>0, 0, 0</P><P ID='2'>1, 0, 0</P><P ID='3'>0, 1, 0</P><P ID='4'>0, 0, 1</P>\n";

std::string face(const std::string& a, const std::string& b, const std::string& c)
{
    return "<F><FV1><PREF>" + a + "</PREF></FV1><FV2><PREF>" + b + "</PREF></FV2><FV3><PREF>" + c + "</PREF></FV3></F>\n";
}

const std::string kTetrahedron = kPoints + face("1", "3", "2") + face("1", "2", "4") + face("2", "3", "4") + face("1", "4", "3");

}  // namespace

TEST_CASE("a tetrahedron: points in file order, triangles counted from 0")
{
    const auto result = mesh(kTetrahedron);
    REQUIRE(result.ok());
    const auto& component = result->components.at(0);
    CHECK(component.type == "Shape/Mesh");
    REQUIRE(component.values.size() == 2);
    CHECK(component.values[0].name == "vertices");
    CHECK(component.values[0].value == Value(Reals{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
    CHECK(component.values[0].where.line == 2);
    CHECK(component.values[1].name == "triangles");
    CHECK(component.values[1].value == Value(Integers{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
}

TEST_CASE("order of elements, names of points and appearance do not matter")
{
    const auto result = mesh(
        "<MAT ID='0'><AMB>.1,.1,.1</AMB></MAT><SURFACE/><EXT_tool>x</EXT_tool><N ID='7'>0,0,1</N><TC ID='7'>0,0</TC>"
        "<PATCH><F><MATREF>0</MATREF><FV3><PREF> c </PREF></FV3><FV1><PREF>a</PREF><NREF>7</NREF><TCREF>7</TCREF></FV1>"
        "<FV2><PREF>b</PREF></FV2></F></PATCH><P ID='c'>-1e-3 ,+.5,2</P><P ID='a'>0,0,0</P><P ID='b'>1,0,0</P>");
    REQUIRE_MESSAGE(result.ok(), (result.ok() ? "" : result.error().text()));
    CHECK(result->components[0].values[0].value == Value(Reals{-1e-3, .5, 2, 0, 0, 0, 1, 0, 0}));
    CHECK(result->components[0].values[1].value == Value(Integers{1, 2, 0}));
}

TEST_CASE("bad meshes")
{
    CHECK(mesh_refusal("") == "m.xml:2:1: <MESH>: a mesh needs at least one face <F>");
    CHECK(mesh_refusal(kPoints + face("1", "2", "9")) == "m.xml:4:59: <PREF>: no point <P> has the ID '9'");
    CHECK(mesh_refusal(kPoints + "<P ID='2'>0,0,0</P>" + face("1", "2", "3")) == "m.xml:4:1: <P>: ID '2' is already defined");
    CHECK(mesh_refusal("<P>0,0,0</P>" + kTetrahedron) == "m.xml:3:1: <P>: needs an attribute 'ID'");
    CHECK(mesh_refusal(kPoints + "<F><FV1><PREF>1</PREF></FV1><FV2><PREF>2</PREF></FV2></F>") ==
          "m.xml:4:1: <F>: a face needs three corners, <FV1> to <FV3>");
    CHECK(mesh_refusal(kPoints + "<F><FV1><PREF>1</PREF></FV1><FV4/></F>") ==
          "m.xml:4:29: <FV4>: a face has three corners, <FV1> to <FV3>; split it into triangles");
    CHECK(mesh_refusal(kPoints + "<F><FV1/><FV1/></F>") == "m.xml:4:10: <FV1>: the face already has this corner");
    CHECK(mesh_refusal(kPoints + "<F><FV1/><FV2/><FV3/></F>") == "m.xml:4:4: <FV1>: a corner needs a <PREF>");
    CHECK(mesh_refusal(kPoints + face("1", "2", "1")) == "m.xml:4:1: <F>: a face needs three different points");
    CHECK(mesh_refusal(kPoints + "<FACE/>") == "m.xml:4:1: <FACE>: unknown element in <MESH>");
    CHECK(mesh_refusal(kTetrahedron + "words") == "m.xml:8:1: <MESH>: unexpected text");
}

TEST_CASE("bad coordinates")
{
    for (const std::string text :
         {"", "1", "1,2", "1,2,3,4", "1 2 3", "1,2,x", "1,2,", "nan,0,0", "0,inf,0", "1e999,0,0", "1;2;3", "0x1,0,0"})
    {
        CAPTURE(text);
        CHECK(mesh_refusal("<P ID='1'>" + text + "</P>" + face("1", "1", "1")) ==
              "m.xml:3:1: <P>: '" + text + "' is not a point: give three numbers separated by commas");
    }
}

TEST_CASE("a bad point is reported once, not at each face")
{
    const auto result = mesh("<P ID='1'>0 0 0</P><P ID='2'>1,0,0</P><P ID='3'>0,1,0</P>" + face("1", "2", "3") + face("3", "2", "1"));
    REQUIRE(!result.ok());
    CHECK(result.errors().size() == 1);
}

TEST_CASE("a second mesh in a component is refused")
{
    const auto result = blueprint::read_blueprint(
        "<component id='m'>\n<MESH>" + kTetrahedron + "</MESH>\n<MESH>" + kTetrahedron + "</MESH></component>", "m.xml");
    REQUIRE(!result.ok());
    CHECK(result.error().text() == "m.xml:8:1: <MESH>: the component has its vertices already");
}

TEST_CASE("written meshes read back to the same bits")
{
    const Reals vertices{0.1, -0.0, 1e-300, 1.0 / 3, 12345678.901234567, -2e17, 5, 6, 7, 8, 9, 10};
    const Integers triangles{0, 1, 2, 3, 2, 1};
    REQUIRE(blueprint::is_xgl_mesh(vertices, triangles));
    const auto back =
        blueprint::read_blueprint("<component id='m'>" + blueprint::write_xgl_mesh(vertices, triangles, 2) + "</component>", "m.xml");
    REQUIRE(back.ok());
    CHECK(back->components[0].values[0].value == Value(vertices));
    CHECK(std::signbit(std::get<Reals>(back->components[0].values[0].value)[1]));
    CHECK(back->components[0].values[1].value == Value(triangles));
}

TEST_CASE("lists that are not a mesh are recognised")
{
    const Reals points{0, 0, 0, 1, 0, 0, 0, 1, 0};
    CHECK(blueprint::is_xgl_mesh(points, {0, 1, 2}));
    CHECK(!blueprint::is_xgl_mesh(points, {}));
    CHECK(!blueprint::is_xgl_mesh(points, {0, 1}));
    CHECK(!blueprint::is_xgl_mesh(points, {0, 1, 3}));
    CHECK(!blueprint::is_xgl_mesh(points, {0, 1, -1}));
    CHECK(!blueprint::is_xgl_mesh(points, {0, 1, 1}));
    CHECK(!blueprint::is_xgl_mesh({0, 0, 0, 1}, {0, 1, 2}));
    CHECK(!blueprint::is_xgl_mesh({0, 0, INFINITY, 1, 0, 0, 0, 1, 0}, {0, 1, 2}));
}
