// Frames that name only moved objects.
#include <doctest/doctest.h>

#include "record/moved.h"

namespace plab::test
{
namespace
{

wire::Frame frame_of(double time, double x0, double x1)
{
    wire::Frame frame;
    frame.run = 1, frame.time = time;
    frame.bodies.resize(2);
    frame.bodies[0].handle = 1, frame.bodies[0].position.x = x0;
    frame.bodies[1].handle = 2, frame.bodies[1].position.x = x1;
    frame.shafts = {{3, 0.5, 0}};
    return frame;
}

}  // namespace

TEST_CASE("objects that do not move are left out, until a full frame is due")
{
    record::MovedFilter filter(1.0);
    CHECK(filter.thin(frame_of(0, 0, 0)).bodies.size() == 2);
    const wire::Frame second = filter.thin(frame_of(0.1, 0, 0.25));
    REQUIRE(second.bodies.size() == 1);
    CHECK(second.bodies[0].handle == 2);
    CHECK(second.bodies[0].position.x == 0.25);
    CHECK(second.shafts.empty());
    CHECK(second.time == 0.1);
    CHECK(filter.thin(frame_of(0.2, 0, 0.25)).bodies.empty());
    // -0 is not 0: a replay distinguishes them, and so do files.
    CHECK(filter.thin(frame_of(0.3, -0.0, 0.25)).bodies.size() == 1);
    CHECK(filter.thin(frame_of(1.0, -0.0, 0.25)).bodies.size() == 2);
    CHECK(filter.thin(frame_of(1.1, -0.0, 0.25)).bodies.empty());
}

TEST_CASE("a new run, a new revision or another number of bodies begins with a full frame")
{
    record::MovedFilter filter(10.0);
    (void)filter.thin(frame_of(0, 0, 0));
    wire::Frame run = frame_of(0.1, 0, 0);
    run.run = 2;
    CHECK(filter.thin(run).bodies.size() == 2);
    wire::Frame revision = run;
    revision.revision = 5, revision.time = 0.2;
    CHECK(filter.thin(revision).bodies.size() == 2);
    wire::Frame fewer = revision;
    fewer.bodies.pop_back(), fewer.time = 0.3;
    CHECK(filter.thin(fewer).bodies.size() == 1);
}

}  // namespace plab::test
