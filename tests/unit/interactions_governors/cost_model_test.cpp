// What a step costs by levels: learnt from the sums alone.
#include "interactions/governors/cost_model.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace plab;
using namespace plab::governors;

namespace
{

constexpr std::array<double, 3> kTrue{2e-3, 5e-3, 40e-3};

double cost_of(const std::array<double, 3>& fraction)
{
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += fraction[k] * kTrue[k];
    return sum;
}

}  // namespace

TEST_CASE("from steps with different mixtures of levels, the cost of each level")
{
    Reals state;
    CostModel model(state, 3);
    CHECK_FALSE(model.is_known());
    const std::array<std::array<double, 3>, 4> mixtures{{{1, 0, 0}, {0.5, 0.5, 0}, {0.2, 0.7, 0.1}, {0, 0.6, 0.4}}};
    for (int n = 0; n < 200; ++n)
        model.update(mixtures[static_cast<std::size_t>(n % 4)], cost_of(mixtures[static_cast<std::size_t>(n % 4)]));
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::fabs(model.cost(k) - kTrue[k]) < 0.1 * kTrue[k]);
    for (std::size_t k = 0; k < 3; ++k) CHECK(model.deviation(k) < 0.3 * kTrue[k]);
}

TEST_CASE(
    "a level that was never seen is guessed dearer, with a deviation as large as the guess; the seen one is known after the first step")
{
    Reals state;
    CostModel model(state, 3);
    for (int n = 0; n < 20; ++n) model.update(std::array<double, 3>{1, 0, 0}, 2e-3);
    CHECK(model.cost(0) == doctest::Approx(2e-3).epsilon(1e-9));
    CHECK(model.cost(1) == doctest::Approx(6e-3).epsilon(1e-9));
    CHECK(model.deviation(1) == doctest::Approx(6e-3).epsilon(1e-9));
    CHECK(model.deviation(0) < 0.3e-3);
    // A tenth of the components there: what they cost more is seen at once.
    const double cost = cost_of({0.9, 0.1, 0});
    for (int n = 0; n < 40; ++n) model.update(std::array<double, 3>{0.9, 0.1, 0}, cost);
    CHECK(0.9 * model.cost(0) + 0.1 * model.cost(1) == doctest::Approx(cost).epsilon(1e-2));
}

TEST_CASE("costs that change are followed")
{
    Reals state;
    CostModel model(state, 2);
    for (int n = 0; n < 50; ++n) model.update(std::array<double, 2>{1, 0}, 1e-3);
    for (int n = 0; n < 60; ++n) model.update(std::array<double, 2>{1, 0}, 3e-3);
    CHECK(model.cost(0) == doctest::Approx(3e-3).epsilon(0.05));
}

TEST_CASE("trial steps tell a difference before a step has been made with the level, and steps tell it better")
{
    Reals state;
    CostModel model(state, 3);
    model.update_difference(1, 1e-3);  // nothing is known yet to which it could be added
    CHECK_FALSE(model.is_known());
    model.update(std::array<double, 3>{1, 0, 0}, 2e-3);
    model.update_difference(1, 1e-3), model.update_difference(2, 100e-3);
    CHECK(model.cost(0) == doctest::Approx(2e-3).epsilon(0.05));
    CHECK(model.cost(1) == doctest::Approx(3e-3).epsilon(0.05));
    CHECK(model.cost(2) == doctest::Approx(103e-3).epsilon(0.05));
    CHECK(model.deviation(1) < 0.5 * model.cost(1));
    CHECK(model.deviation(2) < 0.5 * model.cost(2));
    // In fact it is twice that; the trials go on to say the same.
    for (int n = 0; n < 40; ++n)
        model.update(std::array<double, 3>{0, 1, 0}, 4e-3), model.update(std::array<double, 3>{1, 0, 0}, 2e-3),
            model.update_difference(1, 1e-3);
    CHECK(model.cost(1) == doctest::Approx(4e-3).epsilon(0.1));
}
