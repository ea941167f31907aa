// Trigger/*: what people do to objects becomes requests, once each, in a replay again.
#include "control/component_requests.h"
#include "plab/rotation.h"
#include "users/hands.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kTick = 1.0 / 240;

/// A door of 20 cm at the origin, and a fan that a trigger can switch.
const std::string kDoor =
    "<component id='door_shape' type='Shape/Box' half_extents='0.1 0.1 0.1'/><component id='door' type='State/Static' shape='door_shape'/>"
    "<component id='fan' type='State/Shaft' prescribed='true' angular_velocity='0'/>";

std::string trigger(const std::string& type, const std::string& more = "", const std::string& object = "object='door'")
{
    return "<component id='t' type='Trigger/" + type + "' user='hand' " + object +
           " verb='set' target='fan' argument='angular_velocity=5' reason='the door' " + more + "/>";
}

void prepare(Scene& scene)
{
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.simulation().read_requests_with(control::component_request_reader(library(), {}));
    scene.keep_events = true;
}

/// Moves the hand to a place at once, and makes steps there.
void stay(Scene& scene, const Vec3& at, int steps, std::int64_t buttons = 0, const Quat& turned = {})
{
    for (int n = 0; n < steps; ++n)
    {
        send(scene, {std::get<std::int64_t>(scene.get("hand", "sample")) + 1, at, turned, {}, {}, 0, 0, buttons});
        scene.step();
    }
}

std::int64_t times(const Scene& scene) { return std::get<std::int64_t>(scene.get("t", "times")); }

}  // namespace

TEST_CASE("near: within the distance of the surface, and not a step later than the next")
{
    Scene scene(hand("hand", "speed_limit='1e6' position='1 0 0'") + kDoor + trigger("Near", "distance='0.3'"));
    prepare(scene);
    stay(scene, {0.4001, 0, 0}, 3);
    CHECK(times(scene) == 0);
    stay(scene, {0.3999, 0, 0}, 1);
    CHECK(times(scene) == 1);
    CHECK(scene.spin("fan") == 0);  // it is asked before the next step
    stay(scene, {0.3999, 0, 0}, 1);
    CHECK(scene.spin("fan") == 5);
    stay(scene, {0.2, 0, 0}, 100);
    CHECK(times(scene) == 1);  // once
    stay(scene, {1, 0, 0}, 1);
    stay(scene, {0.2, 0, 0}, 1);
    CHECK(times(scene) == 2);
    CHECK(scene.count("trigger.fired") == 2);
    CHECK(std::get<std::string>(scene.get("t", "by")) == "hand");
}

TEST_CASE("dwell: it must go on for that long; rearm: not again before")
{
    Scene scene(hand("hand", "speed_limit='1e6' position='1 0 0'") + kDoor + trigger("Near", "distance='0.3' dwell='0.1' rearm='0.5'"));
    prepare(scene);
    stay(scene, {0.2, 0, 0}, 23);
    CHECK(times(scene) == 0);
    stay(scene, {1, 0, 0}, 1);  // interrupted: counted anew
    stay(scene, {0.2, 0, 0}, 23);
    CHECK(times(scene) == 0);
    stay(scene, {0.2, 0, 0}, 1);
    CHECK(times(scene) == 1);
    // Away and back within 0.5 s: it is not armed again.
    stay(scene, {1, 0, 0}, 10);
    stay(scene, {0.2, 0, 0}, 60);
    CHECK(times(scene) == 1);
    stay(scene, {1, 0, 0}, 60);
    stay(scene, {0.2, 0, 0}, 24);
    CHECK(times(scene) == 2);
}

TEST_CASE("touched: by contact, also of an impact inside a step")
{
    const std::string contact =
        "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/LocalRoot' response='Response/Impulse' "
        "response.restitution='1'/>";
    const std::string ball =
        "<component id='round' type='Shape/Sphere' radius='0.1'/><component id='ball' type='State/RigidBody' mass='1' shape='round' "
        "position='0.5 0 0' linear_velocity='-10 0 0'/>";
    // The ball bounces off the hand's tip at x = 0.15, inside a step.
    Scene at_hand(hand() + "<component id='fan' type='State/Shaft' prescribed='true'/>" + ball + contact +
                  trigger("Touched", "", "object='ball'"));
    prepare(at_hand);
    stay(at_hand, {}, 30);
    CHECK(at_hand.vec("ball", "linear_velocity").x == doctest::Approx(10));
    CHECK(times(at_hand) == 1);
    CHECK(at_hand.spin("fan") == 5);
}

