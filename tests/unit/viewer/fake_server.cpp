#include "viewer/fake_server.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <vector>

#include "idl/frame_updates.h"

namespace plab::test
{
namespace
{

using Clock = std::chrono::steady_clock;

char* text(const char* constant) { return const_cast<char*>(constant); }  // C structs have char*; nothing writes it
char* text(const std::string& s) { return const_cast<char*>(s.c_str()); }

template <class Sequence, class T>
void point_to(Sequence& sequence, std::vector<T>& values)
{
    sequence._maximum = sequence._length = static_cast<std::uint32_t>(values.size());
    sequence._buffer = values.data();
    sequence._release = false;
}

/// Everything that the script's server writes.
class Stage
{
public:
    Stage(const Script& script, const std::string& name, const wire::Entity& participant)
        : script_(script), name_(name), publisher_(wire::make_publisher(participant, name).take())
    {
        make(participant, server_), make(participant, scene_), make(participant, objects_), make(participant, shapes_);
        make(participant, interactions_);
        frames_ = wire::FrameWriter::make(participant, publisher_).take();
    }

    bool is_watched() const { return frames_.readers() > 0; }

    void publish_status(std::int64_t step)
    {
        plab_v2_Server s{};
        s.name = text(name_), s.version = text("0"), s.host = text("test"), s.scene_file = text("fall.xml"), s.overload = text("");
        s.process = getpid(), s.run = run_, s.step = step, s.time = time_of(step), s.dt = FakeServer::kDt, s.paused = script_.paused;
        (void)server_.write(s);
    }

    void publish_scene()
    {
        std::vector<plab_v2_View> cameras{{text("behind"), {0, 8, 2}, {0, 0, 1.5}, {0, 0, 1}, 0.7},
                                          {text("front"), {0, -8, 2}, {0, 0, 1.5}, {0, 0, 1}, 0.7}};
        plab_v2_Scene s{};
        s.server_name = text(name_), s.run = run_, s.file = text("fall.xml"), s.title = text("A falling ball"), s.dt = FakeServer::kDt;
        s.objects = 3, s.interactions = static_cast<std::uint32_t>(script_.interactions);
        point_to(s.cameras, cameras);
        (void)scene_.write(s);
        publish_shape("round", "sphere", {0.5, 0, 0});
        publish_shape("flat", "plane", {0, 0, 0});
        publish_shape("cube", "box", {0.4, 0.4, 0.4});
        publish_object("ball", 1, "body", "dynamic", {0, 0, 3}, {1, 0, 0}, "round");
        publish_object("floor", 2, "body", "static", {0, 0, 0}, {-1, -1, -1}, "flat");
        publish_object("wheel", 3, "shaft", "dynamic", {2, 0, 1}, {-1, -1, -1}, "");
    }

    void publish_interactions(const std::string& response, std::int64_t since)
    {
        publish_interaction("gravity", "Field/Gravity", 0);
        publish_interaction("response", response, since);
        for (std::size_t i = 2; i < script_.interactions; ++i) publish_interaction("wire" + std::to_string(i), "Field/Wire", 0);
    }

    void publish_late_box() { publish_object("late", 4, "body", "dynamic", {-2, 0, 1}, {0, 1, 0}, "cube"); }

