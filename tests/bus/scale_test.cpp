// Many bodies and many readers: 10,000 bodies, of which 100 move, at 60 frames a second for 20 clients in processes of their own.
#include "server.h"

#include <cstring>
#include <fstream>

#include "link/frame_reader.h"

using namespace plab;
using namespace plab::test;
using Clock = std::chrono::steady_clock;

namespace
{

constexpr std::size_t kBodies = 10'000, kMoving = 100;

/// A hundred rows of a hundred bodies; the first row turns.
std::string field_of_bodies()
{
    const std::string file = scratch_file("field_10000.xml");
    std::ofstream(file) << "<plab version=\"1\"><scene dt=\"1/60\"/><component id=\"s\" type=\"Shape/Sphere\" radius=\"0.1\"/>"
                           "<repeat id=\"moving\" count=\"100 1\" step=\"1 1 0\"><component id=\"a\" type=\"State/Kinematic\" shape=\"s\""
                           " angular_velocity=\"0 0 1\"/></repeat>"
                           "<repeat id=\"resting\" count=\"100 99\" step=\"1 1 0\"><component id=\"b\" type=\"State/Kinematic\" shape=\"s\""
                           " position=\"0 1 0\"/></repeat></plab>";
    return file;
}

/// Processor time of the first thread of a process, s: of plabd the one that steps.
double first_thread_seconds(int pid)
{
    std::ifstream in("/proc/" + std::to_string(pid) + "/task/" + std::to_string(pid) + "/schedstat");
    double ns = 0;
    in >> ns;
    return 1e-9 * ns;
}

/// Share of real time that the step thread runs, in a quiet second of three: other programs use the processors too.
double step_thread_share(int pid)
{
    double least = 1;
    for (int i = 0; i < 3; ++i)
    {
        const auto begin = Clock::now();
        const double from = first_thread_seconds(pid);
        std::this_thread::sleep_for(Milliseconds(1000));
        const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
        least = std::min(least, (first_thread_seconds(pid) - from) / elapsed);
    }
    return least;
}

/// Frames that arrive here in that time, per second; each must be complete.
double frames_per_second(const link::Session& session, link::FrameReader& reader, double seconds)
{
    std::size_t frames = 0;
    const auto begin = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    while (elapsed() < seconds)
    {
        if (!session.wait(reader, Seconds(0.1))) continue;
        (void)reader.take(
            [&](const plab_v2_Frame& f)
            {
                REQUIRE(f.bodies._length == kBodies);
                ++frames;
            });
    }
    return static_cast<double>(frames) / elapsed();
}

}  // namespace

TEST_CASE(
    "10,000 bodies at 60 Hz for 20 readers: the step thread pays below 1 %, a late joiner is complete within a second, a stopped "
    "reader changes nothing")
{
    Server server(field_of_bodies(), {"--rate", "real"});
    const int pid = server.process().pid();
    const double alone = step_thread_share(pid);

    std::vector<Process> readers;
    for (int i = 0; i < 20; ++i)
        readers.emplace_back(
            std::vector<std::string>{program("plabctl"), "--server", server.name(), "watch", "states", "--json", "--every", "1000"});
    std::this_thread::sleep_for(Milliseconds(3000));
    for (Process& reader : readers) REQUIRE(reader.running());
    const double watched = step_thread_share(pid);
    MESSAGE("step thread: " << 100 * alone << " % of real time without readers, " << 100 * watched << " % with 20");
    CHECK(watched - alone < 0.01);

    const link::Session session = server.session();
    const auto joins = Clock::now();
    auto late = link::FrameReader::open(session);
    REQUIRE(late.ok());
    std::uint32_t bodies = 0;
    double turned = 0;
    while (bodies == 0 && Clock::now() - joins < std::chrono::seconds(5))
        if (session.wait(*late, Seconds(0.1)))
            (void)late->take([&](const plab_v2_Frame& f)
                             { bodies = f.bodies._length, turned = f.bodies._buffer[kMoving - 1].orientation.z; });
    const double joined = std::chrono::duration<double>(Clock::now() - joins).count();
    MESSAGE("a late joiner was complete after " << 1e3 * joined << " ms");
    CHECK(joined < 1);
    CHECK(bodies == kBodies);
    CHECK(turned != 0);

    const double before = frames_per_second(session, *late, 3);
    readers[7].signal(19);  // SIGSTOP
    const double stopped_share = step_thread_share(pid);
    const double during = frames_per_second(session, *late, 3);
    readers[7].signal(18);
    MESSAGE("frames per second: " << before << ", with a stopped reader " << during);
    CHECK(before > 45);
    CHECK(during > 0.8 * before);
    CHECK(stopped_share - alone < 0.01);
    CHECK(late->incomplete() == 0);
    for (Process& reader : readers) reader.signal(9);
    CHECK(server.end() == 0);
}

TEST_CASE("plab/updates sends what moved: a hundredth of the bytes of plab/states, and complete frames with the same bits")
{
    Server server(field_of_bodies(), {"--rate", "real", "--states", "all"});
    const link::Session session = server.session();
    auto complete = session.reader<plab_v2_Frame>();
    auto raw = session.reader<plab_v2_FrameUpdate>();
    auto assembled = link::FrameReader::open(session);
    REQUIRE(complete.ok());
    REQUIRE(raw.ok());
    REQUIRE(assembled.ok());
    std::map<std::uint64_t, std::vector<plab_v2_BodyState>> frames;
    std::size_t compared = 0, differ = 0, deltas = 0, keys = 0, most_in_a_delta = 0;
    const auto end = Clock::now() + std::chrono::seconds(4);
    while (Clock::now() < end)
    {
        (void)session.wait(*assembled, Seconds(0.1));
        (void)complete->take(
            [&](const plab_v2_Frame& f, const dds_sample_info_t& info)
            {
                if (info.valid_data) frames[f.sequence_number].assign(f.bodies._buffer, f.bodies._buffer + f.bodies._length);
            });
        (void)raw->take(
            [&](const plab_v2_FrameUpdate& u, const dds_sample_info_t& info)
            {
                if (!info.valid_data) return;
                ++(u.kind == 0 ? keys : deltas);
                if (u.kind != 0) most_in_a_delta = std::max<std::size_t>(most_in_a_delta, u.body_handles._length);
            });
        (void)assembled->take(
            [&](const plab_v2_Frame& f)
            {
                const auto found = frames.find(f.sequence_number);
                if (found == frames.end()) return;
                ++compared;
                bool same = f.bodies._length == found->second.size();
                for (std::size_t i = 0; same && i < found->second.size(); ++i)
                    same = std::memcmp(&f.bodies._buffer[i].position, &found->second[i].position, 104) == 0 &&
                           f.bodies._buffer[i].handle == found->second[i].handle;
                differ += same ? 0 : 1;
                frames.erase(frames.begin(), found);
            });
    }
    CHECK(compared > 30);
    CHECK(differ == 0);
    CHECK(deltas > 10 * keys);
    CHECK(keys >= 3);
    CHECK(most_in_a_delta == kMoving);
    CHECK(server.end() == 0);
}
