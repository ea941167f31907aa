// Frames as key frames and deltas, and complete again. No bus: what is sent is what is given on.
#include "link/frame_reader.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <random>

#include "idl/frame_updates.h"

using namespace plab;
using Clock = wire::FrameUpdates::Clock;
using std::chrono::milliseconds;

namespace
{

/// A scene of bodies and one shaft, whose frames count from 1.
struct SentScene
{
    explicit SentScene(std::size_t bodies) : bodies_(bodies)
    {
        frame.run = 3, frame.revision = 5;
        for (std::size_t i = 0; i < bodies; ++i)
        {
            const auto x = static_cast<double>(i);
            bodies_[i] = {static_cast<std::uint32_t>(2 * i + 1), {x, x + 1, x + 2}, {1, 0, 0, 0}, {x, 0, -x}, {0, x, 1}};
        }
        shafts_ = {{7000, 1.5, -2}};
    }
    const plab_v2_Frame& next()
    {
        ++frame.sequence_number, ++frame.step, frame.time += 1.0 / 60, frame.stamp_ns += 16'666'667;
        const auto n = static_cast<std::uint32_t>(bodies_.size()), m = static_cast<std::uint32_t>(shafts_.size());
        frame.bodies = {n, n, bodies_.data(), false}, frame.shafts = {m, m, shafts_.data(), false};
        return frame;
    }
    plab_v2_BodyState& body(std::size_t i) { return bodies_[i]; }
    std::vector<plab_v2_BodyState>& bodies() { return bodies_; }
    plab_v2_ShaftState& shaft() { return shafts_[0]; }

    plab_v2_Frame frame{};

private:
    std::vector<plab_v2_BodyState> bodies_;
    std::vector<plab_v2_ShaftState> shafts_;
};

template <class Sequence>
auto copy(const Sequence& s)
{
    return std::vector<std::remove_cvref_t<decltype(*s._buffer)>>(s._buffer, s._buffer + s._length);
}

/// A copy, as DDS makes one on its way.
class Sent
{
public:
    explicit Sent(const plab_v2_FrameUpdate& u)
        : update(u),
          body_handles_(copy(u.body_handles)),
          shaft_handles_(copy(u.shaft_handles)),
          bodies_(copy(u.bodies)),
          shafts_(copy(u.shafts))
    {
        update.body_handles._buffer = body_handles_.data(), update.bodies._buffer = bodies_.data();
        update.shaft_handles._buffer = shaft_handles_.data(), update.shafts._buffer = shafts_.data();
    }
    Sent(const Sent& other) : Sent(other.update) {}
    plab_v2_FrameUpdate update;

private:
    std::vector<std::uint32_t> body_handles_, shaft_handles_;
    std::vector<double> bodies_, shafts_;
};

std::size_t bytes(const plab_v2_FrameUpdate& u)
{
    return 4 * (u.body_handles._length + u.shaft_handles._length) + 8 * (u.bodies._length + u.shafts._length);
}

template <class State>
bool same(const State& a, const State& b)
{
    return a.handle == b.handle &&
           std::memcmp(reinterpret_cast<const char*>(&a) + 8, reinterpret_cast<const char*>(&b) + 8, sizeof a - 8) == 0;
}

/// Bit for bit.
bool same(const plab_v2_Frame& a, const plab_v2_Frame& b)
{
    bool out = a.run == b.run && a.revision == b.revision && a.sequence_number == b.sequence_number && a.step == b.step &&
               a.time == b.time && a.stamp_ns == b.stamp_ns && a.bodies._length == b.bodies._length && a.shafts._length == b.shafts._length;
    for (std::uint32_t i = 0; out && i < a.bodies._length; ++i) out = same(a.bodies._buffer[i], b.bodies._buffer[i]);
    for (std::uint32_t i = 0; out && i < a.shafts._length; ++i) out = same(a.shafts._buffer[i], b.shafts._buffer[i]);
    return out;
}

}  // namespace

TEST_CASE("what rests is not sent again, and the assembled frame has every bit")
{
    SentScene scene(100);
    wire::FrameUpdates updates;
    link::FrameAssembler assembler;
    const Clock::time_point now{};
    const auto pass = [&]() -> const plab_v2_FrameUpdate&
    {
        const plab_v2_FrameUpdate& update = updates.next(scene.next(), now);
        const plab_v2_Frame* const frame = assembler.add(update);
        REQUIRE(frame != nullptr);
        CHECK(same(*frame, scene.frame));
        return update;
    };
    CHECK(pass().kind == wire::kKeyFrame);
    CHECK(pass().body_handles._length == 0);
    scene.body(40).position.x = 17;
    scene.shaft().angle = 9;
    const plab_v2_FrameUpdate& delta = pass();
    CHECK(delta.kind == wire::kDelta);
    CHECK(delta.key_number == 1);
    REQUIRE(delta.body_handles._length == 1);
    CHECK(delta.body_handles._buffer[0] == 81);
    CHECK(delta.bodies._buffer[0] == 17);
    CHECK(delta.shaft_handles._length == 1);
    // One bit is enough: the sign of a zero.
    scene.body(3).linear_velocity.y = -0.0;
    CHECK(pass().body_handles._length == 2);
    // Back to the values of the key frame: sent still, or readers that have the earlier delta would keep the other ones.
    scene.body(40).position.x = 40;
    CHECK(pass().body_handles._length == 2);
    CHECK(assembler.incomplete() == 0);
}

