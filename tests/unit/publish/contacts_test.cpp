// The contacts of a step as a record: who gets it when, what sleeps, how much it holds, and what it costs nobody.
#include "publish/contacts.h"

#include "simulation/sleeping.h"
#include "support/allocation_counter.h"
#include "support/gravity.h"
#include "watcher.h"

using namespace plab;
using namespace plab::test;
using publish::Stream;

namespace
{

/// N: sum of the normal forces of a record.
double load_of(const wire::ContactForces& contacts)
{
    double sum = 0;
    for (const wire::ContactInfo& c : contacts.entries)
        for (const wire::ContactPoint& p : c.points) sum += p.normal_force;
    return sum;
}

std::size_t points_of(const wire::ContactForces& contacts)
{
    std::size_t sum = 0;
    for (const wire::ContactInfo& c : contacts.entries) sum += c.points.size();
    return sum;
}

}  // namespace

TEST_CASE("contacts are noted only in steps after which somebody gets them")
{
    Scene s(resting_scene(cube("a", {0, 0, 0.25})));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Watched w(s, kRarely, {});
    const auto is_noted = [&] { return s.simulation().stepper().contact_log().on(); };
    w.step(5);
    CHECK_FALSE(is_noted());
    CHECK(s.simulation().stepper().contact_log().entries().empty());
    CHECK(w.watcher.contact_samples == 0);
    // The first sample comes with the next step, the others on schedule: here none.
    w.watcher.wanted = {Stream::Contacts};
    w.step();
    CHECK(is_noted());
    CHECK(w.watcher.contact_samples == 1);
    CHECK(w.watcher.contacts.sequence_number == 1);
    w.step(20);
    CHECK_FALSE(is_noted());
    CHECK(w.watcher.contact_samples <= 2);
    // A further reader gets one, too.
    const std::size_t before = w.watcher.contact_samples;
    ++w.watcher.joined;
    w.step();
    CHECK(w.watcher.contact_samples == before + 1);
    w.watcher.wanted = {};
    w.step(3);
    CHECK_FALSE(is_noted());
    CHECK(w.watcher.contact_samples == before + 1);
}

