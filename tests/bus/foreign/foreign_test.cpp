// The wire is for everybody: a client that eProsima's compiler and Fast DDS made of idl/plab.idl alone.
#include <sstream>

#include "../server.h"
#include "idl/domain.h"

using namespace plab;
using namespace plab::test;

namespace
{

std::map<std::string, double> figures_in(const std::string& text)
{
    std::map<std::string, double> out;
    std::istringstream in(text);
    std::string name;
    for (double value = 0; in >> name >> value;) out[name] = value;
    return out;
}

}  // namespace

TEST_CASE("a Fast DDS client reads frames, exchanges an interaction and gets the reply")
{
    const std::string client = PLAB_FOREIGN_CLIENT;
    if (client.empty())
    {
        MESSAGE("skipped: fastddsgen or Fast DDS is not installed (docker/install.sh foreign)");
        return;
    }
    Server server(scene_file("fan_and_balloons.xml"));
    const auto domain = wire::domain_from_environment();
    REQUIRE(domain.ok());
    const Outcome out = run({client, std::to_string(domain->id), server.name(), "gears", "Constraint/AngularVelocity/Graph",
                             "Constraint/AngularVelocity/Impulse"});
    REQUIRE_MESSAGE(out.code == 0, out.errors);
    const auto figures = figures_in(out.output);
    CHECK(figures.at("frames") >= 30);
    CHECK(figures.at("bodies") == 2);
    CHECK(figures.at("objects") >= 1);
    CHECK(figures.at("swaps") == 20);
    MESSAGE("a swap's reply at Fast DDS: median " << figures.at("reply_ms_median") << " ms, longest " << figures.at("reply_ms_longest"));
    CHECK(figures.at("reply_ms_median") < 100);  // whoever waited for a repetition would wait for a second
}
