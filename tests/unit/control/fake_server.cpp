#include "fake_server.h"

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <tuple>

#include "idl/frame_updates.h"

namespace plab::test
{
namespace
{

constexpr double kDt = 1.0 / 240;

/// DDS only reads what it is given, though its types have no const.
char* text(const char* t) { return const_cast<char*>(t); }
char* text(const std::string& t) { return text(t.c_str()); }

template <class T>
T need(Result<T> result)
{
    if (!result) throw std::runtime_error(result.error().text());
    return result.take();
}

template <class Sequence, class T>
Sequence sequence(std::vector<T>& items)
{
    const auto count = static_cast<std::uint32_t>(items.size());
    return {count, count, items.data(), false};
}

plab_v2_Parameter parameter(const char* name, const char* value, const char* unit, const char* kind)
{
    return {text(name), text(value), text(unit), text(kind)};
}

plab_v2_FieldInfo field(const char* name, const char* unit, const char* fallback, const char* rule, const char* doc)
{
    return {text(name), text("param"), text("real"), text(unit), text(fallback), false, text(rule), text(doc)};
}

}  // namespace

struct FakeServer::Ends
{
    wire::Participant participant;
    wire::Entity publisher, subscriber;
    wire::DataWriter<plab_v2_Server> server;
    wire::DataWriter<plab_v2_Scene> scene;
    wire::DataWriter<plab_v2_SceneObject> objects;
    wire::DataWriter<plab_v2_Shape> shapes;
    wire::DataWriter<plab_v2_Interaction> interactions;
    wire::DataWriter<plab_v2_Type> types;
    wire::FrameWriter states;
    wire::DataWriter<plab_v2_Collisions> collisions;
    wire::DataWriter<plab_v2_ContactForces> contacts;
    wire::DataWriter<plab_v2_Events> events;
    wire::DataWriter<plab_v2_Metrics> metrics;
    wire::DataWriter<plab_v2_Reply> replies;
    wire::DataReader<plab_v2_Request> requests;

