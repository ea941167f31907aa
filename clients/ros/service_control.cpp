// Services that start, stop and reset the simulation, and set the state of entities.
#include <cmath>

#include "plab/number_text.h"
#include "ros/service_desk.h"

namespace plab::ros
{
namespace
{

// simulation_interfaces/msg/SimulationState.
constexpr std::uint8_t kStopped = 0, kPlaying = 1, kPaused = 2, kQuitting = 3;
// simulation_interfaces/srv/ResetSimulation.
constexpr std::uint8_t kResetDefault = 0, kResetSpawned = 4, kResetEverything = 7, kResetAll = 255;

link::Operation verb(const char* name, std::string argument = {}) { return {name, {}, std::move(argument), {}, {}}; }

std::string joined(const std::vector<std::string>& reasons)
{
    std::string out;
    for (const std::string& reason : reasons) out += (out.empty() ? "" : "\n") + reason;
    return out;
}

std::string text_of(const Vec3& v) { return number_text(v.x) + " " + number_text(v.y) + " " + number_text(v.z); }
std::string text_of(const Quat& q) { return number_text(q.w) + " " + number_text(q.x) + " " + number_text(q.y) + " " + number_text(q.z); }

}  // namespace

void ServiceDesk::ask(std::vector<link::Operation> operations, Then then, std::optional<std::int64_t> at)
{
    link::Request request;
    request.operations = std::move(operations), request.at = at;
    requests_->send(std::move(request),
                    [then = std::move(then)](const Result<link::Reply>& reply)
                    {
                        if (!reply) return then({Code::Failed, reply.error().text()}, nullptr);
                        const bool is_done = reply->outcome == "done";
                        then(is_done ? Outcome{} : Outcome{Code::Failed, joined(reply->reasons)}, &*reply);
                    });
}

bool ServiceDesk::is_stopped() const { return server()->paused && server()->step == 0 && !is_paused_at_start_; }

void ServiceDesk::handle(const msg::GetSimulationState::Request&, Answer<msg::GetSimulationState> answer)
{
    msg::GetSimulationState::Response response{};
    if (!server()) return answer({Code::Failed, "the server has gone"});
    response.state.state = is_stopped() ? kStopped : server()->paused ? kPaused : kPlaying;
    answer.give({}, response);
}

/// Pauses, and resets to step 0.
void ServiceDesk::stop_simulation(const std::function<void(const Outcome&)>& then)
{
    ask({verb("pause")},
        [this, then](const Outcome& paused, const link::Reply*)
        {
            if (!paused.ok()) return then(paused);
            ask({verb("reset")},
                [this, then](const Outcome& reset, const link::Reply*)
                {
                    if (reset.ok()) spawned_.clear();
                    then(reset);
                });
        });
}

void ServiceDesk::handle(const msg::SetSimulationState::Request& request, Answer<msg::SetSimulationState> answer)
{
    if (!server()) return answer(Outcome{Code::Failed, "the server has gone"});
    const bool is_paused = server()->paused;
    const auto reply = [answer](const Outcome& outcome, const link::Reply*) { answer(outcome); };
    switch (request.state.state)
    {
        case kPlaying:
            if (!is_paused) return answer(Outcome{Code::AlreadyInState, "it is playing"});
            is_paused_at_start_ = false;
            return ask({verb("resume")}, reply);
        case kPaused:
            if (is_paused && !is_stopped()) return answer(Outcome{Code::AlreadyInState, "it is paused"});
            is_paused_at_start_ = true;
            return ask({verb("pause")}, reply);
        case kStopped:
            if (is_stopped()) return answer(Outcome{Code::AlreadyInState, "it is stopped"});
            is_paused_at_start_ = false;
            return stop_simulation([answer](const Outcome& outcome) { answer(outcome); });
        case kQuitting:
            // Afterwards there is nobody to answer.
            answer(Outcome{});
            return ask({verb("shutdown")}, [](const Outcome&, const link::Reply*) {});
        default:
            return answer(
                Outcome{Code::IncorrectTransition, "a server always has a world; states are stopped, playing, paused and quitting"});
    }
}

void ServiceDesk::handle(const msg::StepSimulation::Request& request, Answer<msg::StepSimulation> answer)
{
    constexpr std::uint64_t kMost = 1'000'000'000;
    if (!server() || !server()->paused) return answer(Outcome{Code::Failed, "only a paused simulation makes single steps"});
    if (request.steps == 0 || request.steps > kMost) return answer(Outcome{Code::Failed, "the number of steps must be from 1 to 1e9"});
    const auto steps = static_cast<std::int64_t>(request.steps);
    ask({verb("step", std::to_string(steps))},
        [this, answer, steps](const Outcome& begun, const link::Reply* reply)
        {
            if (!begun.ok() || reply == nullptr) return answer(begun);
            // Pausing changes nothing there, but it is answered when that step is reached.
            ask(
                {verb("pause")}, [answer](const Outcome& done, const link::Reply*) { answer(done); }, reply->step + steps);
        });
}

void ServiceDesk::handle(const msg::ResetSimulation::Request& request, Answer<msg::ResetSimulation> answer)
{
    if (request.scope == kResetSpawned)
    {
        std::vector<link::Operation> operations;
        for (const auto& [id, body] : spawned_) operations.push_back({"remove", id, {}, {}, {}});
        if (operations.empty()) return answer(Outcome{});
        return ask(std::move(operations),
                   [this, answer](const Outcome& outcome, const link::Reply*)
                   {
                       if (outcome.ok()) spawned_.clear();
                       answer(outcome);
                   });
    }
    if (request.scope != kResetDefault && request.scope != kResetEverything && request.scope != kResetAll)
        return answer(Outcome{Code::Unsupported, "time and state are reset together with what was spawned, or not at all"});
    ask({verb("reset")},
        [this, answer](const Outcome& outcome, const link::Reply*)
        {
            if (outcome.ok()) spawned_.clear(), is_paused_at_start_ = false;
            answer(outcome);
        });
}

namespace
{

/// Unit length within rounding of 32-bit numbers; made exact.
bool read_rotation(Quat& q)
{
    constexpr double kTolerance = 1e-3;
    if (!is_finite(q) || std::abs(norm(q) - 1) > kTolerance) return false;
    q = normalized(q);
    return true;
}

}  // namespace

Outcome ServiceDesk::prepare_state(const msg::SetEntityState::Request& request, link::Operation& out) const
{
    const std::string name = ros::text_of(request.entity);
    const SceneFrame* const frame = find_entity(name);
    if (frame == nullptr) return {Code::NotFound, "there is no entity '" + name + "'"};
    if (frame->is_shaft) return {Code::Unsupported, "a shaft has no pose of its own: its angle is a state of joint_states"};
    const std::string in = ros::text_of(request.state.header.frame_id);
    if (!in.empty() && in != kWorldFrame) return {Code::Unsupported, "states are set in the frame world, not in '" + in + "'"};
    if (!request.set_pose && !request.set_twist)
        return {Code::Unsupported, request.set_acceleration ? "accelerations follow from forces" : "nothing is to be set"};
    out.verb = "set", out.target = frame->id;
    if (request.set_pose)
    {
        Pose pose = pose_from(request.state.pose);
        if (!is_finite(pose.p) || !read_rotation(pose.q))
            return {Code::InvalidPose, "the pose must be finite, and its quaternion of unit length"};
        out.values.push_back({"position", text_of(pose.p)}), out.values.push_back({"orientation", text_of(pose.q)});
    }
    if (!request.set_twist) return {};
    const Vec3 v = vector_from(request.state.twist.linear), w = vector_from(request.state.twist.angular);
    if (!is_finite(v) || !is_finite(w)) return {Code::Failed, "the twist must be finite"};
    const bool moves = !(v == Vec3{}) || !(w == Vec3{});
    if (frame->is_static && moves) return {Code::Failed, "'" + name + "' is static: it has no velocity"};
    if (!frame->is_static) out.values.push_back({"linear_velocity", text_of(v)}), out.values.push_back({"angular_velocity", text_of(w)});
    return {};
}

void ServiceDesk::handle(const msg::SetEntityState::Request& request, Answer<msg::SetEntityState> answer)
{
    link::Operation operation;
    if (const Outcome prepared = prepare_state(request, operation); !prepared.ok()) return answer(prepared);
    if (operation.values.empty()) return answer(Outcome{});
    ask({operation}, [answer](const Outcome& outcome, const link::Reply*) { answer(outcome); });
}

}  // namespace plab::ros
