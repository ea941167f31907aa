/// A server that a test controls: it publishes what the test requests, when the test requests it.
#pragma once

#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "idl/domain.h"
#include "idl/frame_updates.h"

namespace plab::test
{

class PlayedServer
{
public:
    PlayedServer(std::uint32_t domain, std::string name, std::int64_t started_ns) : name_(std::move(name)), started_ns_(started_ns)
    {
        auto joined = wire::join({domain, {}});
        REQUIRE(joined);
        participant_ = joined.take();
        publisher_ = wire::make_publisher(participant_, name_).take();
        server_ = wire::DataWriter<plab_v2_Server>::make(participant_, publisher_).take();
        events_ = wire::DataWriter<plab_v2_Events>::make(participant_, publisher_).take();
        collisions_ = wire::DataWriter<plab_v2_Collisions>::make(participant_, publisher_).take();
        metrics_ = wire::DataWriter<plab_v2_Metrics>::make(participant_, publisher_).take();
        frames_ = wire::FrameWriter::make(participant_, publisher_).take();
        publish_state();
    }

    const std::string& name() const { return name_; }
    void publish_state()
    {
        plab_v2_Server s = state();
        REQUIRE(server_.write(s) == 0);
    }
    /// What plabd publishes before it ends.
    void say_goodbye() { REQUIRE(server_.dispose(state()) == 0); }
    void begin_run(std::uint64_t run) { run_ = run, step_ = 0; }

    void event(const std::string& kind, const std::string& message, const std::string& severity = "info", double value = 0.5)
    {
        ++step_;
        plab_v2_EventInfo e{};
        e.kind = text(kind), e.message = text(message), e.severity = text(severity);
        e.component_id = text("gears");
        e.time = now();
        e.values._length = e.values._maximum = 1, e.values._buffer = &value;
        plab_v2_Events sample{};
        sample.run = run_, sample.step = step_, sample.sequence_number = next_event_++;
        sample.entries._length = sample.entries._maximum = 1, sample.entries._buffer = &e;
        REQUIRE(events_.write(sample) == 0);
    }
    void collisions(const std::string& kind, std::uint32_t count)
    {
        ++step_;
        plab_v2_CollisionInfo c{};
        c.kind = text(kind), c.a = text("red"), c.b = text("blue"), c.detector = text("contact");
        c.time = now(), c.impulse = {0.3, 0, 0.4}, c.position = {1, 2, 3}, c.normal = {1, 0, 0};
        std::vector<plab_v2_CollisionInfo> all(count, c);
        plab_v2_Collisions sample{};
        sample.run = run_, sample.step = step_, sample.sequence_number = next_collision_;
        sample.entries._length = sample.entries._maximum = count, sample.entries._buffer = all.data();
        next_collision_ += count;
        REQUIRE(collisions_.write(sample) == 0);
    }
    void metrics(double kinetic)
    {
        plab_v2_Metrics m{};
        m.run = run_, m.step = step_, m.time = now(), m.ledger.kinetic = kinetic, m.real_time_factor = 1;
        plab_v2_InteractionMetrics i{};
        i.component_id = text("gears"), i.requested = text("A"), i.resolved = text("B"), i.cost_ns = 12, i.error = 1e-9;
        m.interactions._length = m.interactions._maximum = 1, m.interactions._buffer = &i;
        REQUIRE(metrics_.write(m) == 0);
    }
    void frame(double height)
    {
        plab_v2_BodyState body{};
        body.handle = 4, body.position = {0, 0, height}, body.orientation.w = 1;
        plab_v2_Frame f{};
        f.run = run_, f.step = ++step_, f.time = now();
        f.bodies._length = f.bodies._maximum = 1, f.bodies._buffer = &body;
        REQUIRE(frames_.write(f) == 0);
    }
    void skip_events(std::uint64_t count) { next_event_ += count; }

    std::uint32_t event_readers() const { return events_.readers(); }
    std::uint32_t frame_readers() const { return frames_.readers(); }
    /// Waits until there are readers of all logged topics.
    bool wait_for_logger() const
    {
        for (int i = 0; i < 2000 && (events_.readers() == 0 || collisions_.readers() == 0); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return events_.readers() > 0 && collisions_.readers() > 0;
    }

private:
    /// Valid only as long as the string to which it refers.
    static char* text(const std::string& s) { return const_cast<char*>(s.c_str()); }
    static char* text(const char* s) { return const_cast<char*>(s); }
    double now() const { return static_cast<double>(step_) / 240; }
    plab_v2_Server state() const
    {
        plab_v2_Server s{};
        s.name = text(name_), s.host = text("here"), s.scene_file = text("played.xml");
        s.process = getpid(), s.run = run_, s.step = step_, s.time = now(), s.started_ns = started_ns_;
        return s;
    }

    std::string name_;
    std::int64_t started_ns_ = 0, step_ = 0;
    std::uint64_t run_ = 1, next_event_ = 1, next_collision_ = 1;
    wire::Participant participant_;
    wire::Entity publisher_;
    wire::DataWriter<plab_v2_Server> server_;
    wire::DataWriter<plab_v2_Events> events_;
    wire::DataWriter<plab_v2_Collisions> collisions_;
    wire::DataWriter<plab_v2_Metrics> metrics_;
    wire::FrameWriter frames_;
};

/// Tests may run side by side, in several checkouts.
inline std::uint32_t test_domain() { return 10 + static_cast<std::uint32_t>(getpid()) % 50; }

}  // namespace plab::test