    void publish_frame(std::int64_t step, std::uint64_t revision)
    {
        const double t = time_of(step), z = height_at(t);
        std::vector<plab_v2_BodyState> bodies{{1, {0, 0, z}, {1, 0, 0, 0}, {0, 0, -9.81 * t}, {0, 0, 0}}};
        if (script_.late_at >= 0 && step >= script_.late_at) bodies.push_back({4, {-2, 0, 1}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
        std::vector<plab_v2_ShaftState> shafts{{3, 2 * t, 2}};
        plab_v2_Frame f{};
        f.run = run_, f.revision = revision, f.sequence_number = ++sequence_, f.step = step, f.time = t;
        point_to(f.bodies, bodies), point_to(f.shafts, shafts);
        (void)frames_.write(f);
    }

    void next_run() { ++run_, publish_scene(), publish_interactions("Response/Impulse", 0); }
    double time_of(std::int64_t step) const { return script_.first_time + static_cast<double>(step) * FakeServer::kDt; }

private:
    template <class T>
    void make(const wire::Entity& participant, wire::DataWriter<T>& writer)
    {
        writer = wire::DataWriter<T>::make(participant, publisher_).take();
    }

    void publish_shape(const char* id, const char* form, const plab_v2_Vector& size)
    {
        plab_v2_Shape s{};
        s.component_id = text(id), s.type_name = text("Shape/Any"), s.form = text(form), s.size = size, s.orientation = {1, 0, 0, 0};
        (void)shapes_.write(s);
    }

    void publish_object(const char* id, std::uint32_t handle, const char* kind, const char* motion, const plab_v2_Vector& position,
                        const plab_v2_Vector& color, const char* shape)
    {
        std::vector<char*> shapes;
        if (*shape != 0) shapes.push_back(text(shape));
        plab_v2_SceneObject o{};
        o.component_id = text(id), o.name = text(id), o.type_name = text("State/Any"), o.handle = handle, o.run = run_;
        o.shape_of = text(kind), o.motion = text(motion), o.mass = 1, o.position = position, o.color = color;
        // The wheel's axle lies along y: the faces look at the cameras.
        o.orientation = *kind == 's' ? plab_v2_Rotation{std::sqrt(0.5), std::sqrt(0.5), 0, 0} : plab_v2_Rotation{1, 0, 0, 0};
        point_to(o.shapes, shapes);
        (void)objects_.write(o);
    }

    void publish_interaction(const std::string& id, const std::string& type, std::int64_t since)
    {
        plab_v2_Interaction i{};
        i.component_id = text(id), i.name = text(id), i.type_name = text(type), i.family = text("any"), i.run = run_, i.since = since;
        (void)interactions_.write(i);
    }

    const Script& script_;
    const std::string& name_;
    wire::Entity publisher_;
    wire::DataWriter<plab_v2_Server> server_;
    wire::DataWriter<plab_v2_Scene> scene_;
    wire::DataWriter<plab_v2_SceneObject> objects_;
    wire::DataWriter<plab_v2_Shape> shapes_;
    wire::DataWriter<plab_v2_Interaction> interactions_;
    wire::FrameWriter frames_;
    std::uint64_t run_ = 1, sequence_ = 0;
};

void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

/// Plays the script from its first step on. The states of a real server come at its own pace, with or without readers; here
/// they wait for a subscriber, so that the tests know what it receives.
void play(const Script& script, Stage& stage, const std::stop_token& stop)
{
    const auto start = Clock::now();
    const auto status_period = static_cast<std::int64_t>(0.25 * script.rate / FakeServer::kDt);  // 0.25 s of real time
    std::int64_t base = 0;
    std::uint64_t revision = 0;
    std::int64_t listed_late = -1;
    for (std::int64_t step = 0; !stop.stop_requested(); ++step)
    {
        const std::int64_t own = step - base;
        if (stage.time_of(own) > script.until + 1e-9) return;
        if (own == script.reset_at && base == 0) base = step, stage.next_run();
        if (own == script.swap_at && base == 0) ++revision, stage.publish_interactions("Response/Penalty", own);
        if (own == script.late_at) listed_late = step + static_cast<std::int64_t>(0.1 * script.rate / FakeServer::kDt);
        if (step == listed_late) stage.publish_late_box();
        if (step % 4 == 0) stage.publish_frame(step - base, revision);
        if (step % status_period == 0) stage.publish_status(step - base);
        std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                                  static_cast<double>(step + 1) * FakeServer::kDt / script.rate)));
    }
}

std::string new_name()
{
    static std::atomic<int> count = 0;
    return "view-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

}  // namespace

FakeServer::FakeServer(const Script& script) : script_(script), name_(new_name())
{
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

FakeServer::~FakeServer()
{
    thread_.request_stop();
    thread_.join();
}

void FakeServer::serve(const std::stop_token& stop)
{
    const auto participant = wire::join(wire::domain_from_environment().take());
    if (!participant) return;
    Stage stage(script_, name_, *participant);
    stage.publish_scene();
    stage.publish_interactions("Response/Impulse", 0);
    stage.publish_status(0);
    while (!stop.stop_requested() && (script_.paused || !stage.is_watched())) nap(0.01);
    nap(0.05);
    if (!stop.stop_requested()) play(script_, stage, stop);
    while (!stop.stop_requested() && !script_.leaves) nap(0.01);
}

}  // namespace plab::test
