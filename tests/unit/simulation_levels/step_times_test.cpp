// What governors that spend time are told of steps: what is usual, and how far steps exceed it.
#include "simulation/levels/step_times.h"

#include <doctest/doctest.h>

using namespace plab::simulation;

namespace
{

void add(StepTimes& times, int count, double seconds)
{
    for (int k = 0; k < count; ++k) times.add({2 * seconds, seconds});
}

}  // namespace

TEST_CASE("what is usual is the median of the steps since the levels changed, and one long step does not tell it")
{
    StepTimes times;
    CHECK(times.usual().processor == 0);
    add(times, 10, 5e-3), times.begin_anew();
    CHECK(times.count() == 0);
    add(times, 1, 3e-3), add(times, 3, 1e-3);
    CHECK(times.count() == 4);
    CHECK(times.usual().processor == doctest::Approx(1e-3));
    CHECK(times.usual().wall == doctest::Approx(2e-3));
}

TEST_CASE("the spread is how many times what was usual at their time 99 of 100 steps took, whatever has changed since")
{
    StepTimes times;
    CHECK(times.spread().processor == 1);
    // Two long steps among 100, at two levels: 1.5 and 1.4 times what is usual.
    add(times, 49, 2e-3), add(times, 1, 3e-3), times.begin_anew();
    add(times, 49, 10e-3), add(times, 1, 14e-3), times.begin_anew();
    CHECK(times.spread().processor == doctest::Approx(1.4));
    // Too few steps tell nothing: their median is chance.
    add(times, 1, 1e-3), add(times, 2, 9e-3), times.begin_anew();
    CHECK(times.spread().processor == doctest::Approx(1.4));
    // What is long ago is forgotten.
    for (int k = 0; k < 6; ++k) add(times, 100, 1e-3), times.begin_anew();
    CHECK(times.spread().processor == doctest::Approx(1));
}

TEST_CASE("where no level has changed, steps that all take longer than what was told are spread too")
{
    StepTimes times;
    add(times, 100, 2e-3), times.go_on();
    CHECK(times.spread().processor == doctest::Approx(1));
    add(times, 90, 2e-3), add(times, 10, 3e-3), times.go_on();
    CHECK(times.spread().processor == doctest::Approx(1.5));
    add(times, 100, 3.6e-3), times.go_on();  // the machine is busy: 1.8 times what was usual
    CHECK(times.spread().processor == doctest::Approx(1.8));
    add(times, 100, 3.6e-3), times.begin_anew();  // as usual now
    add(times, 100, 9e-3), times.begin_anew();    // with other levels
    CHECK(times.spread().processor == doctest::Approx(1.8));
}

TEST_CASE("what is recent is the median of the last seven steps")
{
    StepTimes times;
    add(times, 6, 1e-3);
    CHECK(times.recent().processor == 0);
    add(times, 20, 1e-3), add(times, 4, 3e-3);
    CHECK(times.recent().processor == doctest::Approx(3e-3));
    CHECK(times.recent().wall == doctest::Approx(6e-3));
    CHECK(times.usual().processor == doctest::Approx(1e-3));
    times.go_on();
    CHECK(times.recent().processor == 0);
}
