/// Reports solid bodies that penetrate one another. Two events, both warnings:
///
/// contact.missed: a body passed through another one between two detection passes (tunnelling). Criterion: in the frame of the other
/// body, the straight line from the start to the end position of a body's centre of mass crosses the other's shape, and neither end is
/// inside it. Solid bodies cannot do that, however fast they are. Tested for bodies that collide with one another, if they move farther
/// in the step than half their own smallest width, and only where neither was deflected within the step (displacement = speed times step,
/// to a tenth).
///
/// contact.deep: a body sinks into another one. Criterion: at the end of kDeepSteps consecutive steps the penetration is more than kDeep
/// of half the smallest width of one of the two, where contacts are resolved by impulses or rows. (The depth in a spring contact follows
/// from its stiffness and is one of its outputs.)
///
/// Spheres and boxes are tested exactly, capsules and cylinders by a box inside them; half-spaces cannot be passed through; meshes, hulls
/// and compounds are not tested. The watch changes nothing and is not part of the hashed state; snapshots keep its memory.
#pragma once

#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/box_tree.h"
#include "plab/context.h"
#include "plab/tables.h"
#include "simulation/watch/run_view.h"

namespace plab::simulation
{

/// What the tunnelling watch remembers from step to step.
struct TunnelMemory
{
    struct Sinking
    {
        Tick last = -2;  ///< step at whose end the penetration was deep
        int steps = 0;   ///< number of such steps in a row
    };
    std::vector<std::uint8_t> reported;  ///< by body; empty: nothing was reported since the structure changed
    std::vector<Sinking> sinking;        ///< by body
};

class TunnelWatch
{
public:
    /// To be called when the structure has changed: the colliding bodies are determined again.
    void begin_anew() { ready_ = false, memory_.reported.clear(); }
    const TunnelMemory& memory() const { return memory_; }
    /// Continues with the memory of another watch.
    void recall(TunnelMemory memory) { ready_ = false, memory_ = std::move(memory); }
    void before_step(const RunView& s);
    /// Adds warnings to `events`, once per body until begin_anew().
    void after_step(const RunView& s, std::vector<Event>& events);

private:
    struct StartPosition
    {
        Vec3 position;
        Quat orientation;
    };
    struct CollidingBodies
    {
        std::uint32_t detector = kNoIndex;  ///< component
        std::vector<std::uint32_t> bodies;
        bool certified = false;  ///< its resolution detects every collision inside the step: bodies may bounce around one another
    };

    /// Indices in CollidingBodies::bodies: `body` passed through `other`.
    struct TunnelledPair
    {
        std::uint32_t body = 0, other = 0;
        friend auto operator<=>(const TunnelledPair&, const TunnelledPair&) = default;
    };

    void find_colliding_bodies(const RunView& s);
    bool find_swept_boxes(const RunView& s, const CollidingBodies& colliding);
    void find_tunnelled_pairs(const RunView& s, const CollidingBodies& colliding);
    void report_tunnelled_pairs(const RunView& s, const CollidingBodies& colliding, std::vector<Event>& events);
    void find_overlaps(const RunView& s, std::vector<Event>& events);
    bool passed(const RunView& s, std::uint32_t body, std::uint32_t other) const;

    bool ready_ = false;
    std::vector<CollidingBodies> colliding_;
    std::vector<StartPosition> start_;  ///< by body
    std::shared_ptr<const char> mark_;  ///< RestState::mark at that time
    std::vector<double> least_width_;   ///< half of the smallest width, by body, m
    TunnelMemory memory_;
    double shallow_ = 0;  ///< m: penetrations up to this are not deep for any body
    // Of the detection that is being examined.
    std::vector<geometry::Box> swept_;    ///< by index in its bodies: the box that the body swept over in the step, in W
    std::vector<std::uint32_t> bounded_;  ///< indices in its bodies: those with such a box
    std::vector<std::uint32_t> fast_;     ///< those of them that moved farther than their width and are not reported yet
    geometry::BoxTree tree_;              ///< of swept_
    std::vector<TunnelledPair> tunnelled_;
};

}  // namespace plab::simulation