    template <class T>
    void open(wire::DataWriter<T>& writer)
    {
        writer = need(wire::DataWriter<T>::make(participant, publisher));
    }
};

FakeServer::FakeServer(std::uint32_t domain, std::string name) : name_(std::move(name)), ends_(std::make_unique<Ends>())
{
    Ends& e = *ends_;
    e.participant = need(wire::join({domain, ""}));
    e.publisher = need(wire::make_publisher(e.participant, name_));
    e.subscriber = need(wire::make_subscriber(e.participant, name_));
    e.open(e.server), e.open(e.scene), e.open(e.objects), e.open(e.shapes), e.open(e.interactions), e.open(e.types);
    e.states = need(wire::FrameWriter::make(e.participant, e.publisher));
    e.open(e.collisions), e.open(e.contacts), e.open(e.events), e.open(e.metrics), e.open(e.replies);
    e.requests = need(wire::DataReader<plab_v2_Request>::make(e.participant, e.subscriber));
    publish_catalogue();
    publish_types();
    publish_state();
    publish_metrics();
    thread_ = std::thread([this] { run(); });
}

FakeServer::~FakeServer()
{
    stop_ = true;
    thread_.join();
}

Asked FakeServer::last()
{
    const std::lock_guard lock(mutex_);
    return std::exchange(last_, {});
}

void FakeServer::run()
{
    while (!stop_)
    {
        (void)ends_->requests.take(
            [&](const plab_v2_Request& request, const dds_sample_info_t& info)
            {
                if (info.valid_data) answer(request);
            });
        if (!paused_) step_ += 5;
        publish_motion();
        publish_log();
        publish_state();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    plab_v2_Server gone{};
    gone.name = text(name_);
    gone.version = gone.host = gone.scene_file = gone.overload = text("");
    (void)ends_->server.dispose(gone);
}

void FakeServer::publish_catalogue()
{
    plab_v2_Scene scene{};
    scene.server_name = text(name_), scene.run = 1, scene.file = text("scene.xml"), scene.title = text("Test");
    scene.dt = kDt, scene.objects = 2, scene.interactions = 2;
    (void)ends_->scene.write(scene);

    std::vector<char*> shapes{text("balloon")};
    std::vector<plab_v2_Parameter> parameters{parameter("mass", "0.02", "kg", "param")};
    plab_v2_SceneObject red{};
    red.component_id = text("red"), red.name = text("red balloon"), red.type_name = text("State/RigidBody");
    red.handle = 7, red.run = 1, red.shape_of = text("body"), red.motion = text("dynamic"), red.mass = 0.02;
    red.position = {1.4, 0.3, 1}, red.orientation = {1, 0, 0, 0}, red.color = {0.9, 0.1, 0.1};
    red.shapes = sequence<dds_sequence_string>(shapes), red.parameters = sequence<dds_sequence_plab_v2_Parameter>(parameters);
    (void)ends_->objects.write(red);
    plab_v2_SceneObject fan{};
    fan.component_id = fan.name = text("a_fan_with_a_very_long_name"), fan.type_name = text("State/Shaft");
    fan.handle = 9, fan.run = 1, fan.shape_of = text("shaft"), fan.motion = text("dynamic"), fan.mass = 0.005;
    fan.orientation = {1, 0, 0, 0}, fan.color = {-1, -1, -1};
    (void)ends_->objects.write(fan);

    plab_v2_Shape balloon{};
    balloon.component_id = text("balloon"), balloon.type_name = text("Shape/Sphere"), balloon.form = text("sphere");
    balloon.orientation = {1, 0, 0, 0}, balloon.size = {0.15, 0, 0};
    (void)ends_->shapes.write(balloon);

    std::vector<char*> members{text("red"), text("a_fan_with_a_very_long_name")};
    std::vector<plab_v2_Participants> roles{{text("between"), sequence<dds_sequence_string>(members)}};
    plab_v2_Interaction contact{};
    contact.component_id = contact.name = text("contact"), contact.type_name = text("CDetection/ODE"), contact.family = text("CDetection");
    contact.run = 1, contact.roles = sequence<dds_sequence_plab_v2_Participants>(roles);
    std::vector<plab_v2_Parameter> levels;
    for (const auto& [name, value, unit] :
         {std::tuple("governor", "lod", ""), std::tuple("level", "1", ""), std::tuple("levels", "4", ""),
          std::tuple("level_algorithm", "CDetection/ODE", ""), std::tuple("level_every", "0.5", "s"),
          std::tuple("level_reason", "there is room", ""), std::tuple("level_since", "2", "s"),
          std::tuple("level_before", "CDetection/Coarse", ""), std::tuple("level_cost_before", "2e-06", "s"),
          std::tuple("level_cost_after", "8e-06", "s"), std::tuple("level_error_after", "0.003", "m"),
          std::tuple("level_name.0", "CDetection/Coarse", ""), std::tuple("level_error.0", "0.25", "m"),
          std::tuple("level_cost.0", "2e-06", "s"), std::tuple("level_name.1", "CDetection/ODE", ""),
          std::tuple("level_error.1", "0.003", "m"), std::tuple("level_name.2", "CDetection/Fine", ""),
          std::tuple("level_cost.2", "5e-05", "s"), std::tuple("level_name.3", "CDetection/Finest", "")})
        levels.push_back(parameter(name, value, unit, "level"));
    contact.parameters = sequence<dds_sequence_plab_v2_Parameter>(levels);
    (void)ends_->interactions.write(contact);
    std::vector<plab_v2_Parameter> restitution{parameter("restitution", "0.8", "", "param"),
                                               parameter("code", "function f()\nend", "", "param")};
    plab_v2_Interaction response{};
    response.component_id = text("contact.response"), response.name = text("bounce\x1b[31m"), response.type_name = text("Response/Impulse");
    response.family = text("Response"), response.run = 1, response.since = 600, response.quarantined = true;
    response.parameters = sequence<dds_sequence_plab_v2_Parameter>(restitution);
    (void)ends_->interactions.write(response);
}

void FakeServer::publish_types()
{
    std::vector<plab_v2_FieldInfo> fields{field("restitution", "", "0.5", "must be from 0 to 1", "how much it bounces")};
    plab_v2_RoleInfo role{text("between"), text("body"), 2, 4294967295u, text("the bodies that collide")};
    for (const char* name : {"Response/Impulse", "Response/None", "State/RigidBody", "State/Shaft", "CDetection/ODE", "Shape/Sphere"})
    {
        plab_v2_Type type{};
        const std::string family(name, std::strchr(name, '/'));
        type.type_name = text(name), type.family = text(family), type.doc = text("a type of the test"), type.plugin = text("test");
        type.is_loaded = true, type.accuracy = type.strengths = type.cost = type.limits = type.source = text("");
        type.roles = {1, 1, &role, false};
        type.fields = sequence<dds_sequence_plab_v2_FieldInfo>(fields);
        (void)ends_->types.write(type);
    }
}

void FakeServer::publish_state()
{
    plab_v2_Server s{};
    s.name = text(name_), s.version = text("0.1.0"), s.host = text("here"), s.process = 42, s.scene_file = text("scene.xml");
    s.run = 1, s.revision = 3, s.step = step_, s.time = static_cast<double>(s.step) * kDt, s.dt = kDt, s.paused = paused_;
    s.rate_asked = 1, s.rate_reached = 0.998, s.overload = text(""), s.threads = 1;
    s.started_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
    if (disk_is_full_) s.recording = {text("run.mcap"), 1000, 10, 3, text("no space left on device")};
    (void)ends_->server.write(s);
}

void FakeServer::publish_metrics()
{
    std::vector<plab_v2_InteractionMetrics> interactions{
        {text("contact"), text("CDetection/ODE"), text("CDetection/ODE"), 1234, 0, 0, false, {}},
        {text("contact.response"), text("Response/Impulse"), text("Response/Impulse"), 250, 1e-9, -0.5, true, {}}};
    plab_v2_Metrics m{};
    m.run = 1, m.revision = 3, m.step = step_, m.step_ns = 8600, m.real_time_factor = 1;
    m.ledger = {5, 0.25, 1, 0, 1e-12};
    m.interactions = sequence<dds_sequence_plab_v2_InteractionMetrics>(interactions);
    (void)ends_->metrics.write(m);
}

void FakeServer::publish_motion()
{
    if (paused_) return;
    plab_v2_BodyState red{7, {1.5, 0.25, 1}, {1, 0, 0, 0}, {0.3, 0, 0.4}, {0, 0, 0}};
    plab_v2_ShaftState fan{9, 3.25, 40};
    plab_v2_Frame frame{};
    frame.run = 1, frame.revision = 3, frame.sequence_number = ++frames_, frame.step = step_;
    frame.time = static_cast<double>(frame.step) * kDt;
    frame.bodies = {1, 1, &red, false}, frame.shafts = {1, 1, &fan, false};
    (void)ends_->states.write(frame);
    publish_metrics();
    plab_v2_ContactPoint points[2]{{{0, 0, 1}, {0, 0, 1}, 1e-6, 3.5, {0.25, 0, 0}, false}, {{1, 0, 1}, {0, 0, 1}, 0, 1.5, {0, 0, 0}, true}};
    plab_v2_ContactInfo pairs[2]{{text("contact"), text("red"), text("green"), false, {2, 2, points, false}},
                                 {text("contact"), text("floor"), text("green"), true, {1, 1, points, false}}};
    (void)ends_->contacts.write(plab_v2_ContactForces{1, frames_, step_, frame.time, kDt, 7, 2.5, {2, 2, pairs, false}});
}

void FakeServer::publish_log()
{
    number_ += skip_.exchange(0);
    const double time = static_cast<double>(step_) * kDt;
    plab_v2_CollisionInfo hits[2]{};
    for (plab_v2_CollisionInfo& hit : hits)
    {
        hit.kind = text("impact"), hit.time = time, hit.detector = text("contact");
        hit.a = text("red"), hit.b = text("green"), hit.normal = {0, 0, 1}, hit.impulse = {0, 0, 0.002};
    }
    plab_v2_Collisions collisions{1, number_, step_, {2, 2, hits, false}};
    (void)ends_->collisions.write(collisions);
    plab_v2_EventInfo events[2]{};
    for (plab_v2_EventInfo& event : events)
    {
        event.kind = text("script.print"), event.severity = text("warning"), event.time = time, event.component_id = text("wind");
        event.a = event.b = text(""), event.message = text("it blows");
    }
    events[1].component_id = text("clutch");
    plab_v2_Events sample{1, number_, step_, {2, 2, events, false}};
    (void)ends_->events.write(sample);
    number_ += 2;
}

std::vector<std::string> FakeServer::objections(const plab_v2_Request& request) const
{
    const plab_v2_Operation& first = request.operations._buffer[0];
    const std::string target = first.target, blueprint = first.blueprint;
    if (target == "nobody") return {"no component 'nobody', did you mean 'red'?", "nothing was changed"};
    if (blueprint.find("<bad") != std::string::npos) return {std::string(first.argument) + ":3:5: <bad>: no such element"};
    return {};
}

void FakeServer::answer(const plab_v2_Request& request)
{
    Asked asked{{}, request.at, request.revision};
    for (std::uint32_t i = 0; i < request.operations._length; ++i)
    {
        const plab_v2_Operation& op = request.operations._buffer[i];
        Asked::Part& part = asked.parts.emplace_back(Asked::Part{op.verb, op.target, op.argument, op.blueprint, {}});
        for (std::uint32_t v = 0; v < op.values._length; ++v) part.values.push_back({op.values._buffer[v].name, op.values._buffer[v].text});
    }
    const std::string verb = asked.parts.front().verb;
    const bool is_silent = asked.parts.front().target == "silent";
    {
        const std::lock_guard lock(mutex_);
        last_ = std::move(asked);
    }
    if (is_silent) return;
    const std::vector<std::string> reasons = objections(request);
    if (reasons.empty() && (verb == "pause" || verb == "resume")) paused_ = verb == "pause";
    reply(request, reasons);
    if (verb == "shutdown") stop_ = true;
}

void FakeServer::reply(const plab_v2_Request& request, const std::vector<std::string>& reasons)
{
    std::vector<char*> texts;
    for (const std::string& why : reasons) texts.push_back(text(why));
    std::vector<plab_v2_FieldFate> transfers{
        {text("restitution"), text("kept")}, {text("friction"), text("lost")}, {text("softness"), text("fresh")}};
    plab_v2_SwapReport swap{};
    const plab_v2_Operation& first = request.operations._buffer[0];
    swap.component_id = first.target, swap.from_type = text("Response/Impulse"), swap.to_type = first.argument;
    swap.fields = sequence<dds_sequence_plab_v2_FieldFate>(transfers);
    swap.energy_before = 5.125, swap.with_old = {5.25, {1, 0, 0}, 0.001, 8600}, swap.with_new = {5.5, {1, 0, 0.5}, 0.002, 17100};
    const bool is_late = request.at >= 0 && request.at < step_;
    plab_v2_Reply r{};
    std::memcpy(r.client, request.client, sizeof r.client);
    r.number = request.number, r.outcome = text(is_late ? "late" : reasons.empty() ? "done" : "refused");
    std::string late = "step " + std::to_string(request.at) + " has passed";
    if (is_late) texts.push_back(text(late));
    r.reasons = sequence<dds_sequence_string>(texts);
    r.run = 1, r.revision = 4, r.step = step_, r.time = static_cast<double>(r.step) * kDt, r.pause_ns = 243100, r.waited_ns = 900;
    r.trial = text("made: 2 objects, 0.3 ms");
    if (std::strcmp(first.verb, "swap") == 0 && reasons.empty() && !is_late) r.swaps = {1, 1, &swap, false};
    // Like a server that receives a request again because its first answer came too late or was lost.
    r.repeated = std::strcmp(first.verb, "step") == 0;
    (void)ends_->replies.write(r);
}

}  // namespace plab::test
