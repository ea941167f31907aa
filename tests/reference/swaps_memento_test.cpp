// Everything that a step depends on is in the memento, including the memory of contacts: stiction springs, warm starts, overlap
// left by a swap.
#include "support/bare_run.h"
#include "swaps.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Stretched springs and impulses from which the next step starts.
std::size_t remembered(const simulation::ContactCache& contacts)
{
    std::size_t n = 0;
    for (const simulation::ForcePair& p : contacts.force_pairs())
        for (const simulation::ForceContact& c : p.all()) n += c.stretch != Vec3{} ? 1 : 0;
    for (const simulation::PairState& p : contacts.pairs())
        for (std::uint32_t k = 0; k < p.count; ++k) n += p.contacts[k].impulse != Vec3{} ? 1 : 0;
    return n;
}

/// Boxes held by friction: gravity is not perpendicular to the floor.
std::string leaning(const std::string& resolution, const std::string& response, const std::string& more)
{
    return gravity("2 1 -9.6") + solid("low", "Box' half_extents='0.2 0.2 0.1'", 2, {0, 0, 0.1}) +
           solid("high", "Box' half_extents='0.1 0.1 0.1'", 1, {0.02, 0.03, 0.3}) +
           solid("roller", "Sphere' radius='0.1'", 1, {1, 0, 0.1}, "linear_velocity='0.3 0.1 0'") +
           ground_and_contact(resolution, response, more);
}

}  // namespace

TEST_CASE("a memento of boxes held by friction is complete, on springs and on rows, also in a world that never ran")
{
    const std::string soft = "response.friction='0.6' response.stiffness='1e4' response.restitution='0.2' response.steps_per_contact='20'";
    std::vector<std::string> scenes{leaning("None", "Penalty", soft), leaning("None", "HuntCrossley", soft),
                                    leaning("LocalBisection", "Impulse", "response.friction='0.6'")};
    for (const std::string& manager : managers())
        for (const char* resolution : {"None", "LocalBisection"})
            scenes.push_back(leaning(resolution, "Rows", "response.friction='0.6' response.manager='Manager/" + manager + "'"));
    for (const std::string& scene : scenes)
    {
        CAPTURE(scene);
        const auto compiled = compile_text(whole_scene(scene, dt(60)));
        REQUIRE_MESSAGE(compiled.ok(), reasons(compiled));
        BareRun run(*compiled), fresh(*compiled);
        run.advance(30);
        CHECK(remembered(run.contacts()) >= 4);
        const BareRun::Memento memento = run.save();
        const auto first = run.advance(15);
        run.restore(memento);
        CHECK(run.advance(15) == first);
        fresh.restore(memento);
        CHECK(fresh.advance(15) == first);
    }
}
