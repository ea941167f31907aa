// Swaps across algorithms: H1, H2 and H7 of the catalogue of reference problems. Others: contact_swaps, swaps_solvers, swaps_storm.
#include "swaps.h"

using namespace plab;
using namespace plab::simulation;
using namespace plab::test;

namespace
{

struct Algorithm
{
    std::string resolution, response, more;
};

/// Each response with each resolution and each manager that it can have.
std::vector<Algorithm> contact_algorithms()
{
    std::vector<Algorithm> out;
    const std::string soft = "response.friction='0.4' response.stiffness='1e4' response.restitution='0.5' response.steps_per_contact='10'";
    const std::string hard = "response.friction='0.4'";
    for (const std::string& resolution : resolutions())
    {
        if (resolution != "Speculative") out.push_back({resolution, "Impulse", hard});
        for (const std::string& manager : managers())
            out.push_back({resolution, "Rows", hard + " response.manager='Manager/" + manager + "'"});
    }
    out.push_back({"LocalRoot", "Penalty", soft});
    out.push_back({"None", "HuntCrossley", soft});
    out.push_back({"LocalRoot", "None", ""});
    return out;
}

/// Two balls that meet head-on in the middle of the first steps, nothing else.
std::string two_balls(const std::string& response, const std::string& resolution = "LocalBisection")
{
    return solid("a", "Sphere' radius='0.1'", 1, {-0.12, 0, 0}, "linear_velocity='1 0.1 0' angular_velocity='0 0 2'") +
           solid("b", "Sphere' radius='0.1'", 2, {0.12, 0, 0}) +
           "<component id='contact' type='CDetection/ODE' between='a b' resolution='Resolution/" + resolution + "' response='Response/" +
           response + (response == "Penalty" || response == "HuntCrossley" ? "' response.restitution='1'/>" : "'/>");
}

double energy_of(const Scene& s)
{
    const Totals t = s.simulation().totals();
    return t.kinetic + t.stored;
}

}  // namespace

TEST_CASE("H1: a heap on each contact algorithm: exchanging any of its parts for itself changes no bit")
{
    for (const Algorithm& algorithm : contact_algorithms())
    {
        CAPTURE(algorithm.resolution);
        CAPTURE(algorithm.response);
        CAPTURE(algorithm.more);
        const std::string scene = heap() + ground_and_contact(algorithm.resolution, algorithm.response, algorithm.more);
        Scene alone(scene, dt(60)), exchanged(scene, dt(60));
        REQUIRE_MESSAGE(alone.loaded(), alone.error());
        alone.warnings_expected = exchanged.warnings_expected = true;
        alone.step(15), exchanged.step(15);
        for (const std::string& id : typed_ids(exchanged))
        {
            swapped(exchanged, id, type_name(exchanged, id));
            CHECK_MESSAGE(exchanged.hash() == alone.hash(), id);
        }
        for (int i = 0; i < 8; ++i)
        {
            alone.step(), exchanged.step();
            CHECK(exchanged.hash() == alone.hash());
        }
    }
}

TEST_CASE("H1: managers, resolutions and spaces exchanged and exchanged back between two steps change no bit")
{
    const std::string scene = heap() + ground_and_contact("None", "Rows", "response.friction='0.4' response.restitution='0.5'");
    Scene alone(scene, dt(60)), exchanged(scene, dt(60));
    REQUIRE_MESSAGE(alone.loaded(), alone.error());
    alone.step(21), exchanged.step(21);
    const auto there_and_back = [&](const std::string& id, const std::string& prefix, const std::vector<std::string>& types)
    {
        const std::string own = type_name(exchanged, id);
        for (const std::string& type : types)
        {
            swapped(exchanged, id, prefix + type);
            swapped(exchanged, id, own);
            CHECK_MESSAGE(exchanged.hash() == alone.hash(), type);
        }
    };
    there_and_back("contact.response.manager", "Manager/", managers());
    there_and_back("contact.resolution", "Resolution/", resolutions());
    for (const char* space : {"simple", "sweep_and_prune", "quadtree", "tree"})
    {
        swapped(exchanged, "contact", "CDetection/ODE", {{"space", std::string(space)}});
        CHECK(exchanged.hash() == alone.hash());
    }
    alone.step(20), exchanged.step(20);
    CHECK(exchanged.hash() == alone.hash());
}

