// What a few trial steps tell about all components that are alike.
#include "interactions/governors/error_table.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace plab;
using namespace plab::governors;

TEST_CASE("the root mean square of the trials, for each kind")
{
    Reals state;
    ErrorTable table(state, 3);
    CHECK(table.trials(2) == 0);
    table.add(2, 0, Reals{3, 0.3, 0}), table.add(2, 0, Reals{4, 0.4, 0}), table.add(5, 0, Reals{7, 1, 0});
    CHECK(table.trials(2) == 2);
    CHECK(table.trials(5) == 1);
    CHECK(table.errors(2, 0)[0] == doctest::Approx(std::sqrt(12.5)));
    CHECK(table.errors(2, 0)[1] == doctest::Approx(std::sqrt(0.125)));
    CHECK(table.errors(2, 0)[2] == 0);
    CHECK(table.errors(5, 0)[0] == doctest::Approx(7));
}

TEST_CASE("of what was never tried, and of levels that do not differ, finer is a little better")
{
    Reals state;
    ErrorTable table(state, 3);
    for (const std::uint32_t kind : {1u, 2u})
    {
        CHECK(table.errors(kind, 0)[0] > table.errors(kind, 0)[1]);
        CHECK(table.errors(kind, 0)[1] > 0);
        CHECK(table.errors(kind, 0)[0] < 1e-11);
        table.add(2, 0, Reals{0, 0, 0});
    }
}

TEST_CASE("old trials fade")
{
    Reals state;
    ErrorTable table(state, 2);
    for (int n = 0; n < 100; ++n) table.add(1, 0, Reals{1, 0});
    for (int n = 0; n < 200; ++n) table.add(1, 0, Reals{0.01, 0});
    CHECK(table.errors(1, 0)[0] < 0.1);
    CHECK(table.errors(1, 0)[0] >= 0.01);
}

TEST_CASE("however many kinds there are, the table is bounded")
{
    Reals state;
    ErrorTable table(state, 2);
    for (std::uint32_t kind = 1; kind < 10'000; ++kind) table.add(kind, 0, Reals{static_cast<double>(kind), 0});
    CHECK(state.size() <= 64 * 5);
    CHECK(table.errors(3, 0)[0] == doctest::Approx(3));
    CHECK(table.errors(9'000, 0)[0] > 0);
}

TEST_CASE("what a component had until now counts: of what is exact, more is to be lost than of what was damped")
{
    Reals state;
    ErrorTable table(state, 3);
    table.add(2, 0, Reals{0.1, 0.01, 0}), table.add(2, 0, Reals{0.1, 0.01, 0});
    CHECK(table.errors(2, 2)[0] == doctest::Approx(0.1));  // as long as nothing is known of those
    table.add(2, 2, Reals{5, 0.2, 0});
    CHECK(table.errors(2, 0)[0] == doctest::Approx(0.1));
    CHECK(table.errors(2, 2)[0] > 4);  // its own trial counts twice as much as what was taken over
    for (int k = 0; k < 80; ++k) table.add(2, 0, Reals{1e-3, 1e-4, 0});
    CHECK(table.errors(2, 0)[0] < 0.01);
    CHECK(table.errors(2, 1)[0] == doctest::Approx(0.1));  // what the first one told, when no level had changed anything
    CHECK(table.errors(3, 2)[0] < 1e-11);
    CHECK(table.trials(2, 2) == 1);
    CHECK(table.trials(2) == 13);  // 12 are remembered of the first level
}
