// The services of simulation_interfaces, as a ROS node calls them.
#include <cmath>

#include "ros/ros_client.h"

namespace plab::test
{
namespace
{

namespace msg = wire::ros;

constexpr int kUnsupported = 0, kOk = 1, kNotFound = 2, kFailed = 4;

std::set<std::string> texts_of(const auto& sequence)
{
    std::set<std::string> out;
    for (const char* text : wire::items(sequence)) out.insert(text);
    return out;
}

/// A paused server, and calls of its services.
struct Simulation
{
    explicit Simulation(const Options& options = {"--ros", "--paused"}) : server(options) {}

    template <class S>
    RosCaller<S> caller()
    {
        return RosCaller<S>(client, server.node());
    }
    int state()
    {
        auto get = caller<msg::GetSimulationState>();
        int out = -1;
        get.call({}, [&](const auto& response) { out = response.state.state; });
        return out;
    }
    std::pair<int, std::string> set_state(std::uint8_t state)
    {
        msg::SetSimulationState::Request request{};
        request.state.state = state;
        return caller<msg::SetSimulationState>().result(request);
    }
    std::set<std::string> entities()
    {
        auto get = caller<msg::GetEntities>();
        std::set<std::string> out;
        get.call({},
                 [&](const auto& response)
                 {
                     CHECK(response.result.result == kOk);
                     out = texts_of(response.entities);
                 });
        return out;
    }
    /// The state of an entity; the time of the simulation goes to `time`.
    msg::EntityState state_of(const std::string& name, int expected = kOk)
    {
        auto get = caller<msg::GetEntityState>();
        msg::GetEntityState::Request request{};
        request.entity = wire::text(name);
        msg::EntityState out{};
        get.call(request,
                 [&](const auto& response)
                 {
                     CHECK_MESSAGE(response.result.result == expected, name << ": " << response.result.error_message);
                     out = response.state, out.header.frame_id = nullptr;
                     time = response.state.header.stamp.sec + 1e-9 * response.state.header.stamp.nanosec;
                 });
        return out;
    }
    std::pair<int, std::string> spawn(const std::string& name, const std::string& text, const msg::RosPose& pose,
                                      std::string* given = nullptr, bool rename = false, const std::string& uri = "")
    {
        auto call = caller<msg::SpawnEntity>();
        msg::SpawnEntity::Request request{};
        request.name = wire::text(name), request.allow_renaming = rename;
        request.entity_resource = {wire::text(uri), wire::text(text)}, request.initial_pose.pose = pose;
        std::pair<int, std::string> out;
        call.call(request,
                  [&](const auto& response)
                  {
                      out = {response.result.result, response.result.error_message};
                      if (given != nullptr) *given = response.entity_name;
                  });
        return out;
    }
    std::pair<int, std::string> remove(const std::string& name)
    {
        msg::DeleteEntity::Request request{};
        request.entity = wire::text(name);
        return caller<msg::DeleteEntity>().result(request);
    }
    std::pair<int, std::string> step(std::uint64_t steps)
    {
        msg::StepSimulation::Request request{};
        request.steps = steps;
        return caller<msg::StepSimulation>().result(request);
    }

