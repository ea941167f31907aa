// A12: everything that a step depends on is state. If a saved state is restored at any step, the same bits follow: in contact,
// with each manager, with one thread and two. Without dissipation, reversed velocities lead back.
#include "plab/random.h"
#include "statics_scene.h"
#include "support/bare_run.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Boxes and balls thrown into a heap: impacts, sliding, rolling and rest.
std::string heap(const std::string& manager, const std::string& resolution)
{
    std::string body = kGround, ids;
    std::uint64_t random = 11;
    const auto any = [&](double size) { return size * (2 * next_uniform(random) - 1); };
    for (std::size_t i = 0; i < 8; ++i)
    {
        const std::string id = name_of_box(i);
        const Vec3 at{0.3 * any(1), 0.3 * any(1), 0.4 + 0.5 * static_cast<double>(i)};
        const std::string moving =
            "linear_velocity=\"" + text(Vec3{any(1), any(1), -1}) + "\" angular_velocity=\"" + text(Vec3{any(2), any(2), any(2)}) + "\"";
        body += i % 3 == 2 ? ball(id, 0.15, 1, at, moving) : box(id, {0.2, 0.15, 0.1}, 1 + static_cast<double>(i), at, moving);
        ids += id + " ";
    }
    return body + gravity(ids) + contact(ids + "ground", manager, 0.5, 0.3, resolution);
}

}  // namespace

TEST_CASE("A12: ten thousand steps with contacts, restored at random steps and run again: the same bits, on one thread and two")
{
    constexpr Tick kSteps = 10000;
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
    {
        CAPTURE(manager);
        std::vector<std::uint64_t> hashes;
        const auto scene = compile_text(whole_scene(heap(manager, "None"), "dt=\"1/120\""));
        REQUIRE_MESSAGE(scene.ok(), reasons(scene));
        BareRun first(*scene, 1);
        std::vector<BareRun::Memento> saved;
        std::uint64_t random = 5;
        for (Tick next = 0; first.tick() < kSteps;)
        {
            if (first.tick() == next) saved.push_back(first.save()), next += 1 + static_cast<Tick>(next_uniform(random) * 2000);
            hashes.push_back(first.step());
        }
        CHECK(!first.contacts().pairs().empty());
        REQUIRE(saved.size() > 5);
        BareRun other(*scene, 2);
        for (std::size_t k = saved.size(); k-- > 0;)
        {
            BareRun& run = k % 2 == 0 ? first : other;
            run.restore(saved[k]);
            const Tick from = run.tick(), to = std::min<Tick>(kSteps, from + 300);
            Tick differs = -1;
            while (run.tick() < to && differs < 0)
                if (run.step() != hashes[static_cast<std::size_t>(run.tick() - 1)]) differs = run.tick();
            CAPTURE(from);
            CHECK(differs == -1);
        }
    }
}

TEST_CASE("a swap of a response or a manager for its own type changes no bit, with any resolution")
{
    for (const char* manager : {"Direct", "SequentialImpulse", "SoftStep"})
        for (const char* resolution : {"None", "LocalBisection"})
        {
            CAPTURE(resolution);
            CAPTURE(manager);
            // Locating the impacts of a heap with the exact manager takes minutes, and has nothing to do with swaps.
            if (manager == std::string("Direct") && resolution != std::string("None")) continue;
            Scene plain(heap(manager, resolution), "dt=\"1/60\""), swapped(heap(manager, resolution), "dt=\"1/60\"");
            REQUIRE_MESSAGE(plain.loaded(), plain.error());
            plain.warnings_expected = swapped.warnings_expected = true;
            for (int i = 0; i < 30; ++i)
            {
                plain.step(), swapped.step();
                if (i % 4 == 1) REQUIRE(swapped.ask(simulation::SwapOperation{"contact.response", "Response/Rows", {}}).done);
                if (i % 4 == 3)
                    REQUIRE(swapped.ask(simulation::SwapOperation{"contact.response.manager", std::string("Manager/") + manager, {}}).done);
                REQUIRE(plain.hash() == swapped.hash());
            }
        }
}

TEST_CASE("A12: elastic balls in a box with reversed velocities return to their initial positions, to 1e-10 m")
{
    std::string body = kGround, ids;
    const Vec3 places[] = {{0, 0, 0.5}, {0.31, 0.05, 1.1}, {-0.2, 0.3, 1.6}, {0.1, -0.28, 2.2}};
    for (std::size_t i = 0; i < 4; ++i)
        body += ball(name_of_box(i), 0.1, 1 + static_cast<double>(i), places[i],
                     "linear_velocity=\"" + text(Vec3{0.3 * (i % 2 ? 1 : -1), 0.1, 0}) + "\""),
            ids += name_of_box(i) + " ";
    body += "<component id=\"flight\" type=\"Solver/Exact\"/>";
    Scene s(body + gravity(ids) + contact(ids + "ground", "Direct", 0, 1, "LocalRoot"), "dt=\"1/60\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.keep_events = true;
    s.step(90);
    CHECK(s.count("contact.impact") > 5);
    for (std::size_t i = 0; i < 4; ++i)
    {
        const Vec3 v = s.vec(name_of_box(i), "linear_velocity");
        REQUIRE(s.ask(simulation::SetOperation{name_of_box(i), "linear_velocity", -v}).done);
    }
    s.step(90);
    for (std::size_t i = 0; i < 4; ++i)
    {
        CAPTURE(i);
        CHECK(distance(s.vec(name_of_box(i), "position"), places[i]) < 1e-10);
    }
}
