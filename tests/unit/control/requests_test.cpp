// What plabctl sends, and how it prints the reply.
#include <chrono>
#include <future>
#include <memory>

#include "plabctl.h"

using namespace plab::test;

namespace
{

using Values = std::vector<std::pair<std::string, std::string>>;

}  // namespace

TEST_CASE("a swap reports its effect")
{
    FakeServer server(test_domain(), "lab");
    const Outcome human = lab("swap contact.response --to Response/None --param restitution=0.5 --param note=a=b");
    CHECK(human.code == 0);
    const Asked asked = server.last();
    REQUIRE(asked.parts.size() == 1);
    CHECK(asked.parts[0].verb == "swap");
    CHECK(asked.parts[0].target == "contact.response");
    CHECK(asked.parts[0].argument == "Response/None");
    CHECK(asked.parts[0].values == Values{{"restitution", "0.5"}, {"note", "a=b"}});
    CHECK(asked.at == -1);
    CHECK(asked.revision == -1);
    CHECK(has(human.out, "revision 4"));
    CHECK(has(human.out, "pause 243.1 us"));
    CHECK(has(human.out, "Response/Impulse -> Response/None"));
    CHECK(has(human.out, "kept      restitution"));
    CHECK(has(human.out, "fresh     softness"));
    CHECK(has(human.out, "lost      friction"));
    CHECK(has(human.out, "converted -"));
    CHECK(has(human.out, "8.6 us"));
    CHECK(has(human.out, "17.1 us"));
    CHECK(has(human.out, "1 0 0.5"));
    const Json json = lab("--json swap contact.response --to Response/None --at 999999999 --revision 3").json();
    CHECK(server.last().at == 999999999);
    CHECK(json["outcome"] == "done");
    CHECK(json["server"] == "lab");
    CHECK(json["pause_ns"] == 243100);
    CHECK(json["swaps"][0]["fields"]["friction"] == "lost");
    CHECK(json["swaps"][0]["with_new"]["momentum"] == Json({1.0, 0.0, 0.5}));
    CHECK(json["swaps"][0]["with_old"]["cost_ns"] == 8600);
    CHECK(json["swaps"][0]["energy_before"] == 5.125);
}

TEST_CASE("a refused request prints all reasons and ends with 4")
{
    FakeServer server(test_domain(), "lab");
    const Outcome refused = lab("remove nobody");
    CHECK(refused.code == 4);
    CHECK(refused.out.empty());
    CHECK(has(refused.err, "did you mean 'red'?"));
    CHECK(has(refused.err, "nothing was changed"));
    const Outcome json = lab("remove nobody --json");
    CHECK(json.code == 4);
    CHECK(json.json()["outcome"] == "refused");
    CHECK(json.json()["reasons"].size() == 2);
    const Outcome late = lab("pause --at 3");
    CHECK(late.code == 4);
    CHECK(has(late.err, "late at step"));
    CHECK(has(late.err, "step 3 has passed"));
}

TEST_CASE("a file keeps its name in messages")
{
    FakeServer server(test_domain(), "lab");
    const std::string file = temporary("ball.xml");
    std::ofstream(file) << "<plab version=\"1\">\n\n    <bad/>\n</plab>\n";
    const Outcome refused = lab("add " + quoted(file));
    CHECK(refused.code == 4);
    CHECK(has(refused.err, file + ":3:5: <bad>"));
    CHECK(lab("load " + quoted(file)).code == 4);
    const Outcome piped = lab("add -", "echo '<component/>' |");
    CHECK(piped.code == 0);
    CHECK(server.last().parts.at(0).blueprint == "<component/>\n");
    const Outcome missing = lab("add /no/such/file.xml");
    CHECK(missing.code == 1);
    CHECK(has(missing.err, "cannot open '/no/such/file.xml'"));
    std::remove(file.c_str());
}

TEST_CASE("the command set: ids with dots, names with dots, several at once")
{
    FakeServer server(test_domain(), "lab");
    CHECK(lab("set red.mass=0.03 red.position='1 2 3' contact.response.restitution=0.5 --at 999999999").code == 0);
    const Asked asked = server.last();
    REQUIRE(asked.parts.size() == 2);
    CHECK(asked.parts[0].target == "red");
    CHECK(asked.parts[0].values == Values{{"mass", "0.03"}, {"position", "1 2 3"}});
    CHECK(asked.parts[1].target == "contact.response");
    CHECK(asked.parts[1].values == Values{{"restitution", "0.5"}});
    CHECK(lab("set contact.state.count=3").code == 0);
    const Asked script = server.last();
    CHECK(script.parts.at(0).target == "contact");
    CHECK(script.parts.at(0).values == Values{{"state.count", "3"}});
    CHECK(lab("set red=3").code == 2);
    CHECK(lab("set red.mass").code == 2);
}

