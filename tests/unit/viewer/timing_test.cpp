// Which states become pictures: interpolation, the grid of frames, the bounded buffer, the command line.
#include <doctest/doctest.h>

#include <cmath>

#include "plab/rotation.h"
#include "viewer/options.h"
#include "viewer/sequence.h"

namespace
{

using namespace plab;
using namespace plab::view;

State state_at(double time, std::uint64_t run = 1)
{
    State s{run, 0, static_cast<std::int64_t>(std::llround(time * 240)), time, {}, {}};
    s.bodies.push_back({1, {{time, 0, 0}, exp_rotation({0, 0, time})}});
    s.shafts.push_back({2, 10 * time});
    return s;
}

struct Drawn
{
    std::uint64_t index;
    double time, x;
};

/// Supplies states of these times, and returns what was drawn.
std::vector<Drawn> frames_of(Sequence& sequence, const std::vector<State>& states)
{
    std::vector<Drawn> out;
    for (const State& s : states)
    {
        const auto drawn = sequence.advance({s, nullptr},
                                            [&](std::uint64_t index, const Moment& m) -> Result<void>
                                            {
                                                out.push_back({index, m.state.time, m.state.bodies.at(0).pose.p.x});
                                                return {};
                                            });
        REQUIRE(drawn.ok());
    }
    return out;
}

std::vector<State> states_from(double first, double last, double spacing)
{
    std::vector<State> out;
    for (int i = 0; first + i * spacing <= last + 1e-9; ++i) out.push_back(state_at(first + i * spacing));
    return out;
}

std::optional<ParseEnd> parse(std::vector<const char*> words, ViewerOptions& options)
{
    words.insert(words.begin(), "plab-view");
    return parse_options(static_cast<int>(words.size()), words.data(), options);
}

}  // namespace

TEST_CASE("between two states positions and angles are interpolated linearly, orientations by the shorter rotation at a constant rate")
{
    State a = state_at(1), b = state_at(1.4);
    b.bodies[0].pose.q = {-b.bodies[0].pose.q.w, 0, 0, -b.bodies[0].pose.q.z};  // the same rotation
    b.bodies.push_back({5, {}});
    const State mid = interpolate(a, b, 1.1);
    CHECK(mid.time == 1.1);
    CHECK(mid.step == a.step);
    REQUIRE(mid.bodies.size() == 1);  // 5 appears with b
    CHECK(mid.bodies[0].pose.p.x == doctest::Approx(1.1).epsilon(1e-12));
    const Vec3 turned = log_rotation(mid.bodies[0].pose.q);
    CHECK(turned.z == doctest::Approx(1.1).epsilon(1e-12));
    CHECK(mid.shafts[0].angle == doctest::Approx(11).epsilon(1e-12));
    CHECK(interpolate(a, b, 1.4).bodies.size() == 2);
    CHECK(interpolate(b, a, 1.0).bodies.size() == 1);
}

TEST_CASE("frames are at equal intervals of simulated time, whenever states arrive")
{
    Sequence sequence({.per_second = 10, .origin = {}, .duration = 0.5, .until = {}});
    const auto frames = frames_of(sequence, states_from(2.0, 3.0, 0.07));
    REQUIRE(frames.size() == 5);
    CHECK(sequence.done());
    for (std::size_t i = 0; i < frames.size(); ++i)
    {
        CHECK(frames[i].index == i);
        CHECK(frames[i].time == doctest::Approx(2.0 + 0.1 * static_cast<double>(i)).epsilon(1e-12));
        CHECK(frames[i].x == doctest::Approx(frames[i].time).epsilon(1e-12));
    }
    CHECK(sequence.widest_gap() == doctest::Approx(0.07));
}

