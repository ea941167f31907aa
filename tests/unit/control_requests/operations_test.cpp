// Requests as text: which operation each verb becomes, and that nothing that a client wrote is ignored.
#include "control/operations.h"

#include <doctest/doctest.h>

#include <cmath>

#include "plugins/library.h"

using namespace plab;
using wire::Operation;

namespace
{

Result<control::Wanted> wanted(std::vector<wire::Operation> operations)
{
    plugins::PluginLibrary library;
    wire::Request text;
    text.number = 1, text.operations = std::move(operations);
    return control::wanted_of(text, library);
}

template <class T>
T only(const wire::Operation& op)
{
    const auto out = wanted({op});
    REQUIRE_MESSAGE(out.ok(), out.error().text());
    REQUIRE(out->request.operations.size() == 1);
    return std::get<T>(out->request.operations.front());
}

std::string refusal(const wire::Operation& op)
{
    const auto out = wanted({op});
    REQUIRE_FALSE(out.ok());
    return out.error().text();
}

}  // namespace

TEST_CASE("each verb becomes its operation")
{
    CHECK(only<simulation::RemoveOperation>({"remove", "red", "", "", {}}).id == "red");
    const auto swap = only<simulation::SwapOperation>({"swap", "gears", "Constraint/X", "", {{"a", "1"}, {"b", "2 m"}}});
    CHECK(swap.type == "Constraint/X");
    REQUIRE(swap.values.size() == 2);
    CHECK(std::get<std::string>(swap.values[1].value) == "2 m");
    CHECK(only<simulation::StepOperation>({"step", "", "17", "", {}}).steps == 17);
    CHECK(only<simulation::RateOperation>({"rate", "", "max", "", {}}).factor == 0);
    CHECK(only<simulation::RateOperation>({"rate", "", "real", "", {}}).factor == 1);
    CHECK(only<simulation::RateOperation>({"rate", "", "2.5", "", {}}).factor == 2.5);
    CHECK(only<simulation::StepLengthOperation>({"dt", "", "1/480", "", {}}).dt.denominator == 480);
    (void)only<simulation::PauseOperation>({"pause", "", "", "", {}});
    (void)only<simulation::ResumeOperation>({"resume", "", "", "", {}});
    (void)only<simulation::ResetOperation>({"reset", "", "", "", {}});
    const auto to = only<simulation::RewindOperation>({"rewind", "", "500 ms", "", {}});
    CHECK((to.time == 0.5 && !to.back));
    const auto by = only<simulation::RewindOperation>({"rewind", "", "back 0.25 s", "", {}});
    CHECK((by.time == 0.25 && by.back));
    CHECK(control::text_of(by).argument == "back 0.25");
    CHECK(only<simulation::SnapshotOperation>({"snapshot", "before.2_a-b", "", "", {}}).name == "before.2_a-b");
    const auto add =
        only<simulation::AddBlueprintOperation>({"add", "", "", "<component id=\"g\" type=\"Field/Gravity\" between=\"*\"/>", {}});
    CHECK(add.blueprint->components.size() == 1);
    const auto load = only<simulation::LoadOperation>({"load", "", "a.xml", "<plab version=\"1\"><scene dt=\"1/100\"/></plab>", {}});
    CHECK(load.scene.settings.dt.denominator == 100);
    CHECK(wanted({{"shutdown", "", "", "", {}}})->shutdown);
}

TEST_CASE("set makes one operation of each value")
{
    const auto out = wanted({{"set", "red", "", "", {{"mass", "2 kg"}, {"color", "1 0 0"}}}});
    REQUIRE(out.ok());
    REQUIRE(out->request.operations.size() == 2);
    CHECK(std::get<simulation::SetOperation>(out->request.operations[1]).name == "color");
}

TEST_CASE("a push at a point in N s, or of a shaft in N m s")
{
    const auto push = only<simulation::PushOperation>({"push", "red", "", "", {{"impulse", "1 2 3"}, {"point", "0 0 5 cm"}}});
    CHECK(push.impulse == Vec3{1, 2, 3});
    REQUIRE(push.point.has_value());
    CHECK(push.point->z == doctest::Approx(0.05));
    CHECK(only<simulation::PushOperation>({"push", "axle", "", "", {{"impulse", "0.5"}}}).impulse == Vec3{0.5, 0, 0});
}

TEST_CASE("unused arguments of a verb are refused, and so are missing ones")
{
    CHECK(refusal({"pause", "red", "", "", {}}) == "operation 1 (pause): takes no target");
    CHECK(refusal({"remove", "red", "now", "", {}}) == "operation 1 (remove): takes no argument");
    CHECK(refusal({"swap", "a", "T/x", "<x/>", {}}) == "operation 1 (swap): takes no blueprint");
    CHECK(refusal({"reset", "", "", "", {{"a", "1"}}}) == "operation 1 (reset): takes no values");
    CHECK(refusal({"swap", "a", "", "", {}}) == "operation 1 (swap): needs an argument: the new type");
    CHECK(refusal({"remove", "", "", "", {}}) == "operation 1 (remove): needs a target: the component");
    CHECK(refusal({"set", "red", "", "", {}}) == "operation 1 (set): needs values: pairs of name and text");
    CHECK(refusal({"set", "red", "", "", {{"mass", "1"}, {"mass", "2"}}}) == "operation 1 (set): gives 'mass' twice");
    CHECK(refusal({"add", "", "", "", {}}) == "operation 1 (add): needs a blueprint: XML text");
    CHECK(refusal({"push", "red", "", "", {{"point", "0 0 0"}}}).find("needs the value impulse") != std::string::npos);
    CHECK(refusal({"push", "red", "", "", {{"impulse", "1 nan 0"}}}).find("impulse") != std::string::npos);
    for (const char* bad : {"", "0", "-1", "1.5", "1e3", "99999999999999999999", "7 "})
        CHECK(wanted({{"step", "", bad, "", {}}}).ok() == false);
    for (const char* bad : {"0", "-1", "fast", "inf", "nan", "1 ", "1e300", "1e-20"})
        CHECK(wanted({{"rate", "", bad, "", {}}}).ok() == false);
    CHECK(refusal({"swpa", "a", "T", "", {}}) == "operation 1 (swpa): 'swpa' is not an operation, did you mean 'swap'?");
}

