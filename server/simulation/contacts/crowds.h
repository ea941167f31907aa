/// Crowds: bodies in islands so large that their impacts are not located inside the step (Resolution/Automatic). An impact rewinds and
/// solves the whole island of its bodies; where islands are small that costs little, whatever else there is in the scene.
///
/// An island is what persistent contacts and the joints of touching bodies hold together. A body is crowded
///   - as long as its island is larger than the limits, and for the dwell after that: a heap that shakes is not in pieces;
///   - while it sleeps;
///   - while a body is that would be rewound with it: one of its island, or of its solver group.
/// So at the start of a step all bodies of an island are crowded, or none is. Where locating the impacts of the others costs too much, all
/// are crowded for the dwell (ContactBook::crowd_all).
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "simulation/contacts/contacts.h"
#include "simulation/motion/step_state.h"

namespace plab::simulation
{

/// Two bodies that touch where a run begins.
struct FirstTouch
{
    Ref a, b;
    std::uint32_t count = 0;  ///< points
    static constexpr bool resting = true, ahead = false;
};

class Crowds
{
public:
    struct Limits
    {
        double bodies = HUGE_VAL, points = HUGE_VAL;  ///< of an island
        double dwell = 0;                             ///< s
    };

    explicit Crowds(const StepState& step) : step_(step) {}

    /// At the start of a step. `until`: s, by host row, the end of the last step in which the body's island was too large, -inf if there
    /// was none; empty if that holds for all. It is state, and is brought up to date.
    void find(std::span<const PairState> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until);
    void find(std::span<const FirstTouch> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until);

    std::uint32_t bodies() const { return bodies_; }                     ///< dynamic ones
    std::uint32_t crowded() const { return crowded_; }                   ///< of these
    std::uint32_t island_bodies() const { return island_bodies_; }       ///< of the largest island
    std::uint32_t island_points() const { return island_points_; }       ///< of the island that has most of them
    const std::vector<std::uint8_t>& by_body() const { return flags_; }  ///< 1: crowded

private:
    struct Count
    {
        std::uint32_t bodies = 0, points = 0;
    };
    template <class Pair>
    void find_in(std::span<const Pair> pairs, const RestState& rest, const Limits& limits, std::vector<double>& until);
    template <class Pair>
    void join_islands(std::span<const Pair> pairs);
    void count();
    void note_large(const RestState& rest, const Limits& limits, std::vector<double>& until);
    template <class Pair>
    void spread(std::span<const Pair> pairs);

    const StepState& step_;
    DisjointSets islands_;       ///< of bodies
    std::vector<Count> counts_;  ///< by representative body
    std::vector<std::uint8_t> flags_;
    std::uint32_t bodies_ = 0, crowded_ = 0, island_bodies_ = 0, island_points_ = 0;
};

}  // namespace plab::simulation
