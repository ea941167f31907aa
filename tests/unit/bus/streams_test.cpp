// What is published while there are readers: frames, events, collisions, metrics, images.
#include <algorithm>

#include "idl/samples.h"
#include "support.h"

using namespace plab;
using namespace plab::test;

namespace
{

/// Keeps the numbers of the frames received, in order.
struct FrameLog
{
    std::vector<std::uint64_t> numbers;
    void take(wire::DataReader<plab_v2_Frame>& reader)
    {
        (void)reader.take(
            [&](const plab_v2_Frame& frame, const dds_sample_info_t& info)
            {
                if (info.valid_data) numbers.push_back(frame.sequence_number);
            });
    }
};

publish::CatalogueChange scene_with(const std::string& type)
{
    publish::CatalogueChange change;
    change.everything = true;
    wire::Interaction entry;
    entry.component_id = "part", entry.type_name = type;
    change.interactions.push_back(entry);
    return change;
}

}  // namespace

TEST_CASE("nothing is wanted until there is a reader, nor after the last one has left")
{
    TestBus bus;
    const link::Session session = bus.session();
    for (const auto stream : {publish::Stream::States, publish::Stream::Events, publish::Stream::Metrics, publish::Stream::Collisions})
        CHECK_FALSE(bus->wants(stream));
    std::this_thread::sleep_for(50ms);
    const int before = bus.wakes();
    {
        const auto reader = reader_of<plab_v2_Frame>(session);
        CHECK(eventually([&] { return bus->wants(publish::Stream::States); }));
        CHECK(eventually([&] { return bus.wakes() == before + 1; }));  // a paused server may publish its state
        CHECK_FALSE(bus->wants(publish::Stream::Events));
    }
    CHECK(eventually([&] { return !bus->wants(publish::Stream::States); }));
}

TEST_CASE("a frame arrives as it was filled")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto reader = reader_of<plab_v2_Frame>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::States); }));
    push_frame(*bus.operator->(), 9, 3);
    REQUIRE(session.wait(reader, 5s));
    int frames = 0;
    (void)reader.take(
        [&](const plab_v2_Frame& f, const dds_sample_info_t&)
        {
            ++frames;
            CHECK(f.run == 3);
            CHECK(f.revision == 5);
            CHECK(f.sequence_number == 9);
            CHECK(f.step == 36);
            CHECK(f.time == 2.25);
            CHECK(f.stamp_ns == 77);
            REQUIRE(f.bodies._length == 3);
            const plab_v2_BodyState& b = f.bodies._buffer[2];
            CHECK(b.handle == 2);
            CHECK(b.position.z == 4);
            CHECK(b.orientation.y == -0.5);
            CHECK(b.linear_velocity.z == -2);
            CHECK(b.angular_velocity.y == 2);
            REQUIRE(f.shafts._length == 1);
            CHECK(f.shafts._buffer[0].handle == 900);
            CHECK(f.shafts._buffer[0].speed == -2.5);
        });
    CHECK(frames == 1);
}

TEST_CASE("contacts arrive as they were filled, and are wanted only while there is a reader")
{
    TestBus bus;
    const link::Session session = bus.session();
    CHECK_FALSE(bus->wants(publish::Stream::Contacts));
    auto reader = reader_of<plab_v2_ContactForces>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::Contacts); }));
    const wire::ContactPoint point{{1, 2, 3}, {0, 0, 1}, 1e-6, 9.81, {0.5, -0.25, 0}, true};
    for (std::uint64_t i = 1; i <= 2; ++i)
    {
        wire::ContactForces& contacts = bus->begin_contacts();
        contacts.run = 3, contacts.sequence_number = i, contacts.step = 36, contacts.time = 2.25, contacts.step_length = 0.125;
        contacts.left_out = 7, contacts.force_left_out = 0.5;
        contacts.entries = {{"contact", "box", "ground", true, {point, point}}};
        bus->end_contacts();
    }
    std::uint64_t last = 0;
    REQUIRE(eventually(
        [&]
        {
            (void)reader.take(
                [&](const plab_v2_ContactForces& c, const dds_sample_info_t&)
                {
                    last = c.sequence_number;
                    const auto value = wire::value_of<wire::ContactForces>(c);
                    CHECK(value.run == 3);
                    CHECK(value.step == 36);
                    CHECK(value.step_length == 0.125);
                    CHECK(value.left_out == 7);
                    CHECK(value.force_left_out == 0.5);
                    REQUIRE(value.entries.size() == 1);
                    CHECK(value.entries[0].b == "ground");
                    CHECK(value.entries[0].asleep);
                    REQUIRE(value.entries[0].points.size() == 2);
                    CHECK(same_members(value.entries[0].points[1], point));
                });
            return last == 2;
        }));
}

TEST_CASE("frames that come too fast are dropped, the oldest first: numbers increase, gaps are counted, the last one arrives")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto reader = reader_of<plab_v2_Frame>(session);
    auto server = reader_of<plab_v2_Server>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::States); }));
    constexpr std::uint64_t kFrames = 3000;
    FrameLog log;
    for (std::uint64_t i = 1; i <= kFrames; ++i)
    {
        push_frame(*bus.operator->(), i, 1000);
        if (i % 64 == 0) log.take(reader);
    }
    REQUIRE(eventually(
        [&]
        {
            log.take(reader);
            return !log.numbers.empty() && log.numbers.back() == kFrames;
        }));
    CHECK(std::is_sorted(log.numbers.begin(), log.numbers.end(), std::less_equal<>()));
    CHECK(log.numbers.size() < kFrames);
    bus->status({});
    std::uint64_t dropped = 0;
    REQUIRE(eventually(
        [&]
        {
            (void)server.take(
                [&](const plab_v2_Server& s, const dds_sample_info_t&)
                {
                    for (std::uint32_t i = 0; i < s.dropped._length; ++i)
                        if (std::string(s.dropped._buffer[i].topic) == "plab/states") dropped = s.dropped._buffer[i].samples;
                });
            return dropped > 0;
        }));
    CHECK(log.numbers.size() + dropped <= kFrames);
}

