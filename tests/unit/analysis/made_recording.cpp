#include "made_recording.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "idl/recording/topic_file.h"

namespace plab::test
{
namespace
{

using recording::Clock;

enum Handle : std::uint32_t
{
    kRed = 1,
    kBlue = 2,
    kAxle = 3,
};

/// Samples are built from texts with the lifetime of the call; what they point to is not freed.
char* text(const char* t) { return const_cast<char*>(t); }

template <class Sequence, class Item>
void point_at(Sequence& sequence, std::vector<Item>& items)
{
    sequence._buffer = items.data();
    sequence._length = sequence._maximum = static_cast<std::uint32_t>(items.size());
    sequence._release = false;
}

class Maker
{
public:
    Maker(recording::McapWriter writer, const MadeOptions& options) : writer_(std::move(writer)), options_(options) {}

    void make()
    {
        begin_run(1);
        for (std::int64_t step = 0; step <= options_.steps; ++step) add_step(step);
        if (options_.steps_after > 0)
        {
            begin_run(2);
            for (std::int64_t step = 0; step <= options_.steps_after; ++step) add_step(step);
        }
        if (options_.is_closed)
            REQUIRE(writer_.close().ok());
        else
            writer_.flush();
    }

private:
    template <class T>
    void put(const T& sample)
    {
        const std::string topic = wire::topic_of<T>().name;
        auto channel = channels_.find(topic);
        if (channel == channels_.end())
        {
            const auto schema = writer_.add_schema(recording::schema_of<T>().take());
            REQUIRE(schema.ok());
            const auto added = writer_.add_channel(recording::channel_of<T>(*schema));
            REQUIRE(added.ok());
            channel = channels_.emplace(topic, *added).first;
        }
        const auto bytes = encoder_.encode(sample);
        REQUIRE(bytes.ok());
        REQUIRE(writer_.write({channel->second, 0, now(), kMadeStart + now(), *bytes}, clock_));
    }

    std::uint64_t now() const { return (steps_before_ + static_cast<std::uint64_t>(step_)) * kMadeStepNs; }
    double time() const { return static_cast<double>(step_) * kMadeStep; }

    void begin_run(std::uint64_t run)
    {
        if (run > 1) steps_before_ += static_cast<std::uint64_t>(step_) + 1;
        run_ = run, step_ = 0;
        if (options_.with_catalogue) add_catalogue();
        if (run > 1) add_journal("reset", "", "");
        add_snapshot();
    }

    void add_catalogue()
    {
        plab_v2_Scene scene{};
        scene.server_name = text("lab"), scene.run = run_, scene.file = text("made.xml"), scene.title = text("Made"), scene.dt = kMadeStep;
        put(scene);
        add_object("red", kRed, "body"), add_object("blue", kBlue, "body");
        if (options_.with_axle) add_object("axle", kAxle, "shaft");
        add_interaction("Response/Impulse", 0);
        for (int k = 0; k < options_.governed; ++k) add_governed(k, "Solver/Cheap");
    }
    void add_governed(int number, const char* algorithm)
    {
        const std::string id = "solver." + std::to_string(number);
        std::vector<plab_v2_Parameter> parameters(2);
        for (plab_v2_Parameter& p : parameters) p = {}, p.kind = text("level");
        parameters[0].name = text("governor"), parameters[0].text = text("lod");
        parameters[1].name = text("level_algorithm"), parameters[1].text = text(algorithm);
        plab_v2_Interaction i{};
        i.component_id = i.name = text(id.c_str()), i.type_name = text(algorithm), i.family = text("Solver"), i.run = run_;
        point_at(i.parameters, parameters);
        put(i);
    }
    void add_object(const char* id, std::uint32_t handle, const char* kind)
    {
        plab_v2_SceneObject o{};
        o.component_id = o.name = text(id), o.type_name = text("State/RigidBody"), o.handle = handle, o.run = run_;
        o.shape_of = text(kind), o.motion = text("dynamic"), o.mass = 1;
        put(o);
    }
    void add_interaction(const char* type, std::int64_t since)
    {
        plab_v2_Interaction i{};
        i.component_id = i.name = text("contact.response"), i.type_name = text(type), i.family = text("Response"), i.run = run_,
        i.since = since;
        put(i);
    }
    void add_journal(const char* verb, const char* target, const char* argument)
    {
        if (!options_.with_journal) return;
        std::vector<plab_v2_Operation> operations(1);
        operations[0] = {};
        operations[0].verb = text(verb), operations[0].target = text(target), operations[0].argument = text(argument);
        plab_v2_Journal j{};
        j.run = run_, j.sequence_number = ++requests_, j.step = step_, j.time = time(), j.origin = text("client"), j.number = requests_;
        j.client[0] = 0xab;
        point_at(j.operations, operations);
        put(j);
    }
    void add_snapshot()
    {
        std::vector<std::uint8_t> bytes(100, 7);
        plab_v2_Snapshot s{};
        s.run = run_, s.step = step_, s.time = time(), s.cause = text("begin"), s.state_hash = 1, s.blueprint = text("<plab/>");
        point_at(s.data, bytes);
        put(s);
    }