TEST_CASE("the last frame is at --until, and it takes no state beyond it")
{
    Sequence sequence({.per_second = 5, .origin = 0.0, .duration = {}, .until = 1.0});
    const auto frames = frames_of(sequence, states_from(0, 1.0, 1.0 / 240));
    CHECK(frames.size() == 6);
    CHECK(frames.back().time == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(sequence.done());
}

TEST_CASE("frames before the first state are counted, not invented")
{
    Sequence sequence({.per_second = 10, .origin = 0.0, .duration = 1.0, .until = {}});
    const auto frames = frames_of(sequence, states_from(0.35, 1.0, 0.01));
    REQUIRE(frames.size() == 6);
    CHECK(frames.front().index == 4);
    CHECK(frames.front().time == doctest::Approx(0.4));
    CHECK(sequence.missing() == 4);
    CHECK(sequence.drawn() == 6);
}

TEST_CASE("a new run continues with the next number at its own first time")
{
    Sequence sequence({.per_second = 10, .origin = {}, .duration = 0.6, .until = {}});
    auto states = states_from(1.0, 1.25, 0.05);
    for (const double time : {0.0, 0.05, 0.1, 0.2, 0.3}) states.push_back(state_at(time, 2));
    const auto frames = frames_of(sequence, states);
    REQUIRE(frames.size() == 6);
    CHECK(frames[2].time == doctest::Approx(1.2));
    CHECK(frames[3].time == 0.0);
    CHECK(frames[5].time == doctest::Approx(0.2));
    CHECK(sequence.runs() == 2);
}

TEST_CASE("the buffer keeps the first and the last state of each cell of the grid")
{
    MomentBuffer buffer({10, 0.0});
    for (int i = 0; i <= 100; ++i) buffer.push({state_at(0.01 * i / 4 + 0.001), nullptr});
    std::vector<double> times;
    while (const auto m = buffer.pop(link::Seconds(0))) times.push_back(m->state.time);
    REQUIRE(times.size() == 6);
    CHECK(times[0] == doctest::Approx(0.001));
    CHECK(times[1] == doctest::Approx(0.0985));
    CHECK(times[2] == doctest::Approx(0.101));
    CHECK(times[5] == doctest::Approx(0.251));
    CHECK(buffer.given_up() == 0);
}

TEST_CASE("a full buffer keeps the oldest states and the newest one, and counts those that it dropped")
{
    MomentBuffer buffer({}, 4);
    for (int i = 0; i < 10; ++i) buffer.push({state_at(i), nullptr});
    std::vector<double> times;
    while (const auto m = buffer.pop(link::Seconds(0))) times.push_back(m->state.time);
    CHECK(times == std::vector<double>{0, 1, 2, 9});
    CHECK(buffer.given_up() == 6);
    CHECK_FALSE(buffer.closed());
    buffer.push({state_at(11), nullptr});
    buffer.close("gone");
    CHECK_FALSE(buffer.closed());  // one is left to take
    CHECK(buffer.pop(link::Seconds(0)).has_value());
    CHECK(buffer.closed() == "gone");
}

TEST_CASE("shots and vectors on the command line")
{
    const auto shot = parse_shot("1.25@behind=a=b.png");
    REQUIRE(shot.ok());
    CHECK(shot->at == 1.25);
    CHECK(shot->camera == "behind");
    CHECK(shot->file == "a=b.png");
    for (const char* bad : {"1.2", "=f.png", "x=f.png", "1@=f.png", "1=", "-1=f.png", "1 =f.png"}) CHECK_FALSE(parse_shot(bad).ok());
    CHECK(*parse_vector("1 -2.5,3e1") == Vec3{1, -2.5, 30});
    for (const char* bad : {"", "1 2", "1 2 3 4", "1 2 x", "1 2 nan"}) CHECK_FALSE(parse_vector(bad).ok());
}

TEST_CASE("wrong use ends with code 2 and the reason")
{
    const auto says = [](std::vector<const char*> words)
    {
        ViewerOptions options;
        const auto end = parse(std::move(words), options);
        return end ? std::to_string(end->exit_code) + " " + end->text : std::string("fine");
    };
    CHECK(says({"--png", "a.png", "--at", "2", "--from", "1 2 3"}) == "fine");
    CHECK(says({"--mp4", "a.mp4", "--orbit", "0", "--until", "3"}) == "fine");
    CHECK(says({}) == "2 plab-view: needs an output: --png, --shot, --frames or --mp4; see plab-view --help\n");
    CHECK(says({"--png", "a.png", "--mp4", "b.mp4"}).substr(0, 2) == "2 ");
    CHECK(says({"--png", "a.png", "--until", "3"}).substr(0, 2) == "2 ");
    CHECK(says({"--frames", "d", "--until", "3", "--duration", "1"}).substr(0, 2) == "2 ");
    CHECK(says({"--frames", "d", "--until", "3", "--at", "4"}) == "2 plab-view: --until is before --at\n");
    CHECK(says({"--png", "a.png", "--camera", "x", "--from", "1 2 3"}).substr(0, 2) == "2 ");
    CHECK(says({"--png", "a.png", "--from", "1 2"}) == "2 plab-view: --from: needs three numbers, \"x y z\", not '1 2'\n");
    CHECK(says({"--png", "a.png", "--width", "8"}).substr(0, 2) == "2 ");
    CHECK(says({"--help"}).substr(0, 2) == "0 ");
}

TEST_CASE("shots are taken in the order of their times, the present one first")
{
    ViewerOptions options;
    REQUIRE_FALSE(parse({"--shot", "2=b.png", "--shot", "0.5@x=a.png", "--png", "now.png"}, options));
    REQUIRE(options.shots.size() == 3);
    CHECK(options.shots[0].file == "now.png");
    CHECK(options.shots[1].file == "a.png");
    CHECK(options.shots[2].file == "b.png");
}