TEST_CASE("every command sends exactly what the contract requires")
{
    FakeServer server(test_domain(), "lab");
    struct Case
    {
        const char* arguments;
        Asked::Part part;
    };
    const Case cases[] = {
        {"push red --impulse '-1 0 0.5'", {"push", "red", "", "", {{"impulse", "-1 0 0.5"}}}},
        {"push red --impulse '1 0 0' --point '0 -1 0'", {"push", "red", "", "", {{"impulse", "1 0 0"}, {"point", "0 -1 0"}}}},
        {"pause", {"pause", "", "", "", {}}},
        {"resume", {"resume", "", "", "", {}}},
        {"step", {"step", "", "1", "", {}}},
        {"step 10", {"step", "", "10", "", {}}},
        {"rate max", {"rate", "", "max", "", {}}},
        {"dt 1/480", {"dt", "", "1/480", "", {}}},
        {"reset", {"reset", "", "", "", {}}},
    };
    for (const Case& c : cases)
    {
        CAPTURE(c.arguments);
        CHECK(lab(c.arguments).code == 0);
        const Asked asked = server.last();
        REQUIRE(asked.parts.size() == 1);
        CHECK(asked.parts[0].verb == c.part.verb);
        CHECK(asked.parts[0].target == c.part.target);
        CHECK(asked.parts[0].argument == c.part.argument);
        CHECK(asked.parts[0].blueprint == c.part.blueprint);
        CHECK(asked.parts[0].values == c.part.values);
    }
    CHECK(has(lab("rate").out, "rate real, reached 0.998"));
    CHECK(has(lab("dt").out, "(1/240)"));
}

TEST_CASE("a missing reply is a time-out")
{
    FakeServer server(test_domain(), "lab");
    const Outcome silent = lab("remove silent --timeout 0.6");
    CHECK(silent.code == 3);
    CHECK(has(silent.err, "no reply from server 'lab'"));
    // It may still take effect, and can be cancelled under this name.
    CHECK(has(silent.err, "can take effect before its next step"));
    CHECK(has(silent.err, "'plabctl --server lab cancel "));
}

TEST_CASE("a request for a later step is valid as long as its server")
{
    auto server = std::make_unique<FakeServer>(test_domain(), "lab");
    const std::string request = "remove silent --at 999999999 --timeout ";
    const Outcome alive = lab(request + "0.6");
    CHECK(alive.code == 3);
    CHECK(has(alive.err, "the request remains valid"));
    (void)server->last();  // that one
    auto left_alone = std::async(std::launch::async, [&] { return lab(request + "20"); });
    for (int i = 0; i < 500 && server->last().parts.empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    server.reset();
    const Outcome gone = left_alone.get();
    CHECK(gone.code == 3);
    CHECK(has(gone.err, "server 'lab' has gone without a reply"));
    CHECK(has(gone.err, "the request will not be carried out"));
    CHECK_FALSE(has(gone.err, "the request remains valid"));
}

TEST_CASE("numbers out of range are refused, and the message gives a valid one")
{
    FakeServer server(test_domain(), "lab");
    struct Case
    {
        const char *arguments, *message;
    };
    const Case cases[] = {
        {"pause --at 9223372036854775808", "--at: must be at most 9223372036854775807, not '9223372036854775808'"},
        {"pause --at -3", "--at: must be a whole number, 0 or more, not '-3'"},
        {"pause --at 1.5", "--at: must be a whole number"},
        {"pause --revision 9223372036854775808", "--revision: must be at most"},
        {"step 9223372036854775808", "count: must be at most 9223372036854775807"},
        {"step 0", "count: must be a whole number, 1 or more, not '0'"},
        {"wait --step 9223372036854775808", "--step: must be at most"},
        {"wait --time nan", "--time: must be a number from 0 to 1e8, not 'nan'"},
        {"watch events -n 0", "--count: must be a whole number, 1 or more"},
        {"watch events -d 1e10", "--duration: must be a number above 0, at most 1e8, not '1e10'"},
        {"objects --timeout 1e10", "--timeout: must be a number above 0, at most 1e8"},
        {"objects --timeout inf", "--timeout: must be a number above 0"},
        {"objects --timeout nan", "--timeout: must be a number above 0"},
        {"objects --timeout 0", "--timeout: must be a number above 0"},
    };
    for (const Case& c : cases)
    {
        CAPTURE(c.arguments);
        const Outcome refused = lab(c.arguments);
        CHECK(refused.code == 2);
        CHECK_MESSAGE(has(refused.err, c.message), refused.err);
        CHECK(refused.err.size() < 200);
        CHECK(server.last().parts.empty());
    }
    const Outcome steps = lab("step 9223372036854775807");
    CHECK(steps.code == 0);
    // It was requested once; how often the request had to be sent is not reported.
    CHECK_MESSAGE(!has(steps.out, "carried out before"), steps.out);
    CHECK(server.last().parts.at(0).argument == "9223372036854775807");
    CHECK(lab("step --json").json()["repeated"] == false);
    CHECK(lab("pause --at 9223372036854775807").code == 0);
    CHECK(server.last().at == 9223372036854775807);
    CHECK(lab("objects --timeout 1e8").code == 0);
}

TEST_CASE("shutdown waits until the server has ended")
{
    FakeServer server(test_domain(), "lab");
    CHECK(plabctl("shutdown").code == 0);
    CHECK(plabctl("servers").code == 3);
}
