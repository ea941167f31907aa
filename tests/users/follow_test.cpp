// State/User: a body that follows samples, pushes, and knows the force on it.
#include "plab/rotation.h"
#include "support/gravity.h"
#include "support/ground.h"
#include "users/hands.h"

using namespace plab;
using namespace plab::test;

namespace
{

constexpr double kFrame = 1.0 / 240;

const char* const kContact =
    "<component id='contact' type='CDetection/ODE' between='*' resolution='Resolution/None' response='Response/Rows' "
    "response.friction='0.5'/>";

std::string box(const std::string& id, const std::string& position)
{
    return "<component id='" + id + "_shape' type='Shape/Box' half_extents='0.1 0.1 0.1'/><component id='" + id +
           "' type='State/RigidBody' mass='2' shape='" + id + "_shape' position='" + position + "'/>";
}

/// The hand moves at 0.5 m/s along x for 120 steps. Returns the impulse that it felt, N s along x.
double push(Scene& scene)
{
    double impulse = 0;
    for (int n = 1; n <= 120; ++n)
    {
        send(scene, {n, {0.5 * (n - 1) * kFrame, 0, 0}, {}, {0.5, 0, 0}});
        scene.step();
        impulse += kFrame * scene.vec("hand", "force").x;
    }
    return impulse;
}

}  // namespace

TEST_CASE("a sample is extrapolated to the end of each step, from its age, and no longer than allowed")
{
    Scene scene(hand("hand", "extrapolation='0.05'"));
    scene.keep_events = true;
    const Sample s{1, {0.01, 0.02, 0.03}, exp_rotation({0, 0.1, 0}), {0.5, -0.2, 0.1}, {0, 0, 2}, 0, 0.003};
    send(scene, s);
    for (int n = 1; n <= 40; ++n)
    {
        scene.step();
        const double T = std::fmin(0.003 + n * kFrame, 0.05);
        CHECK(distance(scene.vec("hand", "position"), s.position + T * s.velocity) < 1e-15);
        CHECK(attitude_error(scene.quat("hand", "orientation"), exp_rotation(T * s.spin) * s.orientation) < 1e-7);
    }
    CHECK(scene.count("user.lost") == 1);
    CHECK(scene.vec("hand", "linear_velocity") == Vec3{});
    send(scene, {2, {0.1, 0, 0}});
    scene.step();
    CHECK(scene.count("user.found") == 1);
    CHECK(distance(scene.vec("hand", "position"), {0.1, 0, 0}) < 1e-15);
}

TEST_CASE("samples at 1 kHz and steps at 240 Hz: the hand is where the newest sample leads")
{
    Scene scene(hand());
    for (int n = 1; n <= 240; ++n)
    {
        // Of the samples since the last boundary the newest counts; it is t - t_sample old.
        const double t = (n - 1) * kFrame, newest = std::floor(t * 1000) / 1000;
        send(scene, {static_cast<std::int64_t>(newest * 1000) + 1, {newest, 0, 0}, {}, {1, 0, 0}, {}, 0, t - newest});
        scene.step();
        CHECK(std::fabs(scene.vec("hand", "position").x - n * kFrame) < 1e-12);
    }
}

TEST_CASE("a jump is followed at the speed limit, and the lag is known")
{
    Scene scene(hand("hand", "speed_limit='2'"));
    send(scene, {1, {1, 0, 0}});
    scene.step();
    CHECK(near(scene.vec("hand", "position").x, 2 * kFrame, 1e-15));
    CHECK(near(scene.real("hand", "lag"), 1 - 2 * kFrame, 1e-15));
}

TEST_CASE("without samples the user is lost, then gone; without presence it stands still")
{
    Scene scene(hand("hand", "patience='0.5'"));
    scene.keep_events = true;
    send(scene, {1, {}, {}, {1, 0, 0}});
    scene.run(0.45);
    CHECK(std::get<bool>(scene.get("hand", "lost")));
    CHECK_FALSE(std::get<bool>(scene.get("hand", "gone")));
    scene.run(0.6);
    CHECK(std::get<bool>(scene.get("hand", "gone")));
    CHECK(scene.count("user.gone") == 1);
    Sample away{2, {5, 0, 0}};
    away.present = false;
    send(scene, away);
    const Vec3 before = scene.vec("hand", "position");
    scene.run(1);
    CHECK(scene.vec("hand", "position") == before);
}

TEST_CASE("a hand pushes as any prescribed body does: what it pushes gets its speed, and the work is that of its force")
{
    // 2 kg in front of a hand that moves at 0.5 m/s, in free space: a plastic impact, J = m v.
    Scene scene(hand() + box("box", "0.2 0 0") + kContact);
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    const double impulse = push(scene);
    CHECK(near(scene.vec("box", "linear_velocity").x, 0.5, 1e-9));
    CHECK(std::fabs(impulse + 2 * 0.5) < 1e-9);
}

TEST_CASE("the hand under a box carries its weight, and feels where it presses")
{
    // The slab is the hand; the box stands 0.3 m beside its origin.
    const std::string slab =
        "<component id='slab' type='Shape/Box' half_extents='1 1 0.05'/><component id='hand' type='State/User' shape='slab'/>";
    const std::string spring = "<component id='contact' type='CDetection/ODE' between='*' response='Response/Penalty'/>";
    for (const std::string& contact : {std::string(kContact), spring})
    {
        CAPTURE(contact);
        Scene scene(slab + box("box", "0.3 0 0.15") + kGravity + contact);
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        for (int n = 1; n <= 960; ++n) send(scene, {n, {}}), scene.step();
        CHECK(distance(scene.vec("hand", "force"), {0, 0, -2 * kG}) < 1e-4);
        // r x f with r = (0.3, 0, *): torque about y is 0.3 m g.
        CHECK(distance(scene.vec("hand", "torque"), {0, 0.3 * 2 * kG, 0}) < 1e-3);
    }
}

TEST_CASE("a hand in impacts inside a step, and at its end, feels the impulse that the other body gets")
{
    for (const std::string response : {"resolution='Resolution/LocalRoot' response='Response/Impulse' response.restitution='0.5'",
                                       "resolution='Resolution/LocalRoot' response='Response/Rows' response.restitution='0.5'",
                                       "resolution='Resolution/None' response='Response/Rows' response.restitution='0.5'"})
    {
        CAPTURE(response);
        Scene scene(hand() + box("box", "0.2 0 0") + "<component id='contact' type='CDetection/ODE' between='*' " + response + "/>");
        REQUIRE_MESSAGE(scene.loaded(), scene.error());
        const double impulse = push(scene);
        const double gained = 2 * scene.vec("box", "linear_velocity").x;
        CHECK(gained > 0.9);
        CHECK(std::fabs(impulse + gained) < 1e-9);
    }
}
