// A run whose components decide for themselves is recorded, and is the same run again: governors of each kind, rules, and users.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/process.h"
#include "support/text.h"

namespace plab::test
{
namespace
{

constexpr Milliseconds kLong(60000);

Outcome plabd(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), program("plabd"));
    return run(std::move(arguments), kLong);
}

/// What a run had decided when it ended.
struct Decided
{
    nlohmann::json interactions, objects;
    double output(const std::string& id, const std::string& name) const
    {
        REQUIRE(interactions.contains(id));
        REQUIRE_MESSAGE(interactions[id].contains(name), interactions[id].dump());
        return interactions[id][name].get<double>();
    }
};

/// Records the scene, replays the recording, and demands the same hash after each step.
Decided recorded_and_replayed(const std::string& name, const std::string& scene, double until, std::vector<std::string> requests = {})
{
    const std::string recording = scratch_file(name + ".mcap");
    std::filesystem::remove(recording);
    std::vector<std::string> arguments{scene, "--no-bus", "--until", std::to_string(until), "--record", recording, "--out", "-"};
    for (std::string& request : requests) arguments.insert(arguments.end(), {"--set", std::move(request)});
    const Outcome ran = plabd(arguments);
    REQUIRE_MESSAGE(ran.code == 0, ran.output, ran.errors);
    const Outcome again = plabd({"--replay", recording, "--verify"});
    CHECK_MESSAGE(again.code == 0, again.output, again.errors);
    CHECK_MESSAGE(has(again.output + again.errors, "state hashes are identical"), again.output, again.errors);
    const auto json = nlohmann::json::parse(ran.output);
    return {json["interactions"], json["objects"]};
}

/// Masses on springs in a row along x, each with a solver of its own, and an eye that rides on a body past them.
std::string row_of_springs(const std::string& name, const std::string& governor)
{
    const std::string file = scratch_file(name + ".xml");
    std::ofstream out(file);
    out << "<plab version='1'><scene dt='1/120'/><component id='ball' type='Shape/Sphere' radius='0.3'/>"
           "<component id='drone' type='State/Kinematic' position='-5 -4 0' linear_velocity='6 0 0'/>"
           "<component id='eye' type='Viewer/Attached' body='drone' direction='0.3 1 0'/>";
    for (int k = 0; k < 16; ++k)
        out << "<component id='post." << k << "' type='State/Static' position='" << 2 * k << " 0 1'/><component id='bob." << k
            << "' type='State/RigidBody' mass='1' shape='ball' position='" << 2 * k << " 0.3 -0.2' linear_velocity='0 0 1' solver='engine."
            << k << "'/>"
            << "<component id='engine." << k << "' type='Solver/RungeKutta4'/>"
            << "<component id='spring." << k << "' type='Constraint/SpringDamper' a='post." << k << "' b='bob." << k
            << "' length='1' stiffness='" << 40 + 50 * k << "'/>";
    out << "<component id='weight' type='Field/Gravity' between='bob.*'/>" << governor << "</plab>";
    return file;
}

std::string governor(const std::string& type, const std::string& more)
{
    return "<component id='lod' type='Governor/" + type +
           "' watches='engine.*' every='0.1' dwell='0.2' levels='Solver/SemiImplicitEuler; Solver/RungeKutta4; "
           "Solver/DormandPrince54' " +
           more + "/>";
}

}  // namespace

TEST_CASE("governors of each kind: a recording is the same run again, with the same changes of level")
{
    const std::pair<const char*, const char*> kKinds[] = {{"Distance", "distances='4 10'"},   {"Visibility", "pixels='20 60'"},
                                                          {"Budget", "budget='100e-6'"},      {"Error", "bound='1e-4'"},
                                                          {"Error", "bound='1e-2' unit='W'"}, {"Error", "bound='0.05' unit='pixels'"}};
    int number = 0;
    for (const auto& [type, more] : kKinds)
    {
        const std::string name = std::string("replay_") + type + std::to_string(number++);
        CAPTURE(name);
        const Decided decided = recorded_and_replayed(name, row_of_springs(name, governor(type, more)), 4);
        CHECK(decided.output("lod", "changes") > 8);
    }
}

TEST_CASE("a governor is added, moved and taken away by request within a recording")
{
    const std::string scene = row_of_springs("replay_request", governor("Distance", "distances='4 10'"));
    const Decided decided = recorded_and_replayed("replay_request", scene, 4, {"120:lod.distances=1 2", "240:eye.direction=0 1 0"});
    CHECK(decided.output("lod", "changes") > 8);
}

TEST_CASE("rules: what they make is made again at the same steps")
{
    const Decided decided = recorded_and_replayed("replay_rules", scene_file("workshop.xml"), 10);
    for (const char* const id : {"bearing.axle", "key.fan", "mesh.large_gear.small_gear", "clutch.axle"})
        CHECK_MESSAGE(decided.interactions.contains(id), id);
}

TEST_CASE("users: what a hand did is done again")
{
    std::vector<std::string> moves;
    const auto move = [&](int step, const std::string& field, const std::string& value)
    { moves.push_back(std::to_string(step) + ":hand." + field + "=" + value); };
    for (int step = 0; step < 480; step += 4)
    {
        const double t = step / 240.0, z = t < 0.5 ? 1 - 0.276 * t : t < 0.8 ? 0.862 : 0.862 + 0.2 * (t - 0.8);
        move(step, "target_position", "-0.3 0.2 " + std::to_string(z));
        if (t >= 0.6) move(step, "grip", "1");
        move(step, "sample", std::to_string(step + 1));
        if (step == 0) move(step, "present", "true");
    }
    const Decided decided = recorded_and_replayed("replay_users", scene_file("hands.xml"), 2, moves);
    CHECK(decided.objects["box"]["position"][2].get<double>() > 0.8);
}

}  // namespace plab::test
