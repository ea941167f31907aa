#include "link/sequence.h"

#include <doctest/doctest.h>

using plab::link::Sequence;

TEST_CASE("a jump in the numbers means missing entries")
{
    Sequence numbers;
    CHECK(numbers.note(1, 100, 3).count == 0);  // before the reader joined: no loss
    CHECK(numbers.note(1, 103, 1).count == 0);
    const auto missing = numbers.note(1, 116, 1);
    CHECK(missing.first == 104);
    CHECK(missing.count == 12);
    CHECK(numbers.note(2, 1, 1).count == 0);  // a restarted server
    CHECK(numbers.note(2, 3, 1).count == 1);
    CHECK(numbers.note(1, 117, 1).count == 0);
}

TEST_CASE("a writer that replaces another continues its numbers: entries lost between them are missing")
{
    Sequence numbers;
    CHECK(numbers.note(1, 100, 3).count == 0);
    const auto missing = numbers.note(2, 115, 1);
    CHECK(missing.first == 103);
    CHECK(missing.count == 12);
    CHECK(numbers.note(2, 116, 1).count == 0);
    CHECK(numbers.note(3, 117, 2).count == 0);
    CHECK(numbers.note(2, 117, 1).count == 0);  // late
    CHECK(numbers.note(4, 119, 1).count == 0);
    numbers.forget();
    CHECK(numbers.note(5, 500, 1).count == 0);
}
