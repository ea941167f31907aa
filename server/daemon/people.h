/// The people in the scene: the samples that clients send about users and viewers become inputs of components, before a step.
///
/// A client moves one user and one viewer; a component is moved by one client. The first come has it, until it is gone: its instance is
/// disposed of, or nothing has come for kSilence. Which components they are follows from their fields: a user's has the inputs `sample` and
/// `target_position`, a viewer's `position` and `direction`.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "daemon/client_clock.h"
#include "publish/records.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

class People
{
public:
    static constexpr std::int64_t kSilence = 5'000'000'000;  ///< ns of real time

    explicit People(simulation::Simulation& simulation) : simulation_(&simulation) {}

    /// What a sample asks for, as a request of inputs alone, and as the words of the journal.
    struct Ask
    {
        bool is_user = false;
        wire::ClientId client{};
        std::uint64_t number = 0;
        simulation::Request request;
        wire::Operation words;
    };
    /// Turns the newest samples into requests, which carry_out(ask) makes; it returns the reply.
    using CarryOut = std::function<simulation::Reply(const Ask&)>;
    /// Tells of a client that cannot move what it wants to, once: kind of event, component and message.
    using Tell = std::function<void(const char* kind, const std::string& component, const std::string& message)>;
    void move(const publish::ReceivedPeople& people, std::int64_t now_ns, const CarryOut& carry_out, const Tell& tell);

    /// The forces on the users of the scene after a step; empty if there are none.
    std::vector<wire::UserForce> forces();

private:
    struct Client
    {
        std::string wanted;     ///< as in its samples
        std::string component;  ///< that it moves; "": none
        std::uint64_t number = 0, skipped = 0;
        std::int64_t heard_ns = 0;
        ClientClock clock;
        std::string last_complaint;
    };
    using Clients = std::map<wire::ClientId, Client>;

    void follow_structure();
    bool is_taken(const Clients& clients, const std::string& component, const wire::ClientId& except) const;
    std::string choose(const Clients& clients, const std::vector<std::string>& there, const Client& client, const wire::ClientId& id,
                       std::string& why_not) const;
    template <class Sample>
    void move_one(Clients& clients, const std::vector<std::string>& there, const publish::ReceivedSample<Sample>& received,
                  std::int64_t now_ns, const CarryOut& carry_out, const Tell& tell);
    void forget_silent(Clients& clients, std::int64_t now_ns) const;

    simulation::Simulation* simulation_;
    Clients users_, viewers_;
    std::uint64_t run_ = 0, revision_ = 0;
    bool known_ = false;
    std::vector<std::string> user_components_, viewer_components_;  ///< ids of the present structure, in their order
};

}  // namespace plab::daemon
