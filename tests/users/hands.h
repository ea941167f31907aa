/// A hand in a scene, and the requests that move it.
#pragma once

#include <string>
#include <vector>

#include "support/scene.h"
#include "support/text.h"

namespace plab::test
{

/// A hand with a round tip of 5 cm.
inline std::string hand(const std::string& id = "hand", const std::string& more = "")
{
    return "<component id='" + id + "_tip' type='Shape/Sphere' radius='0.05'/><component id='" + id + "' type='State/User' shape='" + id +
           "_tip' " + more + "/>";
}

/// What a sample of a user sets.
struct Sample
{
    std::int64_t number = 1;
    Vec3 position = {};
    Quat orientation = {};
    Vec3 velocity = {}, spin = {};
    double grip = 0, age = 0;
    std::int64_t buttons = 0;
    bool present = true;
};

inline std::vector<simulation::Operation> sets_of(const Sample& s, const std::string& id = "hand")
{
    std::vector<simulation::Operation> out;
    const auto set = [&](const char* name, Value value) { out.push_back(simulation::SetOperation{id, name, std::move(value)}); };
    set("present", s.present), set("sample", s.number), set("sample_age", s.age), set("target_position", s.position);
    set("target_orientation", s.orientation), set("target_linear_velocity", s.velocity), set("target_angular_velocity", s.spin);
    set("grip", s.grip), set("buttons", s.buttons);
    return out;
}

inline void send(Scene& scene, const Sample& sample, const std::string& id = "hand")
{
    const auto reply = scene.ask_all(sets_of(sample, id));
    CHECK_MESSAGE(reply.done, first_error(reply.errors));
}

}  // namespace plab::test