    void add_step(std::int64_t step)
    {
        step_ = step, clock_ += std::chrono::nanoseconds(kMadeStepNs);
        writer_.tick(clock_);
        if (run_ == 1 && step == options_.swap_at)
        {
            add_journal("swap", "contact.response", "Response/None");
            if (options_.with_catalogue) add_interaction("Response/None", step);
            for (int k = 0; k < options_.governed; k += 3) add_governed(k, "Solver/Fine");
        }
        if (step % options_.frame_every == 0) add_frame();
        if (options_.with_hashes && step % 10 == 9) add_hashes();
        if (step % 25 == 0) add_metrics();
        if (step % 50 == 30) add_events();
        if (step % 40 == 20) add_collisions();
    }

    bool differs() const { return options_.differs_from >= 0 && step_ >= options_.differs_from; }
    double difference() const
    {
        return differs() ? options_.difference * std::exp2(static_cast<double>(step_ - options_.differs_from) / 10) : 0;
    }

    void add_frame()
    {
        ++frames_;
        if (run_ == 1 && step_ == options_.missing_frame) return;
        const double t = time();
        const MadePlace red = made_red(t);
        std::vector<plab_v2_BodyState> bodies(2);
        bodies[0] = {kRed, {red.x, red.y + difference(), red.z}, {std::cos(t), 0, 0, std::sin(t)}, {1, std::cos(t), 0}, {0, 0, 2}};
        bodies[1] = {kBlue, {0, 0, t * t}, {1, 0, 0, 0}, {0, 0, 2 * t}, {0, 0, 0}};
        std::vector<plab_v2_ShaftState> shafts{{kAxle, 3 * t, 3}};
        // Blue is named at every tenth frame only, the axle never after the first: they keep their last recorded states.
        if (!options_.with_axle || (options_.only_moved && step_ > 0)) shafts.clear();
        if (options_.only_moved && step_ % 10 != 0) bodies.pop_back();
        plab_v2_Frame f{};
        f.run = run_, f.revision = 1, f.sequence_number = frames_, f.step = step_, f.time = t;
        f.stamp_ns = static_cast<std::int64_t>(kMadeStart + now());
        point_at(f.bodies, bodies), point_at(f.shafts, shafts);
        put(f);
    }

    /// Of the last ten steps, including this one.
    void add_hashes()
    {
        std::vector<std::uint64_t> values;
        for (std::int64_t step = step_ - 9; step <= step_; ++step)
            values.push_back(made_hash(run_, step, options_.differs_from >= 0 && step >= options_.differs_from));
        plab_v2_Hashes h{};
        h.run = run_, h.sequence_number = static_cast<std::uint64_t>(step_) - 8, h.step = step_ - 9;
        point_at(h.values, values);
        put(h);
    }