TEST_CASE("errors of a blueprint keep their position, all of them are reported, and shutdown may not be combined with others")
{
    const auto out = wanted({{"load", "", "bad.xml", "<plab version=\"1\">\n  <component id=\"x\" type=\"No/Such\"/>\n</plab>", {}},
                             {"step", "", "0", "", {}}});
    REQUIRE_FALSE(out.ok());
    REQUIRE(out.errors().size() == 2);
    CHECK(out.errors()[0].text().rfind("bad.xml:2:", 0) == 0);
    CHECK(out.errors()[1].text().rfind("operation 2 (step)", 0) == 0);
    CHECK(wanted({{"shutdown", "", "", "", {}}, {"pause", "", "", "", {}}}).ok() == false);
    plugins::PluginLibrary library;
    wire::Request later;
    later.at = 5, later.operations = {{"shutdown", "", "", "", {}}};
    CHECK_FALSE(control::wanted_of(later, library).ok());
}

TEST_CASE("the step and the revision that a request names")
{
    plugins::PluginLibrary library;
    wire::Request text;
    text.at = 0, text.revision = 3;
    text.operations = {{"pause", "", "", "", {}}};
    const auto out = control::wanted_of(text, library);
    REQUIRE(out.ok());
    CHECK(out->request.at == 0);
    CHECK(out->request.revision == 3u);
    text.at = text.revision = -1;
    const auto free = control::wanted_of(text, library);
    CHECK_FALSE(free->request.at.has_value());
    CHECK_FALSE(free->request.revision.has_value());
}

TEST_CASE("a sign does not name an earlier time, and names of snapshots follow the rules for those of servers")
{
    for (const char* time : {"-1", "-0", "-2 s", "back -1", "back -0 s"})
        CHECK(refusal({"rewind", "", time, "", {}}).find("is negative") != std::string::npos);
    for (const char* time : {"back", "back ", "back1", "now", "1 m"}) CHECK(!refusal({"rewind", "", time, "", {}}).empty());
    for (const std::string& name : {std::string("a/b"), std::string("a b"), std::string("\n"), std::string(65, 'a')})
        CHECK(refusal({"snapshot", name, "", "", {}}).find("is not a valid snapshot name") != std::string::npos);
}

TEST_CASE("trial and energy set how a request is checked, cancel names a request; none of them is an operation")
{
    using Budget = simulation::TrialChoice::Budget;
    const wire::Operation swap{"swap", "gears.*", "Constraint/X", "", {}};
    const auto trial = [&](const std::string& text)
    {
        const auto out = wanted({swap, {"trial", "", text, "", {}}});
        REQUIRE_MESSAGE(out.ok(), out.error().text());
        CHECK(out->request.operations.size() == 1);
        return out->request.trial;
    };
    CHECK(wanted({swap})->request.trial.budget == Budget::Automatic);
    CHECK(trial("none").budget == Budget::None);
    CHECK(trial("unlimited").budget == Budget::Unlimited);
    CHECK(trial("20 ms").ns == 20e6);
    CHECK(trial("0.5").budget == Budget::Given);
    CHECK(!trial("0.5").must);
    CHECK(trial("20 ms or refuse").must);
    CHECK((trial("or refuse").must && trial("or refuse").budget == Budget::Automatic));
    for (const char* wrong : {"no", "-1", "0", "1e10", "nan", "20 s", "none or refuse", "20 or"})
        CHECK_MESSAGE(refusal({"trial", "", wrong, "", {}}).find("not a budget of a trial") != std::string::npos, wrong);

    CHECK(wanted({swap})->request.trial.energy_factor == 100);
    CHECK(wanted({swap, {"energy", "", "1e4", "", {}}})->request.trial.energy_factor == 1e4);
    CHECK(std::isinf(wanted({swap, {"energy", "", "any", "", {}}})->request.trial.energy_factor));
    CHECK(refusal({"energy", "", "0.5", "", {}}).find("1 or more") != std::string::npos);

    const std::string client = "000102030405060708090a0b0c0d0eff";
    const auto cancel = wanted({{"cancel", "", client + ":17", "", {}}});
    REQUIRE_MESSAGE(cancel.ok(), cancel.error().text());
    REQUIRE(cancel->cancel.has_value());
    CHECK(cancel->cancel->client[10] == 0x0a);
    CHECK(cancel->cancel->client[15] == 0xff);
    CHECK(cancel->cancel->number == 17);
    for (const std::string& wrong :
         std::vector<std::string>{client, client + ":0", client + ":x", client.substr(1) + ":1", "g" + client.substr(1) + ":1"})
        CHECK_MESSAGE(refusal({"cancel", "", wrong, "", {}}).find("is not the name of a request") != std::string::npos, wrong);
    CHECK(!wanted({swap, {"cancel", "", client + ":17", "", {}}}).ok());
}
