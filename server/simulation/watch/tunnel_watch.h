/// Tells of solid bodies that do not keep one another out. Two events, both warnings:
///
/// contact.missed: one passed through another between two looks. Sign: seen from the other body's shape, the way of a body's centre of mass
/// from the start of the step to its end, taken as straight, crosses the shape, and neither end is inside. Solid bodies do not do that,
/// however fast they are. Looked at for bodies that collide with one another, for those that move farther in the step than half their own
/// least width, and only where neither was turned aside within the step (way = speed times step, to a tenth).
///
/// contact.deep: one sinks into another. Sign: at the end of kDeepSteps steps in a row an overlap is more than kDeep of half the least
/// width of one of the two, where contacts are answered by impulses or rows. (How deep a spring gives way is its stiffness' choice, and its
/// output.)
///
/// Balls and boxes are tested as they are, capsules and cylinders by a box inside them; half-spaces cannot be passed, meshes, hulls and
/// compounds are not tested. Not part of the state: neither saved nor hashed, and it changes nothing.
#pragma once

#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "plab/context.h"
#include "plab/tables.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

/// What a watch for tunnelling remembers from step to step.
struct TunnelMemory
{
    struct Sinking
    {
        Tick last = -2;  ///< step at whose end it was deep
        int steps = 0;   ///< in a row
    };
    std::vector<std::uint8_t> reported;  ///< by body; empty: nothing was told since the structure changed
    std::vector<Sinking> sinking;        ///< by body
};

class TunnelWatch
{
public:
    /// The structure has changed: who collides with whom is looked up anew.
    void begin_anew() { ready_ = false, memory_.reported.clear(); }
    const TunnelMemory& memory() const { return memory_; }
    /// Goes on as the watch that remembered this did.
    void recall(TunnelMemory memory) { ready_ = false, memory_ = std::move(memory); }
    void before_step(const RunView& s);
    /// Adds to `events`; once per body until begin_anew().
    void after_step(const RunView& s, std::vector<Event>& events);

private:
    struct StartPosition
    {
        Vec3 position;
        Quat orientation;
    };
    struct Crowd
    {
        std::uint32_t detector = kNoIndex;  ///< component
        std::vector<std::uint32_t> bodies;
        bool certified = false;  ///< its resolution sees whatever happens inside the step: bodies bounce round one another
    };

    /// What a body swept over in the step, in W, m; of the crowd's place-th body.
    struct Swept
    {
        Vec3 lower, upper;
        std::uint32_t place = 0;
        bool fast = false;  ///< went further than it is wide, and nothing was told of it yet
    };
    /// Places in the crowd: `body` went through `other`.
    struct Passage
    {
        std::uint32_t body = 0, other = 0;
        friend auto operator<=>(const Passage&, const Passage&) = default;
    };

    void look_up(const RunView& s);
    bool sweep(const RunView& s, const Crowd& crowd);
    void find_passages(const RunView& s, const Crowd& crowd);
    void tell(const RunView& s, const Crowd& crowd, std::vector<Event>& events);
    void find_overlaps(const RunView& s, std::vector<Event>& events);
    bool passed(const RunView& s, std::uint32_t body, std::uint32_t other) const;

    bool ready_ = false;
    std::vector<Crowd> crowds_;
    std::vector<StartPosition> start_;  ///< by body
    std::vector<double> least_width_;   ///< half of it, by body, m
    TunnelMemory memory_;
    double shallow_ = 0;  ///< m: no overlap up to here is deep for anybody
    // Of the crowd that is looked at.
    std::vector<Swept> swept_;          ///< by lower.x
    std::vector<const Swept*> active_;  ///< those that x has come to and not left
    std::vector<Passage> passages_;
};

}  // namespace plab::simulation