    void add_metrics()
    {
        std::vector<plab_v2_Parameter> outputs{{text("contacts"), text("4"), text(""), text("output")},
                                               {text("force"), text("(1 2 2)"), text("N"), text("output")}};
        std::vector<plab_v2_InteractionMetrics> interactions(1);
        plab_v2_InteractionMetrics& i = interactions[0];
        i = {};
        const bool is_swapped = run_ == 1 && step_ >= options_.swap_at;
        i.component_id = text("contact.response"), i.requested = i.resolved = text(is_swapped ? "Response/None" : "Response/Impulse");
        i.cost_ns = is_swapped ? 100 : 2000, i.error = 1e-6 * (1 + time()), i.work = -time();
        point_at(i.outputs, outputs);
        plab_v2_Metrics m{};
        m.run = run_, m.step = step_, m.time = time(), m.step_ns = 50000, m.real_time_factor = 2;
        // As after a rewind: the measured interval begins before the run.
        if (run_ > 1 && step_ == 0) m.step_ns = 1, m.real_time_factor = 99, i.cost_ns = 7e7;
        m.ledger = {10 + time(), 5, time(), 0, 0};
        m.momentum = {1, 0, 0}, m.angular_momentum = {0, 0, 2}, m.contacts = 4;
        point_at(m.interactions, interactions);
        put(m);
    }

    void add_events()
    {
        std::vector<double> values{1.5, 2};
        std::vector<plab_v2_EventInfo> entries(1);
        entries[0] = {text("script.print"),
                      text(step_ == 80 ? "warning" : "info"),
                      time() + 0.001,
                      text("gears"),
                      text("red"),
                      text(""),
                      text("a \"quoted\", word"),
                      {}};
        point_at(entries[0].values, values);
        plab_v2_Events e{};
        e.run = run_, e.sequence_number = ++events_, e.step = step_;
        point_at(e.entries, entries);
        put(e);
    }

    void add_collisions()
    {
        std::vector<plab_v2_CollisionInfo> entries(2);
        for (plab_v2_CollisionInfo& c : entries)
            c = {text("impact"), time() + 0.002, text("contact.detection"), text("red"), text("blue"), {1, 2, 3}, {0, 0, 1},
                 {0, 0, 0.5},    0.125};
        entries[1].b = text("floor");
        plab_v2_Collisions s{};
        s.run = run_, s.sequence_number = collisions_ + 1, s.step = step_;
        collisions_ += 2;
        point_at(s.entries, entries);
        put(s);
    }

    recording::McapWriter writer_;
    MadeOptions options_;
    recording::Encoder encoder_;
    std::map<std::string, recording::ChannelId> channels_;
    Clock::time_point clock_{};
    std::uint64_t run_ = 0, steps_before_ = 0, frames_ = 0, requests_ = 0, events_ = 0, collisions_ = 0;
    std::int64_t step_ = 0;
};

}  // namespace

MadePlace made_red(double time) { return {time, std::sin(time), 2}; }

std::uint64_t made_hash(std::uint64_t run, std::int64_t step, bool differs)
{
    return run * 1'000'003 + static_cast<std::uint64_t>(step) * 17 + (differs ? 1 : 0);
}

std::string fresh_path(const std::string& name)
{
    const std::filesystem::path path = std::filesystem::path(PLAB_BINARY_DIR) / ("unit_analysis_" + name);
    std::filesystem::remove_all(path);
    return path.string();
}

std::string make_recording(const std::string& name, const MadeOptions& options)
{
    const std::string path = fresh_path(name);
    recording::WriterOptions writing;
    writing.compression = options.compression;
    auto writer = recording::McapWriter::create(path, writing);
    REQUIRE(writer.ok());
    recording::Metadata head{"plab",
                             {{"format", "2"}, {"server", "lab"}, {"host", "here"}, {"version", "0.2.0"}, {"scene_file", "made.xml"}}};
    if (options.only_moved) head.values["states"] = "moved";
    REQUIRE(writer->add_metadata(head).ok());
    const std::string blueprint = "<plab version=\"1\"/>";
    const recording::ByteView bytes(reinterpret_cast<const std::uint8_t*>(blueprint.data()), blueprint.size());
    REQUIRE(writer->attach({0, kMadeStart, "blueprint.xml", "text/xml", bytes}).ok());
    Maker(writer.take(), options).make();
    return path;
}

}  // namespace plab::test