TEST_CASE("a reader that never takes samples delays no other")
{
    TestBus bus;
    const link::Session session = bus.session();
    const auto frames = reader_of<plab_v2_Frame>(session);
    const auto events = reader_of<plab_v2_Events>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::States) && bus->wants(publish::Stream::Events); }));
    std::vector<double> us;
    for (std::uint64_t i = 1; i <= 2000; ++i)
    {
        const auto begin = std::chrono::steady_clock::now();
        push_frame(*bus.operator->(), i, 100);
        wire::Events batch;
        batch.sequence_number = i;
        batch.entries.resize(1);
        bus->events(std::move(batch));
        us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
        std::this_thread::sleep_for(200us);
    }
    std::sort(us.begin(), us.end());
    MESSAGE("handing over a frame and an event: median " << us[1000] << " us, 99 % " << us[1980] << " us, longest " << us.back() << " us");
    CHECK(us[1980] < 10000);  // generous: the machine may be busy, but no thread waits for the reader
}

TEST_CASE("events arrive with all their parts")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto reader = reader_of<plab_v2_Events>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::Events); }));
    wire::Events batch;
    batch.run = 2, batch.sequence_number = 41, batch.step = 8;
    batch.entries.push_back({"script.print", "warning", 0.5, "script", "a", "b", "h\xc3\xa9", {1.5, 2.5}});
    batch.entries.push_back({"x.y", "failure", 0.6, "", "", "", "", {}});
    bus->events(std::move(batch));
    REQUIRE(session.wait(reader, 5s));
    (void)reader.take(
        [&](const plab_v2_Events& e, const dds_sample_info_t&)
        {
            CHECK(e.run == 2);
            CHECK(e.sequence_number == 41);
            CHECK(e.step == 8);
            REQUIRE(e.entries._length == 2);
            CHECK(std::string(e.entries._buffer[0].kind) == "script.print");
            CHECK(std::string(e.entries._buffer[0].severity) == "warning");
            CHECK(std::string(e.entries._buffer[0].message) == "h\xc3\xa9");
            REQUIRE(e.entries._buffer[0].values._length == 2);
            CHECK(e.entries._buffer[0].values._buffer[1] == 2.5);
            CHECK(std::string(e.entries._buffer[1].severity) == "failure");
        });
}

TEST_CASE("metrics arrive, each interaction with its own outputs")
{
    TestBus bus;
    const link::Session session = bus.session();
    auto reader = reader_of<plab_v2_Metrics>(session);
    REQUIRE(eventually([&] { return bus->wants(publish::Stream::Metrics); }));
    wire::Metrics metrics;
    metrics.ledger = {1, 2, 3, 4, 5};
    metrics.interactions.push_back({"gear", "G/A", "G/B", 10, 1e-3, 7, false, {{"torque", "1", "N m", "output"}}});
    metrics.interactions.push_back({"spring", "S", "S", 20, 0, 8, true, {{"f", "2", "N", "output"}, {"g", "3", "N", "output"}}});
    bus->metrics(std::move(metrics));
    REQUIRE(session.wait(reader, 5s));
    (void)reader.take(
        [&](const plab_v2_Metrics& m, const dds_sample_info_t&)
        {
            CHECK(m.ledger.of_requests == 4);
            REQUIRE(m.interactions._length == 2);
            CHECK(std::string(m.interactions._buffer[0].resolved) == "G/B");
            REQUIRE(m.interactions._buffer[1].outputs._length == 2);
            CHECK(std::string(m.interactions._buffer[1].outputs._buffer[1].text) == "3");
            CHECK(std::string(m.interactions._buffer[0].outputs._buffer[0].name) == "torque");
        });
}

TEST_CASE("collisions and images have a writer only while the scene can produce them")
{
    TestBus bus;
    const link::Session session = bus.session();
    const auto collisions = reader_of<plab_v2_Collisions>(session);
    auto images = reader_of<plab_v2_Image>(session);
    REQUIRE(bus->catalogue(scene_with("Field/Gravity")));
    std::this_thread::sleep_for(100ms);
    CHECK(collisions.writers() == 0);
    CHECK(images.writers() == 0);
    REQUIRE(bus->catalogue(scene_with("CDetection/ODE")));
    CHECK(eventually([&] { return bus->wants(publish::Stream::Collisions); }));
    CHECK_FALSE(bus->wants(publish::Stream::Images));
    REQUIRE(bus->catalogue(scene_with("Camera/OSMesa")));
    CHECK(eventually([&] { return bus->wants(publish::Stream::Images); }));
    CHECK(eventually([&] { return !bus->wants(publish::Stream::Collisions) && collisions.writers() == 0; }));
    bus->image({"eye", 1, 2, 0.5, 2, 1, "rgba8", {1, 2, 3, 4, 5, 6, 7, 255}});
    REQUIRE(session.wait(images, 5s));
    (void)images.take(
        [&](const plab_v2_Image& i, const dds_sample_info_t&)
        {
            CHECK(std::string(i.camera) == "eye");
            CHECK(std::string(i.encoding) == "rgba8");
            REQUIRE(i.data._length == 8);
            CHECK(i.data._buffer[7] == 255);
        });
    REQUIRE(bus->catalogue(scene_with("Field/Gravity")));
    CHECK(eventually([&] { return !bus->wants(publish::Stream::Images) && images.writers() == 0; }));
}
