// Many bodies: 10,000, of which 100 move. What they cost with many readers is tested by scale_long_test.cpp.
#include <cstring>
#include <map>

#include "field_of_bodies.h"
#include "link/frame_reader.h"

using namespace plab;
using namespace plab::test;
using Clock = std::chrono::steady_clock;

TEST_CASE("a late joiner of 10,000 bodies is complete within a second")
{
    Server server(field_of_bodies(), {"--rate", "real"});
    const link::Session session = server.session();
    std::this_thread::sleep_for(Milliseconds(500));  // the first key frame has been sent by now
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
    CHECK(late->incomplete() == 0);
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
