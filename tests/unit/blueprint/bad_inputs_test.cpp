/// The table of bad inputs: bad_inputs.txt holds blueprints and, after each, all errors that reading and compiling it must report,
/// word for word.
#include <doctest/doctest.h>

#include <fstream>
#include <vector>

#include "blueprint/reader.h"
#include "model/compile.h"
#include "support/sample_types.h"

using namespace plab;

namespace
{

struct BadInput
{
    int line = 0;  ///< in the table
    std::string text;
    std::string errors;  ///< one per line
};

/// Cases are separated by empty lines. Lines that begin with "-> " are the errors, those with "# " are comments; a case
/// that begins with "whole document:" is one, others are put into a <plab>, in whose second line they begin.
std::vector<BadInput> read_table(const std::string& path)
{
    std::ifstream in(path);
    REQUIRE_MESSAGE(in, path);
    std::vector<BadInput> out(1);
    int line_number = 0;
    for (std::string line; std::getline(in, line);)
    {
        ++line_number;
        BadInput& now = out.back();
        if (now.text.empty() && now.errors.empty()) now.line = line_number;
        if (line.empty() && !now.errors.empty())
            out.emplace_back();
        else if (line.starts_with("-> "))
            now.errors += line.substr(3) + "\n";
        else if (!line.empty() && !line.starts_with("# "))
            now.text += line + "\n";
    }
    if (out.back().text.empty()) out.pop_back();
    return out;
}

std::string document(const BadInput& bad)
{
    const std::string mark = "whole document:\n";
    if (bad.text.starts_with(mark)) return bad.text.substr(mark.size());
    return "<plab version=\"1\">\n" + bad.text + "</plab>\n";
}

std::string errors_of(const std::string& text)
{
    test::SampleTypes types;
    Errors errors;
    const auto blueprint = blueprint::read_blueprint(text, "scene.xml");
    if (!blueprint)
        errors = blueprint.errors();
    else if (const auto scene = model::compile(*blueprint, types); !scene)
        errors = scene.errors();
    std::string out;
    for (const Error& error : errors) out += error.text() + "\n";
    return out;
}

}  // namespace

TEST_CASE("each bad input is refused with its own message and position")
{
    const std::vector<BadInput> table = read_table(PLAB_SOURCE_DIR "/tests/unit/blueprint/bad_inputs.txt");
    CHECK(table.size() >= 80);
    for (const BadInput& bad : table)
    {
        CAPTURE(bad.line);
        CAPTURE(bad.text);
        REQUIRE(!bad.errors.empty());
        CHECK(errors_of(document(bad)) == bad.errors);
    }
}

TEST_CASE("the bad parts of one scene are all reported at once, in document order")
{
    CHECK(errors_of("<plab version='1'>\n<scene dt='0'/>\n<component id='a' type='State/RigidBodi'/>\n"
                    "<component id='b' type='State/RigidBody' mass='-1' positon='0 0 0'/>\n</plab>") ==
          "scene.xml:2:1: scene: dt must be positive, not 0\n"
          "scene.xml:3:1: a (State/RigidBodi): unknown type 'State/RigidBodi', did you mean 'State/RigidBody'?\n"
          "scene.xml:4:1: b (State/RigidBody): mass must be positive, not -1\n"
          "scene.xml:4:1: b (State/RigidBody): unknown attribute 'positon', did you mean 'position'? (known are "
          "'position', "
          "'orientation', 'linear_velocity', 'angular_velocity', 'mass', 'density', 'inertia', 'material', 'shape' and "
          "'solver')\n");
}

TEST_CASE("a fragment may not redefine existing components or change the scene's settings")
{
    test::SampleTypes types;
    const auto scene = blueprint::read_blueprint("<component id='a' type='State/Static'/>", "scene.xml");
    REQUIRE(scene.ok());
    const auto existing = model::compile(*scene, types);
    REQUIRE(existing.ok());
    const auto added = [&](const std::string& text)
    {
        const auto fragment = blueprint::read_blueprint(text, "request 17");
        REQUIRE(fragment.ok());
        const auto result = model::compile(*fragment, types, &*existing);
        return result.ok() ? "accepted" : result.error().text();
    };
    CHECK(added("<component id='b' type='Field/Gravity' between='a'/>") == "accepted");
    CHECK(added("<component id='a' type='State/Static'/>") == "request 17:1:1: a (State/Static): id 'a' is already in the scene");
    CHECK(added("<plab version='1'>\n<scene dt='1'/></plab>") ==
          "request 17:2:1: scene: dt belongs to the scene, not to a part that is added");
}