TEST_CASE("any delta completes its key frame, whichever were lost; without the key frame nothing is passed on until the next one")
{
    std::mt19937 random(1);
    SentScene scene(50);
    wire::FrameUpdates updates;
    link::FrameAssembler assembler, late;
    Clock::time_point now{};
    int passed = 0, keys = 0, late_passed = 0;
    bool late_has_key = false;
    for (int i = 0; i < 2000; ++i)
    {
        for (int k = 0; k < 2; ++k) scene.body(random() % 20).position.x += static_cast<double>(random() % 3) - 1;
        now += milliseconds(16);
        const plab_v2_FrameUpdate& update = updates.next(scene.next(), now);
        const bool is_key = update.kind == wire::kKeyFrame;
        keys += is_key ? 1 : 0;
        // Of the deltas, one in ten arrives.
        if (is_key || random() % 10 == 0)
        {
            const plab_v2_Frame* const frame = assembler.add(update);
            REQUIRE(frame != nullptr);
            REQUIRE(same(*frame, scene.frame));
            ++passed;
        }
        // This reader loses half of the key frames too.
        if (is_key) late_has_key = random() % 2 == 0;
        if (is_key && !late_has_key) continue;
        const plab_v2_Frame* const frame = late.add(update);
        REQUIRE((frame != nullptr) == late_has_key);
        if (frame == nullptr) continue;
        REQUIRE(same(*frame, scene.frame));
        ++late_passed;
    }
    CHECK(assembler.incomplete() == 0);
    CHECK(late.incomplete() > 0);
    CHECK(keys < 200);
    CHECK(passed > keys + 100);
    CHECK(late_passed > 500);
}

TEST_CASE("a key frame comes within a second, with a new reader, run, revision or object")
{
    SentScene scene(10);
    wire::FrameUpdates updates;
    Clock::time_point now{};
    const auto is_key = [&] { return updates.next(scene.next(), now).kind == wire::kKeyFrame; };
    CHECK(is_key());
    int deltas = 0;
    for (; !is_key(); now += milliseconds(16)) ++deltas;
    CHECK(deltas > 30);
    CHECK(now.time_since_epoch() < milliseconds(1000));
    CHECK_FALSE(is_key());
    updates.restart();
    CHECK(is_key());
    CHECK_FALSE(is_key());
    ++scene.frame.run;
    CHECK(is_key());
    ++scene.frame.revision;
    CHECK(is_key());
    scene.bodies().pop_back();
    CHECK(is_key());
    scene.body(2).handle = 500;
    CHECK(is_key());
    CHECK_FALSE(is_key());
}

TEST_CASE("a delta is never larger than a key frame; if everything moves, every frame is a key frame")
{
    SentScene scene(64);
    wire::FrameUpdates updates;
    const Clock::time_point now{};
    const std::size_t whole = bytes(updates.next(scene.next(), now));
    for (int i = 0; i < 10; ++i)
    {
        for (plab_v2_BodyState& b : scene.bodies()) b.position.z -= 0.125;
        scene.shaft().angle += 1;
        const plab_v2_FrameUpdate& update = updates.next(scene.next(), now);
        CHECK(update.kind == wire::kKeyFrame);
        CHECK(bytes(update) == whole);
    }
    // A wave: each body moves once. All together cost at most twice what moves and the key frames.
    std::size_t sent = 0, necessary = 0;
    for (std::size_t i = 0; i < 640; ++i)
    {
        scene.body(i % 64).position.z += 1;
        const plab_v2_FrameUpdate& update = updates.next(scene.next(), now);
        CHECK(bytes(update) <= whole);
        sent += bytes(update), necessary += 108;
    }
    CHECK(sent < 640 * whole / 4);
    CHECK(sent > necessary);
}

TEST_CASE("updates that are not valid are dropped and counted")
{
    SentScene scene(4);
    wire::FrameUpdates updates;
    link::FrameAssembler assembler;
    const Clock::time_point now{};
    const Sent key(updates.next(scene.next(), now));
    scene.body(1).position.x = 5;
    const Sent delta(updates.next(scene.next(), now));
    Sent bent(delta);
    CHECK(assembler.add(delta.update) == nullptr);  // its key frame is missing
    REQUIRE(assembler.add(key.update) != nullptr);
    bent.update.bodies._length -= 1;
    CHECK(assembler.add(bent.update) == nullptr);
    Sent other(delta);
    other.update.key_number = 77;
    CHECK(assembler.add(other.update) == nullptr);
    REQUIRE(assembler.add(delta.update) != nullptr);
    CHECK(assembler.add(delta.update) == nullptr);  // not newer
    Sent stranger(delta);
    stranger.update.sequence_number = 9, stranger.update.body_handles._buffer[0] = 4711;
    CHECK(assembler.add(stranger.update) == nullptr);
    CHECK(assembler.incomplete() == 5);
    CHECK(assembler.add(key.update) != nullptr);  // a key frame makes it complete again
}
