// Frames that name only moved objects, and the time line of a recording.
#include "idl/recording/whole_frame.h"

#include <doctest/doctest.h>

#include "idl/recording/timeline.h"

using namespace plab::recording;

namespace
{

struct Made
{
    std::vector<plab_v2_BodyState> bodies;
    plab_v2_Frame frame{};

    Made(std::uint64_t run, std::uint64_t revision, const std::vector<std::pair<std::uint32_t, double>>& handles_and_x)
    {
        for (const auto& [handle, x] : handles_and_x) bodies.push_back({handle, {x, 0, 0}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
        frame.run = run, frame.revision = revision;
        frame.bodies._length = frame.bodies._maximum = static_cast<std::uint32_t>(bodies.size());
        frame.bodies._buffer = bodies.data();
    }
};

std::vector<std::pair<std::uint32_t, double>> rows(const plab_v2_Frame& frame)
{
    std::vector<std::pair<std::uint32_t, double>> out;
    for (std::uint32_t i = 0; i < frame.bodies._length; ++i)
        out.emplace_back(frame.bodies._buffer[i].handle, frame.bodies._buffer[i].position.x);
    return out;
}

using FrameRows = std::vector<std::pair<std::uint32_t, double>>;

}  // namespace

TEST_CASE("an object that a frame does not name keeps its last state, until a new run or revision")
{
    WholeFrame whole;
    CHECK(rows(whole.with(Made(1, 1, {{7, 1}, {3, 2}, {5, 3}}).frame)) == FrameRows{{7, 1}, {3, 2}, {5, 3}});
    CHECK(rows(whole.with(Made(1, 1, {{3, 20}}).frame)) == FrameRows{{7, 1}, {3, 20}, {5, 3}});
    CHECK(rows(whole.with(Made(1, 1, {}).frame)) == FrameRows{{7, 1}, {3, 20}, {5, 3}});
    CHECK(rows(whole.with(Made(1, 1, {{5, 30}, {7, 10}}).frame)) == FrameRows{{7, 10}, {3, 20}, {5, 30}});
    CHECK(rows(whole.with(Made(1, 2, {{7, 0}, {9, 1}}).frame)) == FrameRows{{7, 0}, {9, 1}});
    CHECK(rows(whole.with(Made(2, 2, {{3, 4}}).frame)) == FrameRows{{3, 4}});
    whole.forget();
    CHECK(rows(whole.with(Made(2, 2, {{9, 5}}).frame)) == FrameRows{{9, 5}});
}

TEST_CASE("the time line continues when a run begins again, at zero or at any time")
{
    Timeline line;
    CHECK(line.at(1, 2.5) == 0);  // the recording begins here
    CHECK(line.at(1, 3.5) == 1'000'000'000);
    CHECK(line.now() == 1'000'000'000);
    CHECK(line.at(2, 0) == 1'000'000'000);  // reset
    CHECK(line.at(2, 0.25) == 1'250'000'000);
    CHECK(line.at(3, 2) == 1'250'000'000);  // rewound to 2 s
    CHECK(line.at(3, 2.5) == 1'750'000'000);
    CHECK(line.seconds(3, 1'750'000'000) == doctest::Approx(2.5));
    CHECK(line.at(1, 2) == 0);                // a sample from before the beginning of the recording
    CHECK(line.at(3, 1.5) == 1'250'000'000);  // from before the run was seen: at its beginning
    CHECK(line.at(2, 0.5) == 1'250'000'000);  // from after the next run was seen
    CHECK(line.at(2, 0.125) == 1'125'000'000);
    CHECK(line.now() == 1'750'000'000);
}