TEST_CASE("an observer with an interval of its own gets the contacts of those steps")
{
    Scene s(resting_scene(cube("a", {0, 0, 0.25})), "dt=\"1/100\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Watched w(s, kRarely, {Stream::Contacts});
    w.watcher.intervals[Stream::Contacts] = 0.05;
    w.step();
    const std::size_t first = w.watcher.contact_samples;
    w.step(50);
    CHECK(w.watcher.contact_samples == first + 10);
    CHECK(near(load_of(w.watcher.contacts), kG, 1e-3));
}

TEST_CASE("paused, nothing is sent; of steps that a client asks for, the last one is")
{
    Scene s(resting_scene(cube("a", {0, 0, 0.25})));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    Watched w(s, kRarely, {Stream::Contacts});
    w.step(3);
    (void)w.ask(simulation::PauseOperation{});
    const std::size_t before = w.watcher.contact_samples;
    w.settle();
    CHECK(w.watcher.contact_samples == before);
    (void)w.ask(simulation::StepOperation{5});
    w.step(5);
    CHECK(w.watcher.contact_samples == before + 1);
    CHECK(w.watcher.contacts.step == s.simulation().tick());
}

TEST_CASE("an island that sleeps has the forces of its last step; awake again, those of each step")
{
    Scene s(resting_scene(stack("a", 0, 3) + cube("far", {9, 0, 3})), "dt=\"1/120\"");
    REQUIRE_MESSAGE(s.loaded(), s.error());
    for (int i = 0; i < 600 && !is_asleep(s, "a0"); ++i) s.step();
    REQUIRE(is_asleep(s, "a0"));
    const auto check = [&](const wire::ContactForces& c, bool asleep)
    {
        double on_ground = 0;
        std::size_t pairs = 0;
        for (const wire::ContactInfo& e : c.entries)
        {
            if (e.a == "far" || e.b == "far") continue;
            ++pairs;
            CHECK(e.asleep == asleep);
            if (e.b != "ground") continue;
            for (const wire::ContactPoint& p : e.points)
            {
                on_ground += p.normal_force;
                CHECK(std::fabs(p.position.z) < 1e-3);
            }
        }
        CHECK(pairs == 3);
        CHECK_MESSAGE(near(on_ground, 3 * kG, 0.01), on_ground);
    };
    // Nobody has read while it fell asleep.
    Watched w(s, kAlways, {Stream::Contacts});
    w.step();
    check(w.watcher.contacts, true);
    w.step(10);
    check(w.watcher.contacts, true);
    w.ask(simulation::PushOperation{"a2", {0, 0, -1e-3}, {}});
    w.step();
    REQUIRE_FALSE(is_asleep(s, "a0"));
    check(w.watcher.contacts, false);
    // It falls asleep while somebody reads: no pair is there twice.
    for (int i = 0; i < 600 && !is_asleep(s, "a0"); ++i) w.step();
    REQUIRE(is_asleep(s, "a0"));
    check(w.watcher.contacts, true);
}

TEST_CASE("reading contacts changes no bit of a run, asleep or awake")
{
    const std::string bodies = stack("a", 0, 3) + stack("b", 2, 4) + ball("ball", {0, 0, 4}) + cube("late", {4, 0, 9});
    Scene alone(resting_scene(bodies), "dt=\"1/120\""), read(resting_scene(bodies), "dt=\"1/120\"");
    Watched w(read, kAlways, {Stream::Contacts});
    for (int i = 0; i < 400; ++i)
    {
        alone.step(), w.step();
        if (i % 50 == 49) REQUIRE(alone.hash() == read.hash());
    }
    CHECK(w.watcher.contact_samples == 400);
}

TEST_CASE("more points than a sample holds: those with the largest forces are sent, the others are counted")
{
    std::string bodies;
    constexpr int kBoxes = 1100;
    for (int k = 0; k < kBoxes; ++k)
        bodies += "<component id=\"c" + std::to_string(k) + "\" type=\"State/RigidBody\" shape=\"cube\" mass=\"" + std::to_string(1 + k) +
                  "\" position=\"" + text(Vec3{1.0 * (k % 40), 1.0 * (k / 40), 0.25}) + "\"/>";
    Scene s(resting_scene(bodies, "type=\"Manager/SoftStep\""));
    REQUIRE_MESSAGE(s.loaded(), s.error());
    s.step(60);
    Watched w(s, kAlways, {Stream::Contacts});
    w.step();
    const wire::ContactForces& c = w.watcher.contacts;
    CHECK(points_of(c) == publish::kMostContactPoints);
    CHECK(c.left_out == 4 * kBoxes - publish::kMostContactPoints);
    const double weight = kG * kBoxes * (kBoxes + 1) / 2;
    CHECK(near(load_of(c) + c.force_left_out, weight, 1e-3));
    // The lightest are left out.
    CHECK(c.force_left_out < weight * 0.02);
    CHECK(c.force_left_out > 0);
}

TEST_CASE("warm steps that note contacts, and their records, allocate nothing")
{
    std::string bodies;
    for (int k = 0; k < 20; ++k) bodies += cube("c" + std::to_string(k), {1.0 * k, 0, 0.25});
    for (const char* manager : {"type=\"Manager/SoftStep\"", "type=\"Manager/SoftStep\" sleep_after=\"0.5\""})
    {
        CAPTURE(manager);
        Scene s(resting_scene(bodies, manager));
        REQUIRE_MESSAGE(s.loaded(), s.error());
        publish::ContactRecords records;
        wire::ContactForces out;
        s.simulation().log_contacts(true);
        const auto steps = [&](int n)
        {
            for (int i = 0; i < n; ++i) s.simulation().step(), records.fill(s.simulation(), out);
        };
        steps(300);
        const long before = allocations;
        steps(100);
        CHECK(allocations == before);
        CHECK(out.entries.size() == 20);
    }
}
