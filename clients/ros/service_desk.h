/// The services of simulation_interfaces.
#pragma once

#include <deque>
#include <tuple>

#include "link/requests.h"
#include "ros/budget.h"
#include "ros/entities.h"
#include "ros/node.h"
#include "ros/resource.h"

namespace plab::ros
{

/// What services read of the bridge. All of it must outlive the desk.
struct DeskView
{
    link::Catalogue* catalogue = nullptr;
    const SceneFrames* frames = nullptr;
    NameTable* names = nullptr;
    std::function<const plab_v2_Frame*()> newest_frame;  ///< null until there is one; valid until the next call
    std::function<void()> follow_catalogue;              ///< takes what has arrived, so that frames and names are those of now
};

/// How one request is answered, at once or later. Must not outlive the desk.
template <class OneService>
struct Answer
{
    ServiceServer<OneService>* server = nullptr;
    ServiceCaller caller;

    void operator()(typename OneService::Response& response) const { server->respond(caller, response); }
    void operator()(const Outcome& outcome) const
    {
        typename OneService::Response response{};
        give(outcome, response);
    }
    void give(const Outcome& outcome, typename OneService::Response& response) const
    {
        response.result = {static_cast<std::uint8_t>(outcome.code), wire::text(outcome.text)};
        (*this)(response);
    }
};

class ServiceDesk
{
public:
    using Clock = std::chrono::steady_clock;

    static Result<std::unique_ptr<ServiceDesk>> open(Node& node, const Converter& converter);

    /// There is a server to serve for.
    void begin(const DeskView& view, link::Requests& requests);
    /// It has gone: requests are left until there is one again.
    void end();

    /// Answers what has arrived and can be answered, bounded in number and bytes.
    void pass(Clock::time_point now);
    /// Whether somebody waits for a frame.
    bool wants_frame() const { return !waiting_.empty(); }
    /// Earliest time at which pass() reads requests again.
    Clock::time_point next() const { return replies_.next(); }
    /// Lets a waitset trigger when a request arrives.
    void attach_to(const wire::Entity& waitset) const;

private:
    template <class S>
    using End = std::unique_ptr<ServiceServer<S>>;
    using Ends =
        std::tuple<End<msg::GetSimulatorFeatures>, End<msg::GetSimulationState>, End<msg::SetSimulationState>, End<msg::StepSimulation>,
                   End<msg::ResetSimulation>, End<msg::GetEntities>, End<msg::GetEntitiesStates>, End<msg::GetEntityState>,
                   End<msg::SetEntityState>, End<msg::GetEntityInfo>, End<msg::GetEntityBounds>, End<msg::SpawnEntity>,
                   End<msg::SpawnEntities>, End<msg::DeleteEntity>, End<msg::LoadWorld>, End<msg::GetCurrentWorld>>;
    using Then = std::function<void(const Outcome&, const link::Reply*)>;
    /// A request that needs a frame.
    struct Waiting
    {
        std::function<void(bool has_frame)> answer;
        Clock::time_point until;
    };
    struct PreparedSpawn
    {
        std::string id;    ///< of the component or group
        std::string body;  ///< id of its first body, as far as it is known
        std::string blueprint;
    };

    // What is asked.
    void handle(const msg::GetSimulatorFeatures::Request&, Answer<msg::GetSimulatorFeatures> answer);
    void handle(const msg::GetSimulationState::Request&, Answer<msg::GetSimulationState> answer);
    void handle(const msg::SetSimulationState::Request& request, Answer<msg::SetSimulationState> answer);
    void handle(const msg::StepSimulation::Request& request, Answer<msg::StepSimulation> answer);
    void handle(const msg::ResetSimulation::Request& request, Answer<msg::ResetSimulation> answer);
    void handle(const msg::GetEntities::Request& request, Answer<msg::GetEntities> answer);
    void handle(const msg::GetEntitiesStates::Request& request, Answer<msg::GetEntitiesStates> answer);
    void handle(const msg::GetEntityState::Request& request, Answer<msg::GetEntityState> answer);
    void handle(const msg::SetEntityState::Request& request, Answer<msg::SetEntityState> answer);
    void handle(const msg::GetEntityInfo::Request& request, Answer<msg::GetEntityInfo> answer);
    void handle(const msg::GetEntityBounds::Request& request, Answer<msg::GetEntityBounds> answer);
    void handle(const msg::SpawnEntity::Request& request, Answer<msg::SpawnEntity> answer);
    void handle(const msg::SpawnEntities::Request& request, Answer<msg::SpawnEntities> answer);
    void handle(const msg::DeleteEntity::Request& request, Answer<msg::DeleteEntity> answer);
    void handle(const msg::LoadWorld::Request& request, Answer<msg::LoadWorld> answer);
    void handle(const msg::GetCurrentWorld::Request&, Answer<msg::GetCurrentWorld> answer);

    // What is done for it.
    void ask(std::vector<link::Operation> operations, Then then, std::optional<std::int64_t> at = {});
    void with_frame(std::function<void(bool has_frame)> answer);
    void stop_simulation(const std::function<void(const Outcome&)>& then);
    const SceneFrame* find_entity(const std::string& name) const;
    std::vector<const SceneFrame*> select(const EntityFilter& filter) const;
    Outcome prepare_state(const msg::SetEntityState::Request& request, link::Operation& out) const;
    Outcome place_of(const msg::Spawn& spawn, Pose& out) const;
    Outcome name_of(const msg::Spawn& spawn, const ReadResource& resource, std::string& out) const;
    Outcome prepare_spawn(const msg::Spawn& spawn, PreparedSpawn& out) const;
    void spawn(const msg::Spawn& spawn, const std::function<void(const Outcome&, const std::string& name)>& then);
    void note_spawned(const PreparedSpawn& prepared, const std::set<std::string>& before);
    void describe_world(simulation_interfaces_msg_dds__WorldResource_& out, wire::SequenceMemory& memory) const;
    const std::optional<link::ServerInfo>& server() const { return view_.catalogue->now().server; }
    bool is_stopped() const;

    Converter converter_;
    Ends ends_;
    DeskView view_;
    link::Requests* requests_ = nullptr;
    Budget replies_{1e6};
    std::deque<Waiting> waiting_;
    bool is_paused_at_start_ = false;             ///< paused at step 0, and not stopped
    std::map<std::string, std::string> spawned_;  ///< what was added here: id of the component or group, and of its first body
};

}  // namespace plab::ros
