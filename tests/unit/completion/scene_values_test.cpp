// Values from the scene that a command line names.
#include <doctest/doctest.h>

#include <algorithm>

#include "completion/scene_values.h"

using namespace plab;
using program::Values;
using program::Wanted;

namespace
{

Values values(const std::string& option, const std::string& begun, const std::string& value = "TEXT")
{
    Wanted wanted;
    wanted.option = option, wanted.begun = begun, wanted.value = value;
    wanted.given["scene"] = {PLAB_SOURCE_DIR "/scenes/fan_and_balloons.xml"};
    return completion::scene_values(wanted);
}

bool has(const Values& values, const std::string& word)
{
    return std::any_of(values.candidates.begin(), values.candidates.end(), [&](const program::Candidate& c) { return c.word == word; });
}

}  // namespace

TEST_CASE("ids of a scene, then types of their family, after a step and in a list")
{
    const Values ids = values("--swap", "ge");
    CHECK(ids.go_on);
    CHECK(has(ids, "gears="));
    CHECK(has(ids, "contact.response="));
    const Values types = values("--swap", "100:gears=Con");
    CHECK(!types.go_on);
    CHECK(has(types, "100:gears=Constraint/AngularVelocity/Impulse"));
    CHECK(!has(types, "100:gears=Response/None"));
    CHECK(has(values("--vary", "gears=Assign,"), "gears=Assign,Constraint/AngularVelocity/Impulse"));
    CHECK(values("--swap", "nothing=").candidates.empty());
}

TEST_CASE("quantities include outputs, settable values do not")
{
    CHECK(has(values("--quantity", ""), "red."));
    CHECK(has(values("--quantity", "red."), "red.position"));
    CHECK(has(values("--set", "10:gears."), "10:gears.velocity_factor="));
    CHECK(!has(values("--set", "10:gears."), "10:gears.torque="));
}

TEST_CASE("files, types of the reference, and nothing where no values are known")
{
    CHECK(values("scene", "", "TEXT").are_files);
    CHECK(values("--out", "", "FILE").are_files);
    CHECK(has(values("--reference", "", "[TYPE]"), "Field/Gravity"));
    CHECK(values("--until", "").candidates.empty());
    Wanted nowhere;
    nowhere.option = "--swap", nowhere.given["scene"] = {"no such file"};
    CHECK(completion::scene_values(nowhere).candidates.empty());
}