TEST_CASE("H2: in free flight any swap of any algorithm leaves momentum, spin and energy as they are, to the bit")
{
    const std::string scene =
        solver_is("RungeKutta4") + solid("a", "Sphere' radius='0.1'", 1, {0, 0, 1}, "linear_velocity='1 2 3'") +
        solid("b", "Box' half_extents='0.1 0.2 0.3'", 2, {3, 0, 1}, "linear_velocity='-1 0 1' angular_velocity='1 2 3'") +
        ground_and_contact("LocalRoot", "Impulse");
    Scene s(scene, dt(60));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(7);
    const auto each = [&](const std::string& id, const std::string& prefix, const std::vector<std::string>& types)
    {
        for (const std::string& type : types)
        {
            const Totals before = s.simulation().totals();
            const Reply reply = swap(s, id, prefix + type);
            if (!reply.done) continue;  // Impulse cannot hold gaps
            const Totals after = s.simulation().totals();
            CHECK(before.kinetic == after.kinetic);
            CHECK(before.momentum == after.momentum);
            CHECK(before.angular_momentum == after.angular_momentum);
            CHECK(transfer_of(reply, "contacts").empty());
            s.step();
        }
    };
    for (const std::string& response : responses())
    {
        each("contact.response", "Response/", {response});
        each("contact.resolution", "Resolution/", resolutions());
        each("solver", "Solver/", solvers());
        if (response == "Rows") each("contact.response.manager", "Manager/", managers());
        each("contact.resolution", "Resolution/", {"None"});
    }
    CHECK(s.simulation().revision() > 80);
}

TEST_CASE("H2: in contact a swap of the response keeps momentum, and adds no energy that the reply does not show")
{
    for (const std::string& from : responses())
        for (const std::string& to : responses())
        {
            CAPTURE(from);
            CAPTURE(to);
            Scene s(two_balls(from), dt(240));
            REQUIRE_MESSAGE(s.loaded(), s.error());
            s.step(11);
            const Totals before = s.simulation().totals();
            const Reply reply = swapped(s, "contact.response", "Response/" + to);
            const Totals after = s.simulation().totals();
            CHECK(after.momentum == before.momentum);
            CHECK(after.angular_momentum == before.angular_momentum);
            CHECK(after.kinetic == before.kinetic);
            CHECK(reply.swaps[0].energy_before == before.kinetic + before.stored);
            // A hard response that finds an overlap of a sensor's parts the bodies within the next step: by 6 mm, at 0.1 m/s
            // along the surface, with a reduced mass of 2/3 kg.
            const bool parts = from == "None" && (to == "Impulse" || to == "Rows");
            const double turned = parts ? 6e-3 * 0.2 * 2 / 3 : 1e-14;
            double energy = energy_of(s);
            for (int i = 0; i < 40; ++i)
            {
                s.step();
                if (i == 0) CHECK(reply.swaps[0].with_new.energy == energy_of(s));
                CHECK(length(s.simulation().totals().momentum - before.momentum) <= 1e-14);
                CHECK(length(s.simulation().totals().angular_momentum - before.angular_momentum) <= turned);
                CHECK(energy_of(s) <= energy + 1e-7);
                energy = energy_of(s);
            }
            const Totals end = s.simulation().totals();
            CHECK(std::fabs(end.kinetic - s.simulation().kinetic_at_start() - end.work) <= 1e-6);
        }
}

TEST_CASE("H7: a request of a hundred swaps that fails at its end restores components, state and hash")
{
    const std::string scene = heap() + solver_is("RungeKutta4") +
                              ground_and_contact("LocalRoot", "Penalty",
                                                 "response.friction='0.4' response.stiffness='1e5' response.restitution='0.2' "
                                                 "response.steps_per_contact='20'");
    for (const char* first : {"Penalty", "Rows", "Impulse"})
    {
        Scene s(scene, dt(60)), alone(scene, dt(60));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        for (Scene* each : {&s, &alone})
        {
            each->step(20);
            swapped(*each, "contact.response", std::string("Response/") + first);
            each->step(10);
        }
        REQUIRE(s.hash() == alone.hash());
        const std::vector<std::string> ids = typed_ids(s);
        std::vector<Operation> operations;
        for (int i = 0; i < 25; ++i)
        {
            const auto pick = [&](const std::vector<std::string>& list) { return list[static_cast<std::size_t>(i) % list.size()]; };
            operations.push_back(SwapOperation{"contact.response", "Response/" + pick(responses()), {}});
            operations.push_back(SwapOperation{"solver", "Solver/" + pick(solvers()), {}});
            operations.push_back(SwapOperation{"contact.resolution", "Resolution/LocalBisection", {}});
            operations.push_back(SwapOperation{"low.shape", "Shape/Box", {{"half_extents", std::string("0.1 0.1 0.05")}}});
        }
        operations.push_back(SwapOperation{"solver", "Response/None", {}});  // what cannot be
        const Reply reply = s.ask_all(operations);
        CHECK(!reply.done);
        CHECK(typed_ids(s) == ids);
        CHECK(type_name(s, "contact.response") == std::string("Response/") + first);
        CHECK(s.hash() == alone.hash());
        for (int i = 0; i < 10; ++i)
        {
            s.step(), alone.step();
            CHECK(s.hash() == alone.hash());
        }
    }
}
