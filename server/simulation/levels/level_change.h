/// What is known of the levels that one component has had and gets: what they cost and how they err.
#pragma once

#include <limits>
#include <string>

namespace plab::simulation
{

/// A figure of the level before and of the level after. NaN: unknown.
struct FigurePair
{
    double before = std::numeric_limits<double>::quiet_NaN(), after = before;
    std::string unit;

    bool knows_both() const;
    bool knows_any() const;
};

/// The more telling one: that with both figures, and otherwise that with one.
const FigurePair& better(const FigurePair& first, const FigurePair& second);

/// A level that was exchanged for another one.
struct LevelChange
{
    std::string from, to;   ///< as people read them; empty: none yet
    FigurePair cost;        ///< s, of a step, by the account of the component, or of trial steps of all that it acts on
    bool is_trial = false;  ///< the cost is that of trial steps
    FigurePair error;       ///< in its unit: as the governor told it, or trial steps, or the component's own account

    /// "cost 1.2 us -> 3.9 us, error unknown -> 0.003 m".
    std::string text() const;
};

}  // namespace plab::simulation
