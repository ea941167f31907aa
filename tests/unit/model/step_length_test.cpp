/// Step lengths are exact fractions.
#include <doctest/doctest.h>

#include "model/values.h"

using namespace plab;
using namespace plab::model;

TEST_CASE("step lengths are exact fractions if possible")
{
    struct Row
    {
        const char* text;
        std::int64_t numerator, denominator;
    };
    const Row rows[] = {
        {"1/60", 1, 60},   {"1/240 s", 1, 240},  {"0.001", 1, 1000}, {"2 ms", 1, 500},
        {"1e-3", 1, 1000}, {"1/4 ms", 1, 4000},  {"0.5/60", 1, 120}, {"2/120", 1, 60},
        {"1", 1, 1},       {"10 us", 1, 100000}, {"1 min", 60, 1},   {"1e2", 100, 1},
        {"0.0125", 1, 80}, {" 1/60\n", 1, 60},   {"+0.002", 1, 500}, {"0.0166667", 166667, 10000000},
    };
    for (const Row& row : rows)
    {
        CAPTURE(row.text);
        const Result<StepLength> dt = parse_step_length(row.text);
        REQUIRE(dt.ok());
        CHECK(dt->numerator == row.numerator);
        CHECK(dt->denominator == row.denominator);
        CHECK(dt->seconds == static_cast<double>(row.numerator) / static_cast<double>(row.denominator));
    }
    CHECK(parse_step_length("1/60")->at(60) == 1.0);
    CHECK(parse_step_length("1/60")->at(3600 * 60) == 3600.0);
}

TEST_CASE("a step length that is not a small fraction is stored in seconds")
{
    // n * 1666666667 would overflow 64 bits within a realistic run.
    for (const char* text : {"0.016666666666666666", "0.01666666667", "1e-8 min", "1/3e-17 us"})
    {
        CAPTURE(text);
        const Result<StepLength> dt = parse_step_length(text);
        CHECK((!dt || dt->denominator == 0 || dt->numerator <= 100'000'000));
    }
    const Result<StepLength> dt = parse_step_length("0.016666666666666666");
    REQUIRE(dt.ok());
    CHECK(dt->denominator == 0);
    CHECK(dt->seconds == 0.016666666666666666);
    CHECK(dt->at(3) == 3 * 0.016666666666666666);
}

TEST_CASE("step lengths that are refused")
{
    const auto why = [](const char* text)
    {
        const Result<StepLength> dt = parse_step_length(text);
        return dt ? std::string("accepted") : dt.error().reason;
    };
    CHECK(why("") == "dt is empty: give a time such as 1/240 or 2 ms");
    CHECK(why("0") == "dt must be positive, not 0");
    CHECK(why("-1/60") == "dt must be positive, not -1/60");
    CHECK(why("1/0") == "dt: '1/0' divides by zero");
    CHECK(why("inf") == "dt must be between 1e-9 s and 3600 s, not inf");
    CHECK(why("1e30") == "dt must be between 1e-9 s and 3600 s, not 1e30");
    CHECK(why("1e-12") == "dt must be between 1e-9 s and 3600 s, not 1e-12");
    CHECK(why("nan") == "dt: 'nan' is not a finite number");
    CHECK(why("1,5") == "dt: '1,5': use a point, not a comma, in numbers, and spaces between them");
    CHECK(why("60 Hz") == "dt must be in s (or ms, us, min, h), not in 'Hz'");
    CHECK(why("1 m") == "dt must be in s (or ms, us, min, h), not in 'm'");
    CHECK(why("1 2") == "dt: '2' is not a unit");
}