TEST_CASE("pointed at: the ray along the hand's x axis meets the surface within its range")
{
    Scene scene(hand("hand", "speed_limit='1e6' spin_limit='1e9' position='2 0 0'") + kDoor + trigger("PointedAt", "range='3'"));
    prepare(scene);
    stay(scene, {2, 0, 0}, 2);  // looks away
    CHECK(times(scene) == 0);
    const double edge = std::atan2(0.1, 1.9);  // to the front corner of the box
    stay(scene, {2, 0, 0}, 2, 0, exp_rotation({0, 0, 3.14159265358979 - edge - 1e-3}));
    CHECK(times(scene) == 0);
    stay(scene, {2, 0, 0}, 2, 0, exp_rotation({0, 0, 3.14159265358979 - edge + 1e-3}));
    CHECK(times(scene) == 1);
    stay(scene, {3.2, 0, 0}, 2, 0, exp_rotation({0, 0, 3.14159265358979}));  // out of range
    stay(scene, {2, 0, 0}, 2, 0, exp_rotation({0, 0, 3.14159265358979}));
    CHECK(times(scene) == 2);
}

TEST_CASE("key: all of its buttons, once per press, and only of a user who is there")
{
    Scene scene(hand() + kDoor + trigger("Key", "button='6'", ""));
    prepare(scene);
    stay(scene, {}, 2, 2);
    CHECK(times(scene) == 0);
    stay(scene, {}, 5, 7);
    CHECK(times(scene) == 1);
    stay(scene, {}, 1, 0);
    stay(scene, {}, 1, 6);
    CHECK(times(scene) == 2);
    CHECK(scene.ask(simulation::SetOperation{"hand", "present", Value(false)}).done);
    scene.step(3);
    CHECK(scene.ask(simulation::SetOperation{"hand", "present", Value(true)}).done);
    scene.step(1);
    CHECK(times(scene) == 3);
}

TEST_CASE("a trigger exchanges an interaction, and a rewind makes the same decisions again, with the same bits")
{
    const std::string text = hand("hand", "speed_limit='1e6' position='1 0 0'") + kDoor +
                             "<component id='ball' type='State/RigidBody' mass='1' inertia='1 1 1' linear_velocity='1 2 3'/>"
                             "<component id='air' type='Field/Drag' between='ball' linear='0.1'/>"
                             "<component id='t' type='Trigger/Near' user='hand' object='door' verb='set' target='air' "
                             "argument='linear=3' distance='0.3'/>";
    Scene scene(text);
    prepare(scene);
    simulation::HistoryOptions history;
    history.interval = 0.05;
    scene.simulation().history().configure(history);
    REQUIRE(scene.simulation().load(*compile_text(whole_scene(text, "dt='1/240'"))).ok());
    std::vector<std::uint64_t> hashes;
    for (int n = 0; n < 200; ++n)
    {
        stay(scene, {n < 100 ? 1.0 : 0.2, 0, 0}, 1);
        hashes.push_back(scene.hash());
    }
    CHECK(scene.real("air", "linear") == 3);
    REQUIRE(scene.simulation().rewind(150 * kTick).ok());
    CHECK(scene.hash() == hashes[149]);
    REQUIRE(scene.simulation().rewind(50 * kTick).ok());
    CHECK(scene.hash() == hashes[49]);
    CHECK(scene.real("air", "linear") == 0.1);
}

TEST_CASE("a request that cannot be made is refused by an event, and the run goes on")
{
    Scene scene(hand("hand", "position='0 0 0'") + kDoor +
                "<component id='t' type='Trigger/Near' user='hand' object='door' verb='swap' target='nothing' argument='Field/Drag'/>");
    prepare(scene);
    scene.warnings_expected = true;
    stay(scene, {}, 5);
    CHECK(times(scene) == 1);
    CHECK(scene.simulation().tick() == 5);
    std::size_t warnings = 0;
    for (const Event& e : scene.events) warnings += e.severity == Severity::Warning ? 1 : 0;
    CHECK(warnings == 1);
    Scene refused(hand() + kDoor + "<component id='t' type='Trigger/Near' user='hand' object='door' verb='shutdown'/>");
    CHECK_FALSE(refused.loaded());
}
