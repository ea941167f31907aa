// Which resolution can be combined with which response, and the messages about unused parameters.
#include "simulation/contacts/contact_rules.h"
#include "support/scene.h"

using namespace plab;
using plab::test::Scene;

namespace
{

std::string scene(const std::string& resolution, const std::string& response)
{
    return "<component id=\"floor\" type=\"Shape/Plane\"/><component id=\"ground\" type=\"State/Static\" shape=\"floor\"/>"
           "<component id=\"ball\" type=\"Shape/Sphere\" radius=\"1\"/>"
           "<component id=\"a\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"0 0 3\"/>"
           "<component id=\"contact\" type=\"CDetection/ODE\" between=\"a ground\" resolution=\"Resolution/" +
           resolution + "\" response=\"Response/" + response + "\"/>";
}

std::vector<std::string> unused(const Scene& s)
{
    return simulation::unused_in_contacts(s.simulation().world(), s.simulation().stepper().detectors());
}

}  // namespace

TEST_CASE("a resolution that speculates needs a response by rows")
{
    for (const char* response : {"Impulse", "None", "Penalty", "HuntCrossley"})
    {
        CAPTURE(response);
        const Scene s(scene("Speculative", response));
        CHECK(s.error().find("contact (CDetection/ODE)") != std::string::npos);
        CHECK(s.error().find("it needs a response by rows, like Response/Rows") != std::string::npos);
    }
    CHECK(Scene(scene("Speculative", "Rows")).loaded());
}

TEST_CASE("every other resolution can be combined with every response")
{
    for (const char* resolution : {"None", "Bisection", "LocalBisection", "ConservativeAdvancement", "LocalRoot"})
        for (const char* response : {"Impulse", "Rows", "None", "Penalty", "HuntCrossley"})
        {
            CAPTURE(resolution);
            CAPTURE(response);
            const Scene s(scene(resolution, response));
            CHECK_MESSAGE(s.loaded(), s.error());
        }
}

TEST_CASE("a pair has one detection: a second one with a response is refused with both names")
{
    const std::string first = scene("LocalRoot", "Impulse");
    const auto second = [](const std::string& more) { return "<component id=\"twin\" type=\"CDetection/ODE\" " + more + "/>"; };
    const std::string b = "<component id=\"b\" type=\"State/RigidBody\" mass=\"1\" shape=\"ball\" position=\"9 0 3\"/>";
    for (const char* more : {"between=\"a ground\"", "between=\"a\" against=\"ground\"", "between=\"*\" response=\"Response/Penalty\"",
                             "between=\"ground\" against=\"a b\" response=\"Response/Rows\""})
    {
        CAPTURE(more);
        const Scene s(first + b + second(more));
        CHECK_MESSAGE(s.error().find("twin (CDetection/ODE)") != std::string::npos, s.error());
        CHECK_MESSAGE(s.error().find("the pair 'a', 'ground' is answered by 'contact' as well") != std::string::npos, s.error());
    }
    for (const char* more : {"between=\"a ground\" response=\"Response/None\"", "between=\"b ground\"", "between=\"a b\"",
                             "between=\"b\" against=\"a ground\""})
    {
        CAPTURE(more);
        const Scene s(first + b + second(more));
        CHECK_MESSAGE(s.loaded(), s.error());
    }
    Scene s(first + b + second("between=\"a ground\" response=\"Response/None\""));
    CHECK_FALSE(s.ask(simulation::SwapOperation{"twin.response", "Response/Impulse", {}}).done);
    s.step();
}

TEST_CASE("an exchange that would give an invalid combination is refused, and nothing changes")
{
    Scene s(scene("LocalRoot", "Impulse"));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    CHECK_FALSE(s.ask(simulation::SwapOperation{"contact.resolution", "Resolution/Speculative", {}}).done);
    s.step();
    CHECK(s.ask(simulation::SwapOperation{"contact.response", "Response/Rows", {}}).done);
    CHECK(s.ask(simulation::SwapOperation{"contact.resolution", "Resolution/Speculative", {}}).done);
}

TEST_CASE("a resolution that locates times is not used where contacts are forces, and --explain has a sentence about it")
{
    const Scene force(scene("LocalRoot", "Penalty"));
    REQUIRE_MESSAGE(force.loaded(), force.error());
    REQUIRE(unused(force).size() == 1);
    CHECK(unused(force)[0].find("contact: Resolution/LocalRoot is not used, as contacts of Response/Penalty are forces") == 0);
    CHECK(unused(Scene(scene("None", "Penalty"))).empty());
    CHECK(unused(Scene(scene("LocalRoot", "Impulse"))).empty());
}
