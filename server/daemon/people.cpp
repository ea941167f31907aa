#include "daemon/people.h"

#include <algorithm>

#include "model/values.h"

namespace plab::daemon
{
namespace
{

/// The operations of a request are text, as the journal has them: a replay reads the same.
class Sets
{
public:
    explicit Sets(const std::string& component) { words_.verb = "set", words_.target = component; }
    void add(const char* name, const Value& value) { words_.values.push_back({name, model::format_value(value)}); }
    People::Ask ask() &&
    {
        People::Ask out;
        for (const wire::NamedText& v : words_.values)
            out.request.operations.push_back(simulation::SetOperation{words_.target, v.name, v.text});
        out.words = std::move(words_);
        return out;
    }

private:
    wire::Operation words_;
};

const std::string& wanted_of(const wire::UserSample& s) { return s.user; }
const std::string& wanted_of(const wire::ViewerSample& s) { return s.viewer; }

/// `age`: s of simulated time since the sample was sent.
People::Ask ask_of(const wire::UserSample& s, const simulation::Simulation& simulation, const std::string& id, bool gone, double age)
{
    const world::World& world = simulation.world();
    Sets sets(id);
    sets.add("present", Value(!gone));
    if (gone)
    {
        sets.add("grip", Value(0.0)), sets.add("buttons", Value(std::int64_t{0}));
        return std::move(sets).ask();
    }
    // Numbers of another client may be any: the component needs one that differs from the last.
    const auto last = std::get<std::int64_t>(world.get(world.find(id), "sample"));
    sets.add("sample", Value(last + 1)), sets.add("sample_age", Value(age));
    sets.add("target_position", Value(s.position)), sets.add("target_orientation", Value(s.orientation));
    sets.add("target_linear_velocity", Value(s.linear_velocity)), sets.add("target_angular_velocity", Value(s.angular_velocity));
    sets.add("grip", Value(s.grip)), sets.add("buttons", Value(static_cast<std::int64_t>(s.buttons)));
    return std::move(sets).ask();
}

People::Ask ask_of(const wire::ViewerSample& s, const simulation::Simulation&, const std::string& id, bool gone, double)
{
    Sets sets(id);
    if (gone)
    {
        sets.add("velocity", Value(Vec3{}));
        return std::move(sets).ask();
    }
    sets.add("position", Value(s.position)), sets.add("direction", Value(s.direction)), sets.add("up", Value(s.up));
    sets.add("velocity", Value(s.velocity)), sets.add("field_of_view", Value(s.field_of_view));
    sets.add("width", Value(s.width)), sets.add("height", Value(s.height));
    return std::move(sets).ask();
}

/// Samples since the last one that counted, which did not count: replaced by newer ones here, in the bus, or in the client, or lost on
/// the way. A client counts its samples; one that begins anew, or counts otherwise, is known only as far as samples have arrived.
template <class Sample>
std::uint64_t skipped_before(std::uint64_t number, std::uint64_t last, const publish::ReceivedSample<Sample>& received)
{
    const std::uint64_t missing = last > 0 && number > last ? number - last - 1 : 0;
    return received.gone ? received.skipped : std::max(missing, received.skipped);
}

bool has_inputs(const model::ComponentType& type, std::initializer_list<const char*> names)
{
    return std::all_of(names.begin(), names.end(),
                       [&](const char* name)
                       {
                           const Field* field = type.schema.find_field(name);
                           return field && field->is_input;
                       });
}

}  // namespace

void People::follow_structure()
{
    if (known_ && run_ == simulation_->run() && revision_ == simulation_->revision()) return;
    known_ = true, run_ = simulation_->run(), revision_ = simulation_->revision();
    user_components_.clear(), viewer_components_.clear();
    const world::World& world = simulation_->world();
    for (const std::uint32_t i : world.in_id_order())
    {
        const model::ComponentType* type = world.type_of(i);
        if (!type) continue;
        if (has_inputs(*type, {"sample", "target_position", "grip"})) user_components_.push_back(world.id_of(i));
        if (has_inputs(*type, {"position", "direction", "field_of_view"})) viewer_components_.push_back(world.id_of(i));
    }
}

bool People::is_taken(const Clients& clients, const std::string& component, const wire::ClientId& except) const
{
    return std::any_of(clients.begin(), clients.end(), [&](const auto& c) { return c.first != except && c.second.component == component; });
}

/// The component that a client may move; "" and why not.
std::string People::choose(const Clients& clients, const std::vector<std::string>& there, const Client& client, const wire::ClientId& id,
                           std::string& why_not) const
{
    const auto exists = [&](const std::string& component) { return std::find(there.begin(), there.end(), component) != there.end(); };
    if (!client.component.empty() && exists(client.component)) return client.component;
    if (!client.wanted.empty())
    {
        if (!exists(client.wanted))
            why_not = "no such component, or its type follows no samples";
        else if (is_taken(clients, client.wanted, id))
            why_not = "another client moves it";
        return why_not.empty() ? client.wanted : std::string();
    }
    for (const std::string& component : there)
        if (!is_taken(clients, component, id)) return component;
    why_not = there.empty() ? "the scene has no such component" : "other clients move all of them";
    return {};
}

template <class Sample>
void People::move_one(Clients& clients, const std::vector<std::string>& there, const publish::ReceivedSample<Sample>& received,
                      std::int64_t now_ns, const CarryOut& carry_out, const Tell& tell)
{
    constexpr bool kIsUser = std::is_same_v<Sample, wire::UserSample>;
    const Sample& sample = received.sample;
    if (received.gone && !clients.contains(sample.client)) return;
    Client& client = clients[sample.client];
    // One component for each client: what it moves at present has to be let go before it takes another.
    const bool is_other = !client.component.empty() && wanted_of(sample) != client.wanted;
    if (is_other && received.gone) return;
    client.heard_ns = now_ns, client.skipped += skipped_before(sample.number, client.number, received);
    client.number = sample.number;
    const std::int64_t sent_ns = received.gone ? received.arrived_ns : client.clock.sent(sample.stamp_ns, received.arrived_ns);
    std::string why_not = is_other ? "the client moves " + client.component + " already" : std::string();
    if (!is_other)
    {
        client.wanted = wanted_of(sample);
        client.component = choose(clients, there, client, sample.client, why_not);
    }
    if (why_not.empty())
    {
        const double rate = simulation_->rate();
        const double age = std::clamp(1e-9 * static_cast<double>(now_ns - sent_ns) * rate, 0.0, 1.0);
        Ask ask = ask_of(sample, *simulation_, client.component, received.gone, age);
        ask.is_user = kIsUser, ask.client = sample.client, ask.number = sample.number;
        const simulation::Reply reply = carry_out(ask);
        if (!reply.done) why_not = reply.errors.empty() ? "refused" : reply.errors.front().text();
    }
    if (why_not != client.last_complaint && !why_not.empty())
        tell(kIsUser ? "user.refused" : "viewer.refused", is_other ? wanted_of(sample) : client.wanted, why_not);
    client.last_complaint = why_not;
    if (received.gone) clients.erase(sample.client);
}

/// Their components may be moved by others again. That they stand still and let go by themselves is in the scene (State/User, patience).
void People::forget_silent(Clients& clients, std::int64_t now_ns) const
{
    std::erase_if(clients, [&](const auto& c) { return now_ns - c.second.heard_ns > kSilence; });
}

void People::move(const publish::ReceivedPeople& people, std::int64_t now_ns, const CarryOut& carry_out, const Tell& tell)
{
    if (people.users.empty() && people.viewers.empty() && users_.empty() && viewers_.empty()) return;
    follow_structure();
    forget_silent(users_, now_ns), forget_silent(viewers_, now_ns);
    for (const auto& received : people.users) move_one(users_, user_components_, received, now_ns, carry_out, tell);
    for (const auto& received : people.viewers) move_one(viewers_, viewer_components_, received, now_ns, carry_out, tell);
}

std::vector<wire::UserForce> People::forces()
{
    follow_structure();
    std::vector<wire::UserForce> out;
    const world::World& world = simulation_->world();
    for (const std::string& id : user_components_)
    {
        const std::uint32_t i = world.find(id);
        const Value force = world.get(i, "force"), torque = world.get(i, "torque");
        if (!std::holds_alternative<Vec3>(force) || !std::holds_alternative<Vec3>(torque)) continue;
        wire::UserForce& entry = out.emplace_back();
        entry.user = id, entry.force = std::get<Vec3>(force), entry.torque = std::get<Vec3>(torque);
        const auto by = std::find_if(users_.begin(), users_.end(), [&](const auto& c) { return c.second.component == id; });
        if (by != users_.end()) entry.client = by->first, entry.number = by->second.number, entry.skipped = by->second.skipped;
    }
    return out;
}

}  // namespace plab::daemon
