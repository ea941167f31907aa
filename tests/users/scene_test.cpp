// scenes/hands.xml: each thing in the room does what its comment says.
#include "control/component_requests.h"
#include "plab/rotation.h"
#include "users/hands.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// A user who walks from place to place.
class Person
{
public:
    Person(Scene& scene, std::string id) : scene_(scene), id_(std::move(id)), at_(scene.vec(id_, "position")) {}
    void go(const Vec3& to, double seconds, double grip = 0, const Quat& turned = {}, std::int64_t buttons = 0)
    {
        const auto steps = static_cast<int>(std::lround(seconds * 240));
        const Vec3 from = at_, v = (to - from) / seconds;
        for (int n = 0; n < steps; ++n)
        {
            at_ = from + (static_cast<double>(n) / steps) * (to - from);
            send(scene_, {++number_, at_, turned, v, {}, grip, 0, buttons}, id_);
            scene_.step();
        }
        at_ = to;
        send(scene_, {++number_, at_, turned, {}, {}, grip, 0, buttons}, id_);
        scene_.step();
    }

private:
    Scene& scene_;
    std::string id_;
    Vec3 at_;
    std::int64_t number_ = 0;
};

}  // namespace

TEST_CASE("the room of hands.xml: grab, push, and four triggers")
{
    Scene scene = Scene::file("scenes/hands.xml");
    REQUIRE_MESSAGE(scene.loaded(), scene.error());
    scene.simulation().read_requests_with(control::component_request_reader(library(), {}));
    scene.keep_events = true;
    Person hand(scene, "hand"), left(scene, "left");
    scene.run(0.2);

    // Grabs the box from the table and puts it 20 cm higher.
    hand.go({-0.3, 0.2, 0.95}, 0.5);
    hand.go({-0.3, 0.2, 0.862}, 0.3);
    hand.go({-0.3, 0.2, 0.862}, 0.1, 1);
    CHECK(std::get<std::string>(scene.get("grab", "held")) == "box");
    hand.go({-0.3, 0.2, 1.062}, 0.5, 1);
    hand.go({-0.3, 0.2, 1.062}, 0.5, 1);
    CHECK(std::fabs(scene.vec("box", "position").z - 0.96) < 0.01);
    hand.go({-0.3, 0.2, 1.062}, 0.05, 0);
    CHECK(std::get<std::string>(scene.get("grab", "held")).empty());

    // The glove pushes the crate of 20 kg, with no more than its spring has.
    left.go({0.9, -0.5, 0.3}, 1);
    const double before = scene.vec("crate", "position").x;
    left.go({0.9, 0, 0.3}, 0.5);
    left.go({1.3, 0, 0.3}, 1);
    CHECK(length(scene.vec("wear", "force")) <= 60 + 1e-9);
    CHECK(scene.vec("crate", "position").x == doctest::Approx(before).epsilon(0.01));  // 0.6 x 20 kg x 9.81 = 118 N hold it
    CHECK(length(scene.vec("left", "force")) == doctest::Approx(60).epsilon(0.01));

    // The button starts the fan.
    hand.go({-0.9, 1, 1}, 1);
    CHECK(scene.spin("fan") == 0);
    hand.go({-0.9, 1.365, 1}, 1);
    hand.go({-0.9, 1.365, 1}, 0.05);
    CHECK(scene.vec("button", "position").y > 1.424);  // it yields by 5 mm
    CHECK(scene.spin("fan") == 12);

    // The lamp is lit by pointing at it.
    CHECK(scene.vec("lamp", "color") == Vec3{0.3, 0.3, 0.2});
    const Vec3 to_lamp = normalized(Vec3{0.9, 1.3, 1.9} - Vec3{0, 0, 1});
    const Vec3 axis = normalized(cross({1, 0, 0}, to_lamp));
    hand.go({0, 0, 1}, 1);
    hand.go({0, 0, 1}, 0.1, 0, exp_rotation(std::acos(to_lamp.x) * axis));
    CHECK(scene.vec("lamp", "color") == Vec3{1, 1, 0.6});

    // The key throws the ball.
    const double rests = scene.vec("ball", "position").z;
    hand.go({0, 0, 1}, 0.1, 0, {}, 1);
    CHECK(scene.vec("ball", "position").z > rests + 0.1);

    // The door opens for who comes near.
    CHECK(scene.real("closer", "rest") == 0);
    left.go({1.6, 0.3, 1}, 1);
    left.go({1.6, 0.3, 1}, 0.3);
    CHECK(scene.real("closer", "rest") == 1.4);
    CHECK(scene.count("trigger.fired") == 4);
}
