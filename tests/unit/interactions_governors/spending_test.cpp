// Where processor time removes most error, against all possible choices of small problems.
#include "interactions/governors/spending.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "plab/value.h"

using namespace plab;
using namespace plab::governors;

namespace
{

using Levels = std::vector<std::int32_t>;

LevelPrices certain(std::vector<double> cost) { return {cost, cost}; }

double cost_of(const Levels& levels, std::span<const Candidate> candidates, const LevelPrices& prices)
{
    double sum = 0;
    for (std::size_t k = 0; k < levels.size(); ++k) sum += candidates[k].weight * prices.expected[static_cast<std::size_t>(levels[k])];
    return sum;
}

double error_of(const Levels& levels, std::span<const Candidate> candidates)
{
    double sum = 0;
    for (std::size_t k = 0; k < levels.size(); ++k) sum += candidates[k].scale * candidates[k].errors[static_cast<std::size_t>(levels[k])];
    return sum;
}

}  // namespace

TEST_CASE("the step that removes most pixels for a second comes first, and nothing is spent that is not there")
{
    const Reals errors{1, 0.1, 0};
    std::vector<Candidate> two(2);
    for (Candidate& c : two) c.weight = 0.5, c.errors = errors;
    two[1].scale = 5;
    const LevelPrices prices = certain({2, 4, 12});
    CHECK(choose_levels(two, prices, 1.9, 0) == Levels{0, 0});  // the cheapest does not fit: it is all there is
    CHECK(choose_levels(two, prices, 2.9, 0) == Levels{0, 0});
    CHECK(choose_levels(two, prices, 3.1, 0) == Levels{0, 1});
    CHECK(choose_levels(two, prices, 4.1, 0) == Levels{1, 1});
    CHECK(choose_levels(two, prices, 8.1, 0) == Levels{1, 2});
    CHECK(choose_levels(two, prices, 12, 0) == Levels{2, 2});
}

TEST_CASE("a level that costs about as much as a finer one and errs much more is left out")
{
    const Reals errors{60, 50, 1, 0};
    std::vector<Candidate> candidates(10);
    for (Candidate& c : candidates) c.weight = 0.1, c.errors = errors;
    const LevelPrices prices = certain({1, 1.9, 2, 20});
    for (double seconds = 1; seconds < 22; seconds += 0.05)
        for (const std::int32_t level : choose_levels(candidates, prices, seconds, 0)) CHECK(level != 1);
    CHECK(choose_levels(candidates, prices, 2.01, 0) == Levels(10, 2));
}

TEST_CASE("it misses the best choice by at most one step of one candidate")
{
    const std::array<Reals, 2> errors{Reals{9, 4, 0}, Reals{7, 6.5, 0}};
    std::vector<Candidate> candidates(6);
    for (std::size_t k = 0; k < 6; ++k)
        candidates[k].weight = 1.0 / 6, candidates[k].errors = errors[k % 2],
        candidates[k].scale = 1.0 + 0.7 * static_cast<double>(k * k % 5);
    const LevelPrices prices = certain({1, 2, 5});
    double largest = 0;
    for (const Candidate& c : candidates) largest = std::max(largest, c.scale * c.errors[0]);
    for (double seconds = 1; seconds < 5.2; seconds += 0.1)
    {
        const Levels chosen = choose_levels(candidates, prices, seconds, 0);
        CHECK(cost_of(chosen, candidates, prices) <= seconds + 1e-9);
        double best = 1e300;
        for (int n = 0; n < 729; ++n)
        {
            Levels all;
            for (int k = 0, rest = n; k < 6; ++k, rest /= 3) all.push_back(rest % 3);
            if (cost_of(all, candidates, prices) <= seconds + 1e-9) best = std::min(best, error_of(all, candidates));
        }
        CHECK(error_of(chosen, candidates) <= best + largest);
    }
}

TEST_CASE("errors up to the tolerance are not removed, however much time there is")
{
    const Reals errors{1, 0.1, 0};
    std::vector<Candidate> candidates(3);
    for (Candidate& c : candidates) c.weight = 1.0 / 3, c.errors = errors;
    candidates[0].scale = 100, candidates[2].scale = 0.01;
    CHECK(choose_levels(candidates, certain({1, 2, 3}), 1e3, 0.2) == Levels{2, 1, 0});
}

TEST_CASE("a level that a candidate has is taken away only for twice the worth, and one below the least is not given")
{
    const Reals errors{1, 0};
    std::vector<Candidate> candidates(2);
    for (Candidate& c : candidates) c.weight = 0.5, c.errors = errors;
    candidates[0].present = 1, candidates[1].scale = 1.9;
    const LevelPrices prices = certain({1, 2});
    CHECK(choose_levels(candidates, prices, 1.5, 0) == Levels{1, 0});
    candidates[1].scale = 2.1;
    CHECK(choose_levels(candidates, prices, 1.5, 0) == Levels{0, 1});
    candidates[0].least = 1;
    CHECK(choose_levels(candidates, prices, 1.5, 0) == Levels{1, 0});
}

TEST_CASE("of a level of which hardly anything is known, one candidate tries first")
{
    const Reals errors{1, 0};
    std::vector<Candidate> candidates(10);
    for (Candidate& c : candidates) c.weight = 0.1, c.errors = errors;
    candidates[7].scale = 2;
    Levels only(10, 0);
    only[7] = 1;
    CHECK(choose_levels(candidates, {{1, 2}, {1, 200}}, 3, 0) == only);
    CHECK(choose_levels(candidates, certain({1, 2}), 3, 0) == Levels(10, 1));
}