    RosServer server;
    RosClient client;
    double time = 0;
};

const msg::RosPose kHere{{0, 0, 0}, {0, 0, 0, 1}};

TEST_CASE("the features are those whose services are there")
{
    Simulation simulation;
    std::set<int> features;
    std::set<std::string> formats;
    simulation.caller<msg::GetSimulatorFeatures>().call({},
                                                        [&](const auto& response)
                                                        {
                                                            for (const auto f : wire::items(response.features.features)) features.insert(f);
                                                            formats = texts_of(response.features.spawn_formats);
                                                        });
    CHECK(features == std::set<int>{0, 1, 4, 5, 6, 8, 9, 10, 11, 12, 20, 23, 24, 25, 26, 31, 32, 40, 41, 44, 50});
    CHECK(formats == std::set<std::string>{"plab", "urdf", "mjcf"});
}

TEST_CASE("states of the simulation: stopped, playing, paused, and what is no change")
{
    Simulation simulation;
    CHECK(simulation.state() == 0);
    CHECK(simulation.set_state(0).first == 101);
    CHECK(simulation.set_state(1).first == kOk);
    CHECK(simulation.state() == 1);
    CHECK(simulation.set_state(1).first == 101);
    CHECK(simulation.step(1).first == kFailed);
    CHECK(simulation.set_state(2).first == kOk);
    CHECK(simulation.state() == 2);
    (void)simulation.state_of("ball");
    CHECK(simulation.time > 0);
    CHECK(simulation.set_state(0).first == kOk);
    CHECK(simulation.state() == 0);
    CHECK(simulation.state_of("ball").pose.position.z == 100);
    // Paused before the first step.
    CHECK(simulation.set_state(2).first == kOk);
    CHECK(simulation.state() == 2);
    CHECK(simulation.set_state(4).first == 103);
    CHECK(simulation.set_state(3).first == kOk);
    CHECK(simulation.server.process().wait(Milliseconds(5000)) == 0);
}

TEST_CASE("N steps are N steps, done when the response comes")
{
    Simulation simulation;
    for (const int steps : {1, 10, 120})
    {
        (void)simulation.state_of("ball");
        const double before = simulation.time;
        CHECK(simulation.step(static_cast<std::uint64_t>(steps)).first == kOk);
        CHECK(simulation.state() == 2);
        const msg::EntityState state = simulation.state_of("ball");
        CHECK(simulation.time == doctest::Approx(before + steps / 240.0).epsilon(1e-9));
        CHECK(state.pose.position.z == doctest::Approx(100 - 0.5 * 9.81 * simulation.time * simulation.time).epsilon(1e-9));
        CHECK(std::fabs(state.twist.linear.z + 9.81 * simulation.time) < 1e-7);  // the stamp has nanoseconds
    }
    CHECK(simulation.step(0).first == kFailed);
    CHECK(simulation.step(~std::uint64_t{0}).first == kFailed);
}

TEST_CASE("entities are selected by name, tags and place, and have a category and a size")
{
    Simulation simulation;
    CHECK(simulation.entities() == std::set<std::string>{"ball", "block", "ground", "arm", "cart", "rotor", "a_strange_name____"});
    auto get = simulation.caller<msg::GetEntitiesStates>();
    msg::GetEntitiesStates::Request request{};
    std::vector<msg::RosVector> ball{{0, 5, 1}, {3.5, 0, 0}};
    request.filters.filter = wire::text("^(arm|cart|ball)$"), request.filters.bounds.type = 3;
    ros::show(request.filters.bounds.points, ball);
    get.call(request,
             [&](const auto& response)
             {
                 CHECK(texts_of(response.entities) == std::set<std::string>{"arm", "cart"});
                 REQUIRE(response.states._length == 2);
                 CHECK(response.states._buffer[0].twist.angular.z == 2);
                 CHECK(std::string(response.states._buffer[0].header.frame_id) == "world");
             });
    request.filters.filter = wire::text("x{2}");
    CHECK(get.result(request).first == kUnsupported);

    msg::GetEntityInfo::Request of_ground{};
    of_ground.entity = wire::text("ground");
    simulation.caller<msg::GetEntityInfo>().call(
        of_ground,
        [&](const auto& response)
        {
            CHECK(response.info.category.category == 5);
            CHECK(texts_of(response.info.tags) == std::set<std::string>{"body", "static", "State/Static"});
        });
    msg::GetEntityBounds::Request of_block{};
    of_block.entity = wire::text("block");
    simulation.caller<msg::GetEntityBounds>().call(of_block,
                                                   [&](const auto& response)
                                                   {
                                                       REQUIRE(response.bounds.points._length == 2);
                                                       CHECK(response.bounds.points._buffer[0].x == 0.5);
                                                       CHECK(response.bounds.points._buffer[1].z == -0.125);
                                                   });
    of_block.entity = wire::text("ground");
    CHECK(simulation.caller<msg::GetEntityBounds>().result(of_block).first == kFailed);
    (void)simulation.state_of("nobody", kNotFound);
}

TEST_CASE("the state of an entity is set at once, or refused with a reason")
{
    Simulation simulation;
    auto set = simulation.caller<msg::SetEntityState>();
    msg::SetEntityState::Request request{};
    const auto with = [&](const char* entity)
    {
        request = {}, request.entity = wire::text(entity);
        request.state.pose = {{1, 2, 3}, {0, 0, std::sin(0.5), std::cos(0.5)}}, request.state.twist = {{4, 5, 6}, {0.5, 0, 0}};
        request.set_pose = request.set_twist = true;
        return &request;
    };
    CHECK(set.result(*with("ball")).first == kOk);
    msg::EntityState state = simulation.state_of("ball");
    CHECK(state.pose.position.y == 2);
    CHECK(state.pose.orientation.z == doctest::Approx(std::sin(0.5)).epsilon(1e-15));
    CHECK(state.twist.linear.z == 6);
    CHECK(state.twist.angular.x == 0.5);
    // Only what is asked for.
    with("ball"), request.set_twist = false, request.state.pose.position.x = 9;
    CHECK(set.result(request).first == kOk);
    state = simulation.state_of("ball");
    CHECK(state.pose.position.x == 9);
    CHECK(state.twist.linear.z == 6);
    with("ground")->set_twist = false;
    CHECK(set.result(request).first == kOk);
    CHECK(simulation.state_of("ground").pose.position.z == 3);

    CHECK(set.result(*with("nobody")).first == kNotFound);
    CHECK(set.result(*with("ground")).first == kFailed);
    CHECK(set.result(*with("rotor")).first == kUnsupported);
    with("ball")->state.pose.orientation = {0, 0, 0, 0};
    CHECK(set.result(request).first == 101);
    with("ball")->state.pose.position.x = std::nan("");
    CHECK(set.result(request).first == 101);
    with("ball")->state.header.frame_id = wire::text("block");
    CHECK(set.result(request).first == kUnsupported);
    with("ball")->set_pose = false, request.set_twist = false;
    CHECK(set.result(request).first == kUnsupported);
    CHECK(simulation.state_of("ball").pose.position.x == 9);
}

const char* const kBall =
    R"(<component type="State/RigidBody" mass="1"><component type="Shape/Sphere" id="${id}" radius="0.1"/></component>)";

std::string ball_text(const std::string& shape)
{
    std::string out = kBall;
    out.replace(out.find("${id}"), 5, shape);
    return out;
}

TEST_CASE("components are added under their names and at their places, and removed")
{
    Simulation simulation;
    std::string name;
    CHECK(simulation.spawn("new", ball_text("s1"), {{1, 2, 3}, {0, 0, 1, 0}}, &name).first == kOk);
    CHECK(name == "new");
    CHECK(simulation.entities().contains("new"));
    const msg::EntityState state = simulation.state_of("new");
    CHECK(state.pose.position.z == 3);
    CHECK(state.pose.orientation.z == 1);
    CHECK(simulation.spawn("new", ball_text("s2"), kHere).first == 101);
    CHECK(simulation.spawn("new", ball_text("s2"), kHere, &name, true).first == kOk);
    CHECK(name == "new_2");
    CHECK(simulation.spawn("a b", ball_text("s3"), kHere).first == 102);
    CHECK(simulation.spawn("", ball_text("s3"), kHere).first == 102);
    CHECK(simulation.spawn("x", "<sdf/>", kHere).first == 103);
    CHECK(simulation.spawn("x", "", kHere).first == 104);
    CHECK(simulation.spawn("x", "<component type='State/Nonsense'/>", kHere).first == 106);
    CHECK(simulation.spawn("x", ball_text("s3"), {{0, 0, 0}, {0, 0, 0, 0}}).first == 109);
    CHECK(simulation.spawn("x", "", kHere, nullptr, false, "file:///no/such/file").first == 106);
    CHECK(simulation.remove("new").first == kOk);
    CHECK_FALSE(simulation.entities().contains("new"));
    CHECK(simulation.remove("new").first == kNotFound);
    // The hinge refers to it.
    const auto refused = simulation.remove("arm");
    CHECK(refused.first == kFailed);
    CHECK_MESSAGE(has(refused.second, "pivot"), refused.second);
    // What is left of what was added.
    msg::ResetSimulation::Request reset{};
    reset.scope = 4;
    CHECK(simulation.caller<msg::ResetSimulation>().result(reset).first == kOk);
    CHECK_FALSE(simulation.entities().contains("new_2"));
    reset.scope = 1;
    CHECK(simulation.caller<msg::ResetSimulation>().result(reset).first == kUnsupported);
}

TEST_CASE("a robot in URDF is added twice, with its joints, each where it is wanted, and removed as a whole")
{
    Simulation simulation;
    const std::string arm = "file://" PLAB_SOURCE_DIR "/scenes/imported/arm.urdf";
    std::string name;
    CHECK(simulation.spawn("one", "", {{10, 0, 0}, {0, 0, 0, 1}}, &name, false, arm).first == kOk);
    // Turned by a quarter about z.
    CHECK(simulation.spawn("", "", kHere, &name, false, arm).first == 101);  // its own name, "arm", is that of a body
    CHECK(simulation.spawn("", "", {{20, 0, 5}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, &name, true, arm).first == kOk);
    CHECK(name == "arm_2");
    CHECK(simulation.state_of("arm_2/fore").pose.position.y == doctest::Approx(0.5));
    CHECK(simulation.state_of("arm_2/fore").pose.position.x == doctest::Approx(20));
    CHECK(simulation.entities().contains("one/upper"));
    CHECK(simulation.state_of("one/fore").pose.position.x == doctest::Approx(10.5));
    CHECK(simulation.step(240).first == kOk);
    auto joints = simulation.client.reader<msg::JointState>(msg::kJointStates);
    double shoulder = 0;
    const auto look = [&]
    {
        (void)joints.take(
            [&](const msg::JointState& s)
            {
                for (std::uint32_t i = 0; i < s.name._length; ++i)
                    if (std::string(s.name._buffer[i]) == "one/shoulder") shoulder = s.position._buffer[i];
            });
        return shoulder != 0;
    };
    CHECK(eventually(look));
    CHECK(simulation.remove("one").first == kOk);
    for (const std::string& left : simulation.entities()) CHECK_FALSE(left.starts_with("one/"));
}

TEST_CASE("a reset removes what was added, and time begins anew")
{
    Simulation simulation;
    CHECK(simulation.spawn("new", ball_text("s1"), kHere).first == kOk);
    CHECK(simulation.step(24).first == kOk);
    CHECK(simulation.caller<msg::ResetSimulation>().result({}).first == kOk);
    CHECK_FALSE(simulation.entities().contains("new"));
    CHECK(simulation.state_of("ball").pose.position.z == 100);
    CHECK(simulation.time == 0);
    CHECK(simulation.spawn("new", ball_text("s1"), kHere).first == kOk);
}

TEST_CASE("another world is loaded whole or not at all, and is stopped then")
{
    Simulation simulation;
    CHECK(simulation.set_state(1).first == kOk);
    auto load = simulation.caller<msg::LoadWorld>();
    msg::LoadWorld::Request request{};
    request.world_resource.resource_string = wire::text("<plab version='1'><component id='x' type='State/Nonsense'/></plab>");
    CHECK(load.result(request).first == 103);
    CHECK(simulation.entities().contains("ball"));
    request.world_resource.resource_string =
        wire::text("<plab version='1'><scene title='other'/><component id='only' type='State/RigidBody' mass='1' inertia='1 1 1'/></plab>");
    load.call(request,
              [](const auto& response)
              {
                  CHECK_MESSAGE(response.result.result == kOk, response.result.error_message);
                  CHECK(std::string(response.world.name) == "other");
              });
    CHECK(simulation.entities() == std::set<std::string>{"only"});
    CHECK(simulation.state() == 0);
    simulation.caller<msg::GetCurrentWorld>().call({}, [](const auto& response) { CHECK(std::string(response.world.name) == "other"); });
    request.world_resource = {wire::text("file://" PLAB_SOURCE_DIR "/scenes/imported/arm.urdf"), nullptr};
    request.fail_on_unsupported_element = true;
    CHECK(load.result(request).first == 106);
    request.fail_on_unsupported_element = false;
    CHECK(load.result(request).first == kOk);
    CHECK(simulation.entities() == std::set<std::string>{"world_2", "upper", "fore"});
}

TEST_CASE("a storm of requests costs the step nothing, and the node answers afterwards")
{
    Simulation simulation(Options{"--ros"});
    {
        auto storm = simulation.caller<msg::GetEntitiesStates>();
        for (int i = 0; i < 20000; ++i) storm.send({});
        auto strange = simulation.caller<msg::StepSimulation>();
        for (int i = 0; i < 2000; ++i) strange.send({});
    }
    CHECK(simulation.state() == 1);
    CHECK(simulation.entities().contains("ball"));
    CHECK(simulation.server.process().running());
    CHECK(simulation.server.process().errors().find("slip") == std::string::npos);
}

}  // namespace
}  // namespace plab::test
